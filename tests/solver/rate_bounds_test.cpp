// SPDX-License-Identifier: MIT
// Hard bounds on the changes of inputs, through the whole solver.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "chicane/solver/describe.hpp"
#include "chicane/solver/ocp_solver.hpp"
#include "problems/optimality.hpp"
#include "problems/rate_problem.hpp"

namespace chicane {
namespace {

using bench::RateProblem;
using bench::StructuredRateProblem;
using solver::SolveReport;
using solver::SolveStatus;

constexpr int kCapacity = 30;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
using Solver = solver::OcpSolver<RateProblem, kCapacity>;
using Trajectory = bench::DescribedTrajectory<kCapacity>;

/// Change of input m at stage k.
double change(const bench::RateInstance& instance, const Trajectory& t, int k, std::size_t m) {
  const double last = k == 0 ? instance.start[6 + m] : t.u[static_cast<std::size_t>(k - 1)][m];
  return t.u[static_cast<std::size_t>(k)][m] - last;
}

/// Inside their own bounds to the bit, and inside those on changes, widened by `excess`, to rounding.
bool inputs_are_admissible(const bench::RateInstance& instance, const Trajectory& t, double excess = 0.0) {
  if (!bench::inputs_are_inside(instance.problem, t)) return false;
  for (int k = 0; k < t.horizon; ++k) {
    for (std::size_t m = 0; m < 2; ++m) {
      const double moved = change(instance, t, k, m);
      if (!(moved <= instance.problem.input_rate_upper(k)[m] + excess + 1e-15) ||
          !(moved >= instance.problem.input_rate_lower(k)[m] - excess - 1e-15))
        return false;
    }
  }
  return true;
}

/// dJ/du of the simulated inputs by forward derivatives, all of stage 0 first.
std::vector<double> gradient(const bench::RateInstance& instance, const Trajectory& t) {
  using T = FullJet<1>;
  std::vector<double> g;
  for (int stage = 0; stage < t.horizon; ++stage) {
    for (int input = 0; input < 2; ++input) {
      const T cost = bench::simulated_cost<T>(instance.problem, instance.start, t.horizon, [&](int k, int m) {
        const double u = t.u[static_cast<std::size_t>(k)][static_cast<std::size_t>(m)];
        return k == stage && m == input ? T::variable(u, 0) : T(u);
      });
      g.push_back(cost.slopes[0]);
    }
  }
  return g;
}

/// What is left of the gradient when multipliers of the right signs at active bounds, the solver's own, are
/// taken off. Signs are checked, and that bounds with a multiplier are active.
void expect_optimal(const bench::RateInstance& instance, const Trajectory& t, const Solver& ocp,
                    const std::string& what) {
  const std::vector<double> g = gradient(instance, t);
  double scale = 1.0;
  for (const double slope : g) scale = std::max(scale, std::fabs(slope));
  const double tolerance = 2e-6 * scale;  // of prices; steps of 1e-6 times curvatures
  for (int k = 0; k < t.horizon; ++k) {
    for (int m = 0; m < 2; ++m) {
      const auto input = static_cast<std::size_t>(m);
      const double own = ocp.bound_multiplier(k, m);
      const double rate = ocp.rate_multiplier(k, m);
      const double next = k + 1 < t.horizon ? ocp.rate_multiplier(k + 1, m) : 0.0;
      ASSERT_NEAR(g[static_cast<std::size_t>(2 * k + m)], own + rate - next, tolerance) << what << ' ' << k;
      const double u = t.u[static_cast<std::size_t>(k)][input];
      const double moved = change(instance, t, k, input);
      if (own < -tolerance) {
        ASSERT_NEAR(u, instance.problem.input_upper(k)[input], 1e-7) << what << ' ' << k;
      }
      if (own > tolerance) {
        ASSERT_NEAR(u, instance.problem.input_lower(k)[input], 1e-7) << what << ' ' << k;
      }
      if (rate < -tolerance) {
        ASSERT_NEAR(moved, instance.problem.input_rate_upper(k)[input], 1e-7) << what << ' ' << k;
      }
      if (rate > tolerance) {
        ASSERT_NEAR(moved, instance.problem.input_rate_lower(k)[input], 1e-7) << what << ' ' << k;
      }
    }
  }
}

struct RateBounds : testing::Test {
  std::unique_ptr<Solver> ocp = std::make_unique<Solver>();
  Trajectory trajectory;
  bench::RateInstance instance;

  RateBounds() {
    Random random{3};
    instance = bench::random_rates(random, 20);
    instance.problem.most_up = {0.03, 0.2};
    instance.problem.most_down = {-0.02, -0.3};
    trajectory.horizon = 20;
  }
  SolveReport solve(const solver::SolverOptions& options = {}, Deadline deadline = Deadline::never()) {
    *ocp = Solver{options};
    return ocp->solve(instance.problem, instance.start, trajectory, deadline);
  }
};

TEST_F(RateBounds, AreKeptAndTheirMultipliersExplainTheGradient) {
  Random random{21};
  int active = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const int horizon = 1 + trial % 24;
    instance = bench::random_rates(random, horizon);
    trajectory = {};
    trajectory.horizon = horizon;
    ASSERT_EQ(solve({.max_iterations = 100}).status, SolveStatus::kOptimal) << trial;
    ASSERT_TRUE(inputs_are_admissible(instance, trajectory)) << trial;
    expect_optimal(instance, trajectory, *ocp, "trial " + std::to_string(trial));
    for (int k = 0; k < horizon; ++k) active += std::fabs(ocp->rate_multiplier(k, 0)) > 1e-3 ? 1 : 0;
  }
  EXPECT_GT(active, 200);
}

TEST_F(RateBounds, ThatAreWideChangeNothing) {
  solver::OcpSolver<bench::DescribedProblem, kCapacity> plain;
  instance.problem.most_up = {kInfinity, 5.0};
  instance.problem.most_down = {-5.0, -kInfinity};
  auto without = trajectory;
  ASSERT_EQ(plain.solve(instance.problem, instance.start, without).status, SolveStatus::kOptimal);
  ASSERT_EQ(solve().status, SolveStatus::kOptimal);
  for (std::size_t k = 0; k < 20; ++k) {
    for (std::size_t m = 0; m < 2; ++m) EXPECT_NEAR(trajectory.u[k][m], without.u[k][m], 1e-6);
  }
}

TEST_F(RateBounds, AreTheSameForAStructuredProblem) {
  const auto structured = std::make_unique<solver::OcpSolver<StructuredRateProblem, kCapacity>>();
  Random random{22};
  for (int trial = 0; trial < 40; ++trial) {
    const int horizon = 1 + trial % 20;
    instance = bench::random_rates(random, horizon);
    trajectory = {};
    trajectory.horizon = horizon;
    const SolveReport dense = solve({.max_iterations = 100});
    StructuredRateProblem problem{instance.problem, instance.start[4]};
    problem.most_up = instance.problem.most_up;
    problem.most_down = instance.problem.most_down;
    problem.wave = instance.problem.wave;
    solver::Trajectory<7, 2, kCapacity> other;
    other.horizon = horizon;
    const SolveReport report =
        structured->solve(problem, StructuredRateProblem::without_cte(instance.start), other);
    ASSERT_EQ(report.status, SolveStatus::kOptimal) << trial;
    EXPECT_NEAR(report.cost, dense.cost, 1e-8 * dense.cost) << trial;
  }
}

TEST_F(RateBounds, AMirroredProblemHasTheMirroredSolution) {
  instance.problem.most_down = {-0.03, -0.3};
  ASSERT_EQ(solve().status, SolveStatus::kOptimal);
  const auto left = trajectory;
  for (double& c : instance.problem.path) c = -c;
  for (const std::size_t i : {1U, 2U, 4U, 5U, 6U}) instance.start[i] = -instance.start[i];
  trajectory = {};
  trajectory.horizon = 20;
  ASSERT_EQ(solve().status, SolveStatus::kOptimal);
  for (std::size_t k = 0; k < 20; ++k) {
    EXPECT_NEAR(trajectory.u[k][0], -left.u[k][0], 1e-9);
    EXPECT_NEAR(trajectory.u[k][1], left.u[k][1], 1e-9);
  }
}

TEST_F(RateBounds, ThatAreEqualPrescribeTheInputs) {
  instance.start[6] = 0.0;
  instance.problem.wave = 0.0;
  instance.problem.most_up[0] = instance.problem.most_down[0] = 0.01;
  ASSERT_EQ(solve().status, SolveStatus::kOptimal);
  for (int k = 0; k < 20; ++k)
    EXPECT_NEAR(trajectory.u[static_cast<std::size_t>(k)][0], 0.01 * (k + 1), 1e-12);
  instance.problem.most_up = instance.problem.most_down = {0.0, 0.0};
  ASSERT_EQ(solve().status, SolveStatus::kOptimal);
  for (std::size_t k = 0; k < 20; ++k) EXPECT_NEAR(trajectory.u[k][1], instance.start[7], 1e-12);
}

TEST_F(RateBounds, GiveWayToTheInputsOwnBounds) {
  instance.start[6] = 1.0;  // half a radian beyond the limit, 0.02 per stage allowed
  const SolveReport report = solve();
  ASSERT_EQ(report.status, SolveStatus::kOptimal);
  const double limit = instance.problem.steer_limit;
  EXPECT_NEAR(trajectory.u[0][0], limit, 1e-15);
  const double allowed = -instance.problem.input_rate_lower(0)[0];
  EXPECT_NEAR(report.rate_excess, 1.0 - limit - allowed, 1e-12);
  EXPECT_EQ(report.rate_stage, 0);
  EXPECT_EQ(report.rate_input, 0);
  const std::string words = describe(instance.problem, report);
  EXPECT_EQ(words.substr(0, words.find("0.5")), "optimal: change of steering beyond its bound by ");
  EXPECT_NE(words.find(" rad at stage 0"), std::string::npos) << words;
}

TEST_F(RateBounds, HoldWhateverTheStatus) {
  for (const int iterations : {1, 2, 3}) {
    for (auto& u : trajectory.u) u = {kInfinity, -77.0};
    const SolveReport report = solve({.max_iterations = iterations});
    EXPECT_TRUE(inputs_are_admissible(instance, trajectory)) << iterations << to_string(report.status);
  }
  for (auto& u : trajectory.u) u = {kNaN, 3.0};
  solve({}, Deadline::after(std::chrono::nanoseconds{0}));
  EXPECT_TRUE(inputs_are_admissible(instance, trajectory));
  instance.problem.path[1] = kNaN;
  EXPECT_EQ(solve().status, SolveStatus::kNotFinite);
  EXPECT_TRUE(inputs_are_admissible(instance, trajectory));
}

TEST_F(RateBounds, ThatAreNotNumbersOrCrossAreRefused) {
  for (const double bad : {kNaN, -1.0, -kInfinity}) {
    auto broken = instance;
    broken.problem.most_up[0] = bad;
    const SolveReport report = ocp->solve(broken.problem, broken.start, trajectory);
    EXPECT_EQ(report.status, SolveStatus::kNotFinite) << bad;
    EXPECT_TRUE(bench::inputs_are_inside(broken.problem, trajectory)) << bad;
  }
}

TEST_F(RateBounds, AnOptimumIsItsOwnBestWarmStart) {
  ASSERT_EQ(solve().status, SolveStatus::kOptimal);
  const SolveReport again = solve();
  EXPECT_EQ(again.sweeps, 0);
  // A little later most of the working set is still right.
  instance.problem.speed_reference += 0.1;
  const SolveReport next = solve();
  EXPECT_EQ(next.status, SolveStatus::kOptimal);
  EXPECT_LE(next.sweeps, 12);
}

TEST_F(RateBounds, MultipliersArePricesOfTheBounds) {
  ASSERT_EQ(solve().status, SolveStatus::kOptimal);
  double price = 0.0;  // of all upper bounds of the steering rate together
  for (int k = 0; k < 20; ++k) {
    const double share = instance.problem.input_rate_upper(k)[0] / instance.problem.most_up[0];
    price += std::min(ocp->rate_multiplier(k, 0), 0.0) * share;
  }
  ASSERT_LT(price, -1e-3);
  const double step = 1e-5;
  instance.problem.most_up[0] += step;
  const double more = solve().cost;
  instance.problem.most_up[0] -= 2.0 * step;
  const double less = solve().cost;
  EXPECT_NEAR((more - less) / (2.0 * step), price, 1e-3 * std::fabs(price));
}

}  // namespace
}  // namespace chicane
