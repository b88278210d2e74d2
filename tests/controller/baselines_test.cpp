// SPDX-License-Identifier: MIT
#include "chicane/controller/baselines.hpp"

#include "chicane/base/math.hpp"
#include "controller/every_controller.hpp"

namespace chicane::controller {
namespace {

const model::VehicleParams kAnyCar;

/// A straight road along W's x axis.
model::Measurement on_a_straight(double y, double psi, double speed) {
  model::Measurement now{.time = 1.0, .y = y, .psi = psi, .speed = speed, .waypoint_count = 6};
  for (int i = 0; i < 6; ++i) now.waypoints[static_cast<std::size_t>(i)] = {-5.0 + 12.0 * i, 0.0};
  return now;
}

TEST(Baselines, HoldTheWheelStraightOnTheLine) {
  for (const auto& controller : all_baselines()) {
    const test::Sent& result = controller->step(on_a_straight(0.0, 0.0, 10.0), Deadline::never());
    EXPECT_NEAR(result.command.steer, 0.0, 1e-9) << controller->name();
    EXPECT_EQ(result.guard.rung, Rung::kController);
  }
}

TEST(Baselines, SteerTowardsTheLineFromBothSidesAndBothHeadings) {
  for (const auto& controller : all_baselines()) {
    EXPECT_LT(controller->step(on_a_straight(1.0, 0.0, 10.0), Deadline::never()).command.steer, -0.01);
    EXPECT_GT(controller->step(on_a_straight(-1.0, 0.0, 10.0), Deadline::never()).command.steer, 0.01);
    EXPECT_LT(controller->step(on_a_straight(0.0, 0.2, 10.0), Deadline::never()).command.steer, -0.01);
    EXPECT_GT(controller->step(on_a_straight(0.0, -0.2, 10.0), Deadline::never()).command.steer, 0.01);
  }
}

TEST(Baselines, SpeedUpBelowTheReferenceAndBrakeUsefullyAboveIt) {
  for (const auto& controller : all_baselines()) {
    EXPECT_GT(controller->step(on_a_straight(0.0, 0.0, 0.0), Deadline::never()).command.throttle, 0.5);
    const double braking =
        controller->step(on_a_straight(0.0, 0.0, 40.0), Deadline::never()).command.throttle;
    EXPECT_LT(braking, 0.0);
    EXPECT_GE(braking, -kAnyCar.brake_throttle_limit);
  }
}

TEST(Baselines, StandStillWithoutTurningTheWheelToItsStop) {
  for (const auto& controller : all_baselines()) {
    const test::Sent& result = controller->step(on_a_straight(0.5, 0.0, 0.0), Deadline::never());
    EXPECT_LT(std::fabs(result.command.steer), kAnyCar.steer_limit) << controller->name();
  }
}

TEST(Baselines, KeepThePidIntegralBoundedWhileTheWheelIsAtItsStop) {
  PidOptions options;
  options.integral_gain = 0.5;
  const auto controller = std::move(*make_pid(options, kAnyCar));
  model::Measurement now = on_a_straight(6.0, 0.0, 5.0);
  for (int i = 0; i < 600; ++i, now.time += 0.05) (void)controller->step(now, Deadline::never());
  EXPECT_EQ(controller->step(now, Deadline::never()).command.steer, -kAnyCar.steer_limit);
  // Back on the line the wheel comes off the stop at once: 30 s of error have not been piled up.
  now.y = -1.0;
  int steps = 0;
  while (controller->step(now, Deadline::never()).command.steer < 0.0 && steps < 100) {
    now.time += 0.05;
    ++steps;
  }
  EXPECT_LT(steps, 40);
}

constexpr double kBendRadius = 30.0;

/// 200 m straight on along x, then half a circle to the left.
road::Path road() {
  std::vector<Vec2> points;
  for (int i = 0; i < 40; ++i) points.emplace_back(5.0 * i, 0.0);
  for (int i = 0; i <= 40; ++i) {
    const double angle = kPi * i / 40.0;
    points.emplace_back(200.0 + kBendRadius * std::sin(angle), kBendRadius * (1.0 - std::cos(angle)));
  }
  return road::Path::create(points, false).value();
}

const SpeedHold kHold{{.speed_reference = 25.0, .speed_gain = 0.3, .lateral_acceleration_limit = 6.0},
                      model::udacity_params()};

TEST(SpeedHold, AsksForTheReferenceUntilABendHasToBeBrakedFor) {
  const road::Path path = road();
  EXPECT_EQ(kHold.reference(path, 0.0).speed, 25.0);
  EXPECT_EQ(kHold.reference(path, 0.0).limiter, SpeedLimiter::kAsked);
  const SpeedHold::Wanted before = kHold.reference(path, 180.0);
  EXPECT_EQ(before.limiter, SpeedLimiter::kBraking);
  EXPECT_LT(before.speed, 20.0);
  const SpeedHold::Wanted within = kHold.reference(path, 240.0);
  EXPECT_LE(within.speed, before.speed);
  // v² κ = 6 m/s² where the spline has the circle's curvature within 2 %.
  EXPECT_NEAR(within.speed, std::sqrt(6.0 * kBendRadius), 0.02 * std::sqrt(6.0 * kBendRadius));
}

TEST(SpeedHold, HoldsASpeedAgainstDragAndActsAgainstAnError) {
  const model::VehicleParams car = model::udacity_params();
  const double holding = kHold.throttle(20.0, 20.0);
  EXPECT_NEAR(model::longitudinal_acceleration(car, holding, 20.0), 0.0, 1e-9);
  EXPECT_NEAR(kHold.throttle(21.0, 20.0), holding + 0.3, 1e-9);
  EXPECT_EQ(kHold.throttle(60.0, 20.0), 1.0);
  EXPECT_EQ(kHold.throttle(0.0, 20.0), -car.brake_throttle_limit);
}

}  // namespace
}  // namespace chicane::controller
