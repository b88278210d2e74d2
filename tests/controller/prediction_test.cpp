// SPDX-License-Identifier: MIT
#include "chicane/controller/prediction.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "chicane/base/random.hpp"
#include "chicane/controller/tracking_problem.hpp"

namespace chicane::controller {
namespace {

using Problem = TrackingProblem;
using X = std::array<double, Problem::kNx>;
using U = std::array<double, Problem::kNu>;

model::VehicleParams car_number(int i) { return i == 0 ? model::udacity_params() : model::road_car_params(); }

BodyMotion<double> settle(const PredictionModel& model, double speed, double steer, double seconds,
                          double dt) {
  BodyMotion<double> motion{.vx = speed};
  for (double t = 0.0; t < seconds; t += dt) {
    motion = model.advance(motion, steer, 0.0, dt);
    motion.vx = speed;
  }
  return motion;
}

TEST(PredictionModel, TurnsAsTheWheelbaseSaysWhenSlow) {
  for (int i = 0; i < 2; ++i) {
    const model::VehicleParams car = car_number(i);
    const BodyMotion<double> motion = settle(PredictionModel(car), 3.0, 0.1, 5.0, 0.02);
    // Tyres slip a little even at walking pace; the speed floor of the slip angles adds its share.
    EXPECT_NEAR(motion.r, 3.0 * std::tan(0.1) / car.wheelbase(), 0.06 * motion.r) << car.name;
  }
}

TEST(PredictionModel, HasTheYawGainOfTheOriginalCar) {
  // udacity/self-driving-car-sim v1.45, fitted to published logs: ψ'/δ = 7.1, 10.9 and 17 1/s at 20, 30 and
  // 45 m/s.
  const PredictionModel model(model::udacity_params());
  EXPECT_NEAR(settle(model, 20.0, 0.01, 10.0, 0.01).r / 0.01, 7.1, 0.4);
  EXPECT_NEAR(settle(model, 30.0, 0.01, 10.0, 0.01).r / 0.01, 10.9, 0.6);
  EXPECT_NEAR(settle(model, 45.0, 0.01, 15.0, 0.01).r / 0.01, 17.0, 1.2);
}

TEST(PredictionModel, StaysFiniteFromStandstillToTopSpeedForAnyStep) {
  Random random(11);
  for (int i = 0; i < 2000; ++i) {
    const PredictionModel model(car_number(i % 2));
    BodyMotion<double> motion{
        .vx = random.uniform(0.0, 60.0), .vy = random.uniform(-2.0, 2.0), .r = random.uniform(-1.5, 1.5)};
    for (int k = 0; k < 20; ++k) {
      motion = model.advance(motion, random.uniform(-0.43, 0.43), random.uniform(-9.0, 5.0),
                             random.uniform(0.001, 0.1));
      motion.vx = std::max(motion.vx, 0.0);
    }
    EXPECT_TRUE(std::isfinite(motion.vx + motion.vy + motion.r));
    EXPECT_LT(std::fabs(motion.r), 20.0);
  }
}

TEST(PredictionModel, MirrorsLeftAndRightExactly) {
  const PredictionModel model(model::road_car_params());
  const BodyMotion<double> left = model.advance<double>({25.0, -0.4, 0.3, 0.05, -2.0}, 0.08, -3.0, 0.05);
  const BodyMotion<double> right = model.advance<double>({25.0, 0.4, -0.3, -0.05, -2.0}, -0.08, -3.0, 0.05);
  EXPECT_EQ(left.vx, right.vx);
  EXPECT_EQ(left.vy, -right.vy);
  EXPECT_EQ(left.r, -right.r);
  EXPECT_EQ(left.steer, -right.steer);
}

Problem sample_problem(const PredictionModel& model, Random& random) {
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
  for (auto& stage : problem.stages) {
    stage = {.s = 1.0,
             .curvature = random.uniform(-0.05, 0.05),
             .curvature_slope = random.uniform(-0.003, 0.003),
             .speed = random.uniform(5.0, 50.0),
             .speed_slope = random.uniform(-0.3, 0.1),
             .left = 1.0,
             .right = 1.5};
  }
  return problem;
}

/// Largest difference between dual-number and central-difference Jacobians of a function of (x, u), relative
/// to its size.
template <class F>
double worst_jacobian_error(const F& function, const X& x, const U& u) {
  constexpr int kN = Problem::kNx + Problem::kNu;
  using D = Dual<kN>;
  std::array<D, Problem::kNx> xd;
  std::array<D, Problem::kNu> ud;
  for (int i = 0; i < Problem::kNx; ++i) xd[i] = D::variable(x[i], i);
  for (int i = 0; i < Problem::kNu; ++i) ud[i] = D::variable(u[i], Problem::kNx + i);
  const auto exact = function(xd, ud);
  double worst = 0.0;
  for (int j = 0; j < kN; ++j) {
    const double at = j < Problem::kNx ? x[j] : u[j - Problem::kNx];
    const double h =
        1e-6 * std::max(1.0, std::fabs(at));  // cube root of the rounding unit, in the variable's own size
    X xp = x, xm = x;
    U up = u, um = u;
    (j < Problem::kNx ? xp[j] : up[j - Problem::kNx]) += h;
    (j < Problem::kNx ? xm[j] : um[j - Problem::kNx]) -= h;
    const auto plus = function(xp, up);
    const auto minus = function(xm, um);
    for (std::size_t i = 0; i < plus.size(); ++i) {
      const double difference = (plus[i] - minus[i]) / (2.0 * h);
      worst = std::max(worst, std::fabs(difference - exact[i].d[j]) / (1.0 + std::fabs(difference)));
    }
  }
  return worst;
}

TEST(TrackingProblem, JacobiansEqualCentralDifferences) {
  Random random(5);
  for (int i = 0; i < 400; ++i) {
    const PredictionModel model(car_number(i % 2));
    const Problem problem = sample_problem(model, random);
    const X x{random.uniform(0.0, 3.0),  random.uniform(-2.0, 2.0), random.uniform(-0.3, 0.3),
              random.uniform(0.5, 50.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0),
              random.uniform(-0.2, 0.2), random.uniform(-6.0, 5.0)};
    const U u{random.uniform(-0.3, 0.3), random.uniform(-6.0, 5.0)};
    // 1e-5: differences of residuals with hinges and steep tyre curves; a wrong term would show as 1e-2 or
    // more.
    EXPECT_LT(
        worst_jacobian_error([&](const auto& a, const auto& b) { return problem.dynamics(2, a, b); }, x, u),
        1e-5);
    EXPECT_LT(
        worst_jacobian_error([&](const auto& a, const auto& b) { return problem.residual(2, a, b); }, x, u),
        1e-5);
    EXPECT_LT(
        worst_jacobian_error([&](const auto& a, const auto&) { return problem.terminal_residual(a); }, x, u),
        1e-5);
  }
}

TEST(TrackingProblem, AStraightLineIsDrivenStraight) {
  const PredictionModel model(model::udacity_params());
  Problem problem;
  problem.model = &model;
  const X to = problem.dynamics<double>(0, {0.0, 0.5, 0.0, 20.0, 0.0, 0.0, 0.0, 0.0}, {0.0, 0.0});
  EXPECT_DOUBLE_EQ(to[Problem::kS], 20.0 * problem.dt);
  EXPECT_DOUBLE_EQ(to[Problem::kD], 0.5);
  EXPECT_DOUBLE_EQ(to[Problem::kE], 0.0);
}

}  // namespace
}  // namespace chicane::controller
