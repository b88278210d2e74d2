// SPDX-License-Identifier: MIT

#include "chicane/solver/ocp_solver.hpp"
#include "support/chicane_test.hpp"

namespace chicane::solver {
namespace {

/// A system that runs away by itself, faster than any power.
struct Runaway {
  static constexpr int kNx = 1, kNu = 1, kNr = 2, kNe = 1, kNc = 0;

  template <class T>
  std::array<T, 1> dynamics(int, const std::array<T, 1>& x, const std::array<T, 1>& u) const {
    return {1.3 * x[0] + 0.1 * x[0] * x[0] * x[0] + u[0]};
  }
  template <class T>
  std::array<T, 2> residual(int, const std::array<T, 1>& x, const std::array<T, 1>& u) const {
    return {x[0], 0.3 * u[0]};
  }
  template <class T>
  std::array<T, 1> terminal_residual(const std::array<T, 1>& x) const {
    return {x[0]};
  }
  std::array<double, 1> input_lower(int) const { return {-10.0}; }
  std::array<double, 1> input_upper(int) const { return {10.0}; }
};

struct RealTimeRunaway : Runaway {
  static constexpr bool kRealTime = true;
};

using Solver = OcpSolver<Runaway, 60>;

template <class P = RealTimeRunaway>
SolveReport solve_from(double x0, const SolverOptions& options, Solver::Trajectory& trajectory) {
  return std::make_unique<OcpSolver<P, 60>>(options)->solve(P{}, {x0}, trajectory);
}

TEST(StartFromStates, SolvesWhatASimulatedGuessRunsAwayFrom) {
  const auto answer = std::make_unique<Solver::Trajectory>();  // at rest all the time
  answer->horizon = 60;
  SolverOptions options{.may_start_short = false};
  EXPECT_EQ(solve_from(1.0, options, *answer).status, SolveStatus::kNotFinite);
  *answer = {};
  answer->horizon = 60;
  options.start_from_states = true;
  const SolveReport report = solve_from(1.0, options, *answer);
  EXPECT_EQ(report.status, SolveStatus::kOptimal);
  EXPECT_LE(report.iterations, 8);
  EXPECT_EQ(answer->x[0][0], 1.0);
  EXPECT_NEAR(answer->x[60][0], 0.0, 1e-6);
  for (std::size_t k = 0; k < 60; ++k)
    EXPECT_NEAR(answer->x[k + 1][0], next_state(Runaway{}, 0, answer->x[k], answer->u[k])[0], 1e-9) << k;
}

TEST(StartFromStates, IsNotNeededWhereAStartThatCannotBeSimulatedStandsStill) {
  const auto answer = std::make_unique<Solver::Trajectory>();
  answer->horizon = 60;
  EXPECT_EQ(solve_from<Runaway>(1.0, {}, *answer).status, SolveStatus::kOptimal);
  EXPECT_NEAR(answer->x[60][0], 0.0, 1e-6);
}

TEST(StartFromStates, HasTheSameOptimumAndSimulatesWhereStatesAreNoNumbers) {
  const auto simulated = std::make_unique<Solver::Trajectory>();
  const auto embedded = std::make_unique<Solver::Trajectory>();
  simulated->horizon = embedded->horizon = 5;
  embedded->x.fill({0.2});
  const SolveReport expected = solve_from(0.4, {}, *simulated);
  ASSERT_EQ(expected.status, SolveStatus::kOptimal);
  EXPECT_NEAR(solve_from(0.4, {.start_from_states = true}, *embedded).cost, expected.cost, 1e-9);
  embedded->u.fill({0.0});
  embedded->x[3][0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NEAR(solve_from(0.4, {.start_from_states = true}, *embedded).cost, expected.cost, 1e-9);
}

}  // namespace
}  // namespace chicane::solver
