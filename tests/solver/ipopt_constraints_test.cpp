// SPDX-License-Identifier: MIT
// Optima with soft corridors and with hard constraints, beside Ipopt's.

#include "chicane/solver/ocp_solver.hpp"
#include "families/hard.hpp"
#include "families/measure_family.hpp"
#include "problems/described_problem.hpp"
#include "problems/ipopt_problem.hpp"
#include "problems/optimality.hpp"
#include "solver/ipopt_families.hpp"
#include "support/chicane_test.hpp"

namespace chicane {
namespace {

using solver::SolveStatus;
using namespace test;

constexpr int kCapacity = kIpoptCapacity;

struct ConstraintsAgainstIpopt : testing::TestWithParam<Family> {};

TEST_P(ConstraintsAgainstIpopt, AgreesOnTheOptimumWithASoftCorridor) {
  using bench::CorridorProblem;
  if (GetParam().horizon < 2) GTEST_SKIP() << "one stage: the corridor is on the given state only";
  const auto ocp = std::make_unique<solver::OcpSolver<CorridorProblem, kCapacity>>();
  Random random{2000 + static_cast<std::uint64_t>(GetParam().horizon)};
  for (int i = 0; i < GetParam().count; ++i) {
    const auto instance = bench::random_instance<CorridorProblem>(random, GetParam().horizon);
    bench::DescribedTrajectory<kCapacity> own;
    own.horizon = GetParam().horizon;
    choose_start(GetParam().start, instance, *ocp, own);
    auto reference = own;
    const auto report = ocp->solve(instance.problem, instance.start, own);
    ASSERT_EQ(report.status, SolveStatus::kOptimal) << i;
    const double cost = bench::solve_with_ipopt(instance.problem, instance.start, reference);
    ASSERT_NEAR(report.cost, cost, 1e-6 * cost) << i;
    ASSERT_LE(report.complementarity, 1e-6) << i;
    ASSERT_TRUE(bench::inputs_are_inside(instance.problem, own)) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(OcpSolver, ConstraintsAgainstIpopt, testing::ValuesIn(kFamilies), name_of);

/// Ipopt from the answer: its optimum there has the same cost.
template <class P>
void expect_hard_optima(bench::NaiveStart start, int count) {
  using Measurement = bench::FamilyMeasurement<P>;
  const auto ocp = std::make_unique<solver::OcpSolver<P, P::kHorizon>>(
      solver::SolverOptions{.tolerance = 1e-8, .start_from_states = start == bench::NaiveStart::kLine});
  for (int seed = 0; seed < count; ++seed) {
    const auto instance = Measurement::instance(seed);
    const auto own = std::make_unique<typename Measurement::Trajectory>(Measurement::guess(instance, start));
    const auto report = ocp->solve(instance, instance.start, *own);
    ASSERT_EQ(report.status, SolveStatus::kOptimal) << seed;
    const double cost = bench::solve_with_ipopt(instance, instance.start, *own);
    ASSERT_NEAR(report.cost, cost, 1e-6 * std::fabs(cost)) << seed;
  }
}
TEST(HardAgainstIpopt, AgreesWhereAPoleMustStand) {
  expect_hard_optima<bench::HardCartPole>(bench::NaiveStart::kIdle, 6);
}
TEST(HardAgainstIpopt, AgreesWhereARocketMustStandOnItsPad) {
  expect_hard_optima<bench::HardRocketLanding>(bench::NaiveStart::kLine, 6);
}

}  // namespace
}  // namespace chicane
