// SPDX-License-Identifier: MIT
#include "chicane/controller/baselines.hpp"

#include "chicane/base/math.hpp"
#include "controller/sample_road.hpp"
#include "support/chicane_test.hpp"
#include "support/guarded.hpp"

namespace chicane::controller {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
const model::VehicleParams kAnyCar;

std::vector<std::unique_ptr<test::Guarded>> all_baselines(safety::GuardMode mode = safety::GuardMode::kOff) {
  std::vector<std::unique_ptr<test::Guarded>> all;
  all.push_back(std::make_unique<test::Guarded>(std::move(*make_pid({}, kAnyCar)), kAnyCar, mode));
  all.push_back(std::make_unique<test::Guarded>(std::move(*make_pure_pursuit({}, kAnyCar)), kAnyCar, mode));
  all.push_back(std::make_unique<test::Guarded>(std::move(*make_stanley({}, kAnyCar)), kAnyCar, mode));
  return all;
}

/// A straight road along W's x axis.
model::Measurement on_a_straight(double y, double psi, double speed) {
  model::Measurement now;
  now.time = 1.0;
  now.y = y;
  now.psi = psi;
  now.speed = speed;
  now.waypoint_count = 6;
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

TEST(Baselines, MirrorWithTheWorldAndDoNotCareWhereTheyDrive) {
  auto here = all_baselines();
  auto mirror = all_baselines();
  auto there = all_baselines();
  for (std::size_t i = 0; i < here.size(); ++i) {
    const model::Command a = here[i]->step(on_a_left_bend(), Deadline::never()).command;
    const model::Command b = mirror[i]->step(mirrored(on_a_left_bend()), Deadline::never()).command;
    const model::Command c = there[i]->step(on_a_left_bend(-321.0, 99.0, 2.5), Deadline::never()).command;
    EXPECT_NEAR(a.steer, -b.steer, 1e-9);
    EXPECT_NEAR(a.steer, c.steer, 1e-6);  // projection onto the spline stops at about 1e-8 m
    EXPECT_NEAR(a.throttle, c.throttle, 1e-6);
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

TEST(Baselines, SlowDownForACurve) {
  PidOptions options;
  options.speed.speed_reference = 30.0;
  options.speed.lateral_acceleration_limit = 2.0;
  const auto controller = std::move(*make_pid(options, kAnyCar));
  const StepResult& result = controller->step(on_a_left_bend(), Deadline::never());
  // sqrt(2 m/s² · 80 m) = 12.6 m/s; the ends of the spline are straighter, so a little is allowed on top.
  EXPECT_NEAR(result.report.speed_reference, std::sqrt(2.0 * 80.0), 1.5);
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

TEST(Baselines, AnswerAlsoWithoutAUsableMeasurement) {
  for (const auto& controller : all_baselines()) {
    std::vector<model::Measurement> hostile(7, on_a_left_bend());
    hostile[0].x = kNotANumber;
    hostile[1].psi = std::numeric_limits<double>::infinity();
    hostile[2].speed = kNotANumber;
    hostile[3].time = kNotANumber;
    hostile[4].waypoint_count = 0;
    hostile[5].waypoint_count = 1;
    for (Vec2& point : hostile[6].waypoints) point = {1.0, 1.0};
    for (const auto& now : hostile) {
      const test::Sent& result = controller->step(now, Deadline::never());
      ASSERT_TRUE(std::isfinite(result.command.steer) && std::isfinite(result.command.throttle));
      ASSERT_LE(std::fabs(result.command.steer), kAnyCar.steer_limit);
      ASSERT_LE(std::fabs(result.command.throttle), 1.0);
      EXPECT_NE(result.guard.rung, Rung::kController);
    }
  }
}

TEST(Baselines, RefuseOptionsOutOfRangeByName) {
  PidOptions pid;
  pid.integral_gain = -1.0;
  EXPECT_EQ(make_pid(pid, kAnyCar).error().message,
            "pid.integral_gain: got -1, expected a number in [0, 10] rad/(m s)");
  PurePursuitOptions pursuit;
  pursuit.lookahead_min = 0.0;
  EXPECT_NE(make_pure_pursuit(pursuit, kAnyCar).error().message.find("pure_pursuit.lookahead_min"),
            std::string::npos);
  StanleyOptions stanley;
  stanley.speed.speed_gain = kNotANumber;
  EXPECT_NE(make_stanley(stanley, kAnyCar).error().message.find("speed_gain"), std::string::npos);
}

TEST(Baselines, AreNotToldOfAPlaceThatJumps) {
  for (const auto& controller : all_baselines(safety::GuardMode::kOn)) {
    model::Measurement now = on_a_straight(0.0, 0.0, 10.0);
    const auto drive = [&](double aside) {
      now.time += 0.05;
      now.x += 0.5;
      now.y += aside;
      now.speed += 1e-3;  // as a sensor that is not stuck
      return controller->step(now, Deadline::never());
    };
    for (int i = 0; i < 4; ++i) EXPECT_EQ(drive(0.0).guard.rung, Rung::kController) << controller->name();
    const double steer = drive(0.0).command.steer;
    const test::Sent jumped = drive(5.0);
    EXPECT_NE(jumped.guard.rung, Rung::kController) << controller->name();
    EXPECT_NEAR(jumped.command.steer, steer, 0.02);
    EXPECT_LT(jumped.command.throttle, 0.0);
    EXPECT_EQ(drive(-5.0).guard.rung, Rung::kController);
  }
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
