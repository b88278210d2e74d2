// SPDX-License-Identifier: MIT
#include "chicane/tracking/tracking_problem.hpp"

#include "chicane/base/random.hpp"
#include "chicane/model/prediction.hpp"
#include "chicane/solver/problem.hpp"
#include "support/chicane_test.hpp"

namespace chicane::tracking {
namespace {

using Problem = TrackingProblem;
using X = std::array<double, Problem::kNx>;
using U = std::array<double, Problem::kNu>;

model::VehicleParams car_number(int i) { return i == 0 ? model::udacity_params() : model::road_car_params(); }

Problem sample_problem(const model::PredictionModel& model, Random& random) {
  Problem problem;
  problem.model = &model;
  problem.horizon = 5;
  problem.weight = {.lateral = 1.0,
                    .heading = 2.0,
                    .speed = 0.7,
                    .steer_rate = 3.0,
                    .jerk = 0.2,
                    .edge = 14.0,
                    .slip = 4.0,
                    .excess_steer_rate = 10.0,
                    .friction = 4.0};
  problem.first = {0.08, model.lags(0.08)};
  problem.others = {0.05, model.lags(0.05)};
  for (std::size_t k = 0; k <= 5; ++k) {
    problem.road.s[k] = 1.0;
    problem.road.curvature[k] = random.uniform(-0.05, 0.05);
    problem.road.curvature_slope[k] = random.uniform(-0.003, 0.003);
    problem.road.speed[k] = random.uniform(5.0, 50.0);
    problem.road.speed_slope[k] = random.uniform(-0.3, 0.1);
    problem.road.left[k] = 1.0;
    problem.road.steadiness[k] = 1.0;
    problem.road.right[k] = 1.5;
  }
  return problem;
}

/// A jet with all derivatives of (x, u): what jets with fewer are widened to.
constexpr int kN = Problem::kNx + Problem::kNu;
using Full = Jet<double, 1, (Variables{1} << kN) - 1>;

template <class Seeds, class Values>
void set_values(Seeds& seeds, const Values& values) {
  [&]<std::size_t... i>(std::index_sequence<i...>) { ((std::get<i>(seeds).v = values[i]), ...); }
  (std::make_index_sequence<std::tuple_size_v<Seeds>>{});
}

/// Largest difference between exact and central-difference Jacobians of a function of (x, u), relative to its
/// size.
template <class F>
double worst_jacobian_error(const F& function, const X& x, const U& u) {
  solver::StateJets<Problem, double, 1> xd;
  solver::InputJets<Problem, double, 1> ud;
  set_values(xd, x);
  set_values(ud, u);
  const auto exact = solver::to_array<Full>(function(xd, ud));
  double worst = 0.0;
  for (int j = 0; j < kN; ++j) {
    const double at = j < Problem::kNx ? x[j] : u[j - Problem::kNx];
    const double h =
        1e-6 * std::max(1.0, std::fabs(at));  // cube root of the rounding unit, in the variable's own size
    X xp = x, xm = x;
    U up = u, um = u;
    (j < Problem::kNx ? xp[j] : up[j - Problem::kNx]) += h;
    (j < Problem::kNx ? xm[j] : um[j - Problem::kNx]) -= h;
    const auto plus = solver::to_array<double>(function(xp, up));
    const auto minus = solver::to_array<double>(function(xm, um));
    for (std::size_t i = 0; i < plus.size(); ++i) {
      const double difference = (plus[i] - minus[i]) / (2.0 * h);
      worst = std::max(worst, std::fabs(difference - exact[i].slopes[static_cast<std::size_t>(j)]) /
                                  (1.0 + std::fabs(difference)));
    }
  }
  return worst;
}

TEST(TrackingProblem, JacobiansEqualCentralDifferences) {
  // Differences of residuals with hinges and steep tyre curves; a wrong term would show as 1e-2 or more.
  constexpr double kClose = 1e-5;
  Random random(5);
  for (int i = 0; i < 400; ++i) {
    const model::PredictionModel model(car_number(i % 2));
    const Problem problem = sample_problem(model, random);
    const X x{random.uniform(0.0, 3.0),  random.uniform(-2.0, 2.0), random.uniform(-0.3, 0.3),
              random.uniform(0.5, 50.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0),
              random.uniform(-0.2, 0.2), random.uniform(-6.0, 5.0)};
    const U u{random.uniform(-0.3, 0.3), random.uniform(-6.0, 5.0)};
    for (const int k : {0, 2}) {
      const auto dynamics = [&](const auto& a, const auto& b) { return problem.dynamics(k, a, b); };
      const auto residual = [&](const auto& a, const auto& b) { return problem.residual(k, a, b); };
      EXPECT_LT(worst_jacobian_error(dynamics, x, u), kClose);
      EXPECT_LT(worst_jacobian_error(residual, x, u), kClose);
    }
    EXPECT_LT(
        worst_jacobian_error([&](const auto& a, const auto&) { return problem.terminal_residual(a); }, x, u),
        kClose);
  }
}

TEST(TrackingProblem, AStraightLineIsDrivenStraight) {
  const model::PredictionModel model(model::udacity_params());
  Problem problem;
  problem.model = &model;
  const X to = solver::next_state(problem, 0, X{0.0, 0.5, 0.0, 20.0, 0.0, 0.0, 0.0, 0.0}, U{0.0, 0.0});
  EXPECT_DOUBLE_EQ(to[Problem::kS], 20.0 * problem.first.length);
  EXPECT_DOUBLE_EQ(to[Problem::kD], 0.5);
  EXPECT_DOUBLE_EQ(to[Problem::kE], 0.0);
}

TEST(TrackingProblem, AMoveInPartsIsThatOfShorterStages) {
  Random random(8);
  const model::PredictionModel model(model::road_car_params());
  Problem problem = sample_problem(model, random);
  const X x{0.0, 0.4, -0.1, 24.0, 0.2, 0.3, 0.02, -1.0};
  const U u{0.05, 1.5};
  problem.first = {0.15, model.lags(0.15)};
  const X whole = problem.move_in_parts(0, x, u, 3);
  problem.first = problem.others;
  X step = x;
  for (int i = 0; i < 3; ++i) step = solver::next_state(problem, 0, step, u);
  for (std::size_t i = 0; i < whole.size(); ++i) EXPECT_NEAR(whole[i], step[i], 1e-12) << i;
}

// Behind a lag of 0.5 s the angle asked for runs ahead of the wheel by sixteen times what the wheel moves in
// a stage of 30 ms: weighted as a rate, it kept f1tenth from steering into bends.
TEST(TrackingProblem, WeightsTheRateOfTheWheel) {
  Random random(9);
  model::VehicleParams car = model::road_car_params();
  const X x{0.0, 0.0, 0.0, 20.0, 0.0, 0.0, 0.02, 0.0};
  const U u{0.12, 0.0};
  for (const double lag : {0.05, 0.5}) {
    car.steer_lag = lag;
    const model::PredictionModel model(car);
    Problem problem = sample_problem(model, random);
    problem.others = Problem::Step::of(model, 0.03);
    const X next = solver::next_state(problem, 1, x, u);
    const double wheel = (next[Problem::kSteer] - x[Problem::kSteer]) / 0.03;
    const double rate = std::get<3>(problem.residual(1, x, u)) / problem.weight.steer_rate;
    EXPECT_NEAR(rate, wheel, 1e-12) << lag;
    const double excess = std::get<9>(problem.residual(1, x, u)) / problem.weight.excess_steer_rate;
    EXPECT_NEAR(excess, std::max(0.0, rate - car.steer_rate_limit), 1e-12) << lag;
  }
}

TEST(TrackingProblem, DependsOnlyOnWhatItMust) {
  using Next = decltype(std::declval<Problem>().dynamics(0, solver::StateJets<Problem, double, 1>{},
                                                         solver::InputJets<Problem, double, 1>{}));
  using Steer = std::tuple_element_t<Problem::kSteer, Next>;
  EXPECT_EQ(Steer::kFirst, variable(Problem::kSteer) | variable(Problem::kNx));
  using YawRate = std::tuple_element_t<Problem::kR, Next>;
  EXPECT_EQ(YawRate::kFirst & (variable(Problem::kS) | variable(Problem::kD) | variable(Problem::kE)), 0U);
}

}  // namespace
}  // namespace chicane::tracking
