// SPDX-License-Identifier: MIT
// Problems of more variables in a stage than are unrolled.

#include "chicane/solver/ocp_solver.hpp"
#include "families/chains.hpp"
#include "families/measure_family.hpp"
#include "support/chicane_test.hpp"

namespace chicane::bench {
namespace {

using Measurement = FamilyMeasurement<LongChain>;
using Solver = solver::OcpSolver<LongChain, LongChain::kHorizon>;

void expect_calm(int seed, NaiveStart start, const solver::SolverOptions& options) {
  const auto ocp = std::make_unique<Solver>(options);
  const auto instance = Measurement::instance(seed);
  const auto t = std::make_unique<Measurement::Trajectory>(Measurement::guess(instance, start));
  const solver::SolveReport report = ocp->solve(instance, instance.start, *t);
  EXPECT_EQ(report.status, solver::SolveStatus::kOptimal) << seed;
  const KktResidual kkt = check_kkt(instance, *t);
  EXPECT_LE(kkt.stationarity, 1.1e-6) << seed;
  EXPECT_LE(kkt.defect, 1e-12) << seed;
  EXPECT_LE(kkt.outside, 0.0) << seed;
  EXPECT_NEAR(kkt.cost, report.cost, 1e-9 * kkt.cost) << seed;
}

TEST(LargeProblems, CalmAChainOfNineMasses) {  // 57 states, 3 inputs
  for (int seed = 0; seed < 4; ++seed) {
    expect_calm(seed, NaiveStart::kIdle, {});
    expect_calm(seed, NaiveStart::kLine, {.start_from_states = true});
  }
}

}  // namespace
}  // namespace chicane::bench
