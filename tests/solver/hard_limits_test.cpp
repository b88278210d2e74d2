// SPDX-License-Identifier: MIT
#include "families/hard_limits.hpp"

#include "chicane/solver/ocp_solver.hpp"
#include "families/measure_family.hpp"
#include "support/chicane_test.hpp"

namespace chicane::bench {
namespace {

using solver::HardReport;
using solver::SolveStatus;

template <class P>
struct Solved {
  P instance;
  typename FamilyMeasurement<P>::Trajectory answer;
  HardReport report;
};
template <class P>
std::unique_ptr<Solved<P>> solve(int seed, bool is_impossible, NaiveStart start, double tolerance = 1e-6) {
  using M = FamilyMeasurement<P>;
  auto solved = std::make_unique<Solved<P>>();
  solved->instance = M::instance(seed, is_impossible);
  solved->answer = M::guess(solved->instance, start);
  const auto ocp = std::make_unique<solver::OcpSolver<P, P::kHorizon>>(
      solver::SolverOptions{.tolerance = tolerance, .start_from_states = start == NaiveStart::kLine});
  solved->report = ocp->solve(solved->instance, solved->instance.start, solved->answer);
  return solved;
}

TEST(HardLimits, TakeFewIterationsInAConvexProgram) {
  for (const NaiveStart start : {NaiveStart::kIdle, NaiveStart::kLine}) {
    for (int seed = 0; seed < 21; ++seed) {
      const auto solved = solve<BrysonDenham>(seed, false, start);
      ASSERT_EQ(solved->report.status, SolveStatus::kOptimal) << seed;
      EXPECT_LE(solved->report.iterations, 40) << seed << to_string(start);
    }
  }
}

/// Counts how often eight stages are evaluated with second derivatives.
struct Counted : BrysonDenham {
  int* count = nullptr;
  template <class K, class T>
  std::array<T, 2> dynamics(K k, const std::array<T, 2>& x, const std::array<T, 1>& u) const {
    if constexpr (requires { requires T::kOrder == 2; }) ++*count;
    return BrysonDenham::dynamics(k, x, u);
  }
};

TEST(HardLimits, AreLinearisedOnceAnIteration) {
  const auto instance = FamilyMeasurement<BrysonDenham>::instance(0);
  int count = 0;
  Counted problem;
  static_cast<BrysonDenham&>(problem) = instance;
  problem.count = &count;
  solver::Trajectory<2, 1, Counted::kHorizon> answer;
  answer.horizon = Counted::kHorizon;
  const auto ocp = std::make_unique<solver::OcpSolver<Counted, Counted::kHorizon>>();
  const HardReport report = ocp->solve(problem, instance.start, answer);
  ASSERT_EQ(report.status, SolveStatus::kOptimal);
  constexpr int kGroups = (Counted::kHorizon + 7) / 8;
  EXPECT_LE(count,
            kGroups * (report.iterations + 2));  // not once more for each barrier
}

TEST(HardLimits, CostNoMoreThanTheToleranceByTheirBarrier) {
  for (int seed = 0; seed < 5; ++seed) {
    const auto solved = solve<BrysonDenham>(seed, false, NaiveStart::kIdle);
    const auto exact = solve<BrysonDenham>(seed, false, NaiveStart::kIdle, 1e-9);
    EXPECT_GT(solved->report.gap, 0.0);
    EXPECT_LE(solved->report.gap, 2e-6);
    EXPECT_LE(exact->report.gap, 2e-9);
    EXPECT_NEAR(solved->report.cost, exact->report.cost, 2e-6 + 2e-6 * exact->report.cost);
  }
}

TEST(HardLimits, ThatBoundedInputsCannotKeepAreInfeasible) {
  for (const NaiveStart start : {NaiveStart::kIdle, NaiveStart::kLine}) {
    for (int seed = 0; seed < 8; ++seed) {
      const auto solved = solve<BrysonDenham>(seed, true, start);
      const BrysonDenham& p = solved->instance;
      const HardReport& report = solved->report;
      ASSERT_EQ(report.status, SolveStatus::kInfeasible) << seed << to_string(start);
      const auto& x = solved->answer.x;
      const auto stage = static_cast<std::size_t>(report.miss_stage);
      if (report.kind == HardReport::Kind::kConstraint) {
        EXPECT_EQ(report.miss_row, 0);
        EXPECT_NEAR(x[stage][0] - p.limit, report.miss, 1e-9) << seed;
      } else {
        ASSERT_EQ(report.kind, HardReport::Kind::kTerminalEquality) << seed;
        EXPECT_NEAR(std::fabs(report.miss_row == 0 ? x[stage][0] : x[stage][1] + p.speed), report.miss, 1e-9);
      }
      double furthest = 0.0;
      for (const auto& at : x) furthest = std::max(furthest, at[0]);
      const double stop = p.speed * p.speed / (2.0 * p.most[0]);  // by braking all the time
      EXPECT_GE(furthest, 0.98 * stop) << seed;
      EXPECT_LE(furthest, 1.1 * stop + 0.05 * p.speed) << seed;
      EXPECT_LE(report.iterations, 500) << seed;
    }
  }
}

double total_violation(const Tanks& problem, const std::array<double, 2>& start,
                       FamilyMeasurement<Tanks>::Trajectory t) {
  solver::roll_out(problem, start, t);
  double total = 0.0;
  for (int k = 0; k < t.horizon; ++k) {
    const auto stage = static_cast<std::size_t>(k);
    for (const double c : problem.constraint(k, t.x[stage], t.u[stage])) total += std::max(0.0, c);
  }
  return total;
}

TEST(HardLimits, ComeBackWithTheLeastViolation) {
  for (int seed = 0; seed < 5; ++seed) {
    const auto solved = solve<Tanks>(seed, true, NaiveStart::kIdle);
    const Tanks& p = solved->instance;
    ASSERT_EQ(solved->report.status, SolveStatus::kInfeasible) << seed;
    const double least = total_violation(p, solved->instance.start, solved->answer);
    for (std::size_t k = 0; k < Tanks::kHorizon; ++k) {
      for (const std::size_t m : {std::size_t{0}, std::size_t{1}}) {
        for (const double change : {-1e-2, 1e-2}) {
          auto other = solved->answer;
          const int stage = static_cast<int>(k);
          other.u[k][m] =
              std::clamp(other.u[k][m] + change, p.input_lower(stage)[m], p.input_upper(stage)[m]);
          EXPECT_GE(total_violation(p, solved->instance.start, other), least - 1e-5) << seed << " " << k;
        }
      }
    }
  }
}

}  // namespace
}  // namespace chicane::bench
