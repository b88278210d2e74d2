// SPDX-License-Identifier: MIT
#include "chicane/solver/detail/filter_method.hpp"

#include "chicane/solver/ocp_solver.hpp"
#include "families/chains.hpp"
#include "families/machines.hpp"
#include "families/measure_family.hpp"
#include "families/pendulums.hpp"
#include "support/chicane_test.hpp"

namespace chicane::bench {
namespace {

using solver::SolveStatus;

/// A solved instance of a family, and what an independent check finds of it.
template <class P>
struct Solved {
  solver::SolveReport report;
  KktResidual kkt;
};
template <class P>
Solved<P> solve(int seed, NaiveStart start, solver::SolverOptions options = {}) {
  using Measurement = FamilyMeasurement<P>;
  const auto ocp = std::make_unique<solver::OcpSolver<P, P::kHorizon>>(options);
  const auto instance = Measurement::instance(seed);
  const auto t = std::make_unique<typename Measurement::Trajectory>(Measurement::guess(instance, start));
  Solved<P> solved;
  solved.report = ocp->solve(instance, instance.start, *t);
  solved.kkt = check_kkt(instance, *t, *ocp);
  return solved;
}

template <class P>
void expect_optimal(int seed, NaiveStart start) {
  const auto [report, kkt] = solve<P>(seed, start);
  EXPECT_EQ(report.status, SolveStatus::kOptimal) << seed;
  EXPECT_LE(kkt.stationarity, 2e-6) << seed;  // the tolerance, and rounding that the adjoint amplifies
  EXPECT_LE(kkt.defect, 1e-12) << seed;
  EXPECT_LE(kkt.subgradient, 2e-3) << seed;  // the root of the last barrier
  EXPECT_LE(kkt.outside, 0.0) << seed;
}

TEST(FilterMethod, SwingsUpAPoleFromNoPush) {  // full steps and descents solve 12 of these 20
  for (int seed = 0; seed < 20; ++seed) expect_optimal<CartPole>(seed, NaiveStart::kIdle);
}

TEST(FilterMethod, KeepsBoundsOnChangesOfInputs) {  // descents solve none of these
  for (const int seed : {9, 29, 44, 79}) expect_optimal<Reactor>(seed, NaiveStart::kIdle);
  for (const int seed : {1, 21, 33, 51}) expect_optimal<Reactor>(seed, NaiveStart::kLine);
}

/// More variables in a stage than are unrolled: 57 states, 3 inputs.
TEST(LargeProblems, CalmAChainOfNineMasses) {
  for (int seed = 0; seed < 4; ++seed) {
    for (const NaiveStart start : {NaiveStart::kIdle, NaiveStart::kLine}) {
      const auto [report, kkt] =
          solve<LongChain>(seed, start, {.start_from_states = start == NaiveStart::kLine});
      EXPECT_EQ(report.status, SolveStatus::kOptimal) << seed;
      EXPECT_LE(kkt.stationarity, 1.1e-6) << seed;
      EXPECT_LE(kkt.defect, 1e-12) << seed;
      EXPECT_LE(kkt.outside, 0.0) << seed;
      EXPECT_NEAR(kkt.cost, report.cost, 1e-9 * kkt.cost) << seed;
    }
  }
}

TEST(FilterMethod, SaysWhereRoundingEndsIt) {
  int at_floor = 0;
  for (int seed = 0; seed < 20; ++seed) {
    const auto [report, kkt] = solve<CartPole>(seed, NaiveStart::kIdle, {.tolerance = 1e-12});
    const double left = std::max({report.stationarity, report.defect, report.complementarity});
    EXPECT_TRUE(solver::usable(report.status)) << seed;
    EXPECT_EQ(report.status == SolveStatus::kOptimal, left <= 1e-12) << seed;
    if (report.status == SolveStatus::kAtFloor) {
      EXPECT_LE(left, 1e-6) << seed;
      EXPECT_LE(kkt.stationarity, 1e-5) << seed;  // with the multipliers that are handed out
    }
    EXPECT_LE(kkt.defect, 1e-12) << seed;
    at_floor += report.status == SolveStatus::kAtFloor ? 1 : 0;
  }
  EXPECT_GT(at_floor, 0);  // else the tolerance is too easy for this test
}

TEST(FilterMethod, HandsOutNoWorseThanTheGuessWhenTheBudgetEnds) {
  for (const int iterations : {5, 10, 15, 20, 30}) {
    for (int seed = 0; seed < 10; ++seed) {
      const auto instance = FamilyMeasurement<CartPole>::instance(seed);
      const auto guess = FamilyMeasurement<CartPole>::guess(instance, NaiveStart::kIdle);
      const double before = check_kkt(instance, guess).cost;
      const auto [report, kkt] = solve<CartPole>(seed, NaiveStart::kIdle, {.max_iterations = iterations});
      EXPECT_LE(kkt.cost, (1.0 + 1e-9) * before) << iterations << " " << seed;
    }
  }
}

}  // namespace
}  // namespace chicane::bench
