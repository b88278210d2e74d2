// SPDX-License-Identifier: MIT
#include "chicane/road/line_planner.hpp"

#include "chicane/model/vehicle.hpp"
#include "road/sample_loop.hpp"
#include "support/chicane_test.hpp"

namespace chicane::road {
namespace {

/// An open line, 600 m along x but for a bend to the left of `radius` [m] between 250 m and 300 m: the table
/// has its curvature, the positions stay on the straight, which a speed plan does not look at.
ReferenceLine with_a_bend(double radius) {
  ReferenceLine line(401);
  EXPECT_TRUE(line.shape(600.0, 400, false));
  for (std::size_t i = 0; i < line.samples().size(); ++i) {
    const double s = 1.5 * static_cast<double>(i);
    line.samples()[i].curve.position = {s, 0.0};
    line.samples()[i].curve.curvature = s >= 250.0 && s <= 300.0 ? 1.0 / radius : 0.0;
  }
  return line;
}

/// With tyres that brake as well in a bend as on a straight.
model::VehicleParams uncoupled_car() {
  model::VehicleParams car = model::road_car_params();
  car.friction_coupling = 0.0;
  return car;
}

void plan(ReferenceLine& line, const SpeedPlanOptions& options, int share = 1'000'000) {
  SpeedPlan speeds(401);
  speeds.begin(uncoupled_car(), options);
  for (int work = share; !speeds.advance(work, line); work = share) ASSERT_GT(share, 0);
}

TEST(SpeedPlan, SaysWhatLimitsTheSpeedBeforeInAndBehindABend) {
  ReferenceLine line = with_a_bend(40.0);
  plan(line, {.speed_limit = 40.0});
  const auto samples = line.samples();
  EXPECT_EQ(samples[10].limiter, SpeedLimiter::kAsked);
  EXPECT_EQ(samples[10].speed, 40.0);
  EXPECT_EQ(samples[160].limiter, SpeedLimiter::kBraking);  // 10 m before the bend
  EXPECT_EQ(samples[183].limiter, SpeedLimiter::kCurvature);
  EXPECT_EQ(samples[220].limiter, SpeedLimiter::kPower);
  EXPECT_EQ(samples[395].limiter, SpeedLimiter::kSight);
  const model::VehicleParams car = uncoupled_car();
  // The middle of the bend, where curvature does not change: v² κ = share · friction · g.
  EXPECT_NEAR(samples[183].speed, std::sqrt(0.9 * car.cornering_friction() * car.load_constant * 40.0), 1e-9);
}

TEST(SpeedPlan, IsNoFasterThanTheCarsParametersHold) {
  ReferenceLine line = with_a_bend(40.0);
  model::VehicleParams car = uncoupled_car();
  car.valid_speed = 30.0;
  SpeedPlan speeds(401);
  speeds.begin(car, {.speed_limit = 40.0});
  for (int work = 1'000'000; !speeds.advance(work, line);) work = 1'000'000;
  EXPECT_EQ(line.samples()[10].speed, 30.0);
  EXPECT_EQ(line.samples()[10].limiter, SpeedLimiter::kAsked);
}

// To turn in, the front axle needs more than the bend; to turn out, the rear one (docs/controller.md, eq.
// 11).
TEST(SpeedPlan, HoldsTheAxleThatNeedsMoreWhereTheCurvatureChanges) {
  ReferenceLine line = with_a_bend(40.0);
  plan(line, {.speed_limit = 40.0});
  const model::VehicleParams car = uncoupled_car();
  const double slope = 1.0 / 40.0 / 6.0;  // over 3 m each way
  const double entry = 1.0 / 40.0 + car.yaw_inertia / (car.mass * car.rear_axle) * slope;
  const double exit = 1.0 / 40.0 + car.yaw_inertia / (car.mass * car.front_axle) * slope;
  const double grip = 0.9 * car.cornering_friction() * car.load_constant;
  EXPECT_NEAR(line.samples()[167].speed, std::sqrt(grip / entry), 1e-9);
  EXPECT_NEAR(line.samples()[200].speed, std::sqrt(grip / exit), 1e-9);
}

// Told the truth about a slippery road, the car braked as on a dry one and left the road (it did with 0.6 of
// the grip).
TEST(SpeedPlan, BrakesWithWhatTheSurfaceGives) {
  const auto before_bend = [](double grip) {
    ReferenceLine line = with_a_bend(40.0);
    SpeedPlan speeds(401);
    speeds.begin(model::with_grip(model::road_car_params(), grip), {.speed_limit = 60.0, .brake_share = 1.0});
    for (int work = 1'000'000; !speeds.advance(work, line);) ADD_FAILURE();
    const auto samples = line.samples();
    const double v = samples[150].speed;
    const double ahead = samples[151].speed;
    EXPECT_EQ(samples[150].limiter, SpeedLimiter::kBraking);
    return (v * v - ahead * ahead) / (2.0 * line.spacing());  // deceleration [m/s²]
  };
  const model::VehicleParams car = model::road_car_params();
  const double drag = -longitudinal_acceleration(car, 0.0, 30.0);
  EXPECT_NEAR(before_bend(1.0), car.brake_acceleration + drag, 0.2) << "what the brakes give";
  const double grip = model::with_grip(car, 0.5).cornering_friction() * car.load_constant;
  EXPECT_NEAR(before_bend(0.5), 0.85 * grip + drag, 0.2) << "what the road gives";
}

// Brakes in a wide bend for a narrow one: with what the friction ellipse leaves beside the sideways force.
TEST(SpeedPlan, SharesTheGripBetweenBrakingAndCornering) {
  for (const double coupling : {1.0, 0.5}) {
    model::VehicleParams car = model::road_car_params();
    car.friction_coupling = coupling;
    const SpeedPlanOptions options{.grip_share = 0.9, .brake_share = 0.5};
    ReferenceLine line = with_a_bend(30.0);
    for (std::size_t i = 60; i < 167; ++i) line.samples()[i].curve.curvature = 1.0 / 90.0;
    SpeedPlan speeds(401);
    speeds.begin(car, options);
    for (int work = 1'000'000; !speeds.advance(work, line);) ADD_FAILURE();
    const double v = line.samples()[158].speed;  // 13 m before the narrow bend
    const double before = line.samples()[157].speed;
    ASSERT_EQ(line.samples()[157].limiter, SpeedLimiter::kBraking);
    const double use = v * v / 90.0 * (1.0 - car.steer_helper) /
                       (options.grip_share * car.cornering_friction() * car.load(v));
    ASSERT_GT(use, 0.3);
    const double drag = longitudinal_acceleration(car, 0.0, v);
    const double force = drag - longitudinal_acceleration(car, -car.brake_throttle_limit, v);
    EXPECT_NEAR((before * before - v * v) / (2.0 * line.spacing()),
                options.brake_share * std::sqrt(1.0 - coupling * use * use) * force - drag, 1e-9);
  }
}

TEST(SpeedPlan, EndsAnOpenLineAtTheSpeedOfTheBendThatMayFollow) {
  ReferenceLine line = with_a_bend(1e6);
  plan(line, {.end_curvature = 0.02});
  const model::VehicleParams car = model::road_car_params();
  EXPECT_NEAR(line.samples().back().speed,
              std::sqrt(0.9 * car.cornering_friction() * car.load_constant / 0.02), 1e-9);
  EXPECT_EQ(line.samples().back().limiter, SpeedLimiter::kSight);
}

TEST(SpeedPlan, IsTheSameHoweverTheWorkIsShared) {
  ReferenceLine whole = with_a_bend(60.0);
  ReferenceLine in_parts = with_a_bend(60.0);
  plan(whole, {});
  plan(in_parts, {}, 37);
  for (std::size_t i = 0; i < whole.samples().size(); ++i)
    ASSERT_EQ(whole.samples()[i].speed, in_parts.samples()[i].speed) << i;
}

TEST(SpeedPlan, KeepsTheTyresWithinTheirShare) {
  Road road({.smoothing_width = 0.0, .speed = {.grip_share = 0.7}}, model::road_car_params());
  learn(road, stadium());
  const model::VehicleParams car = model::road_car_params();
  for (double s = 0.0; s < road.line().length(); s += 5.0) {
    const ReferenceLine::Demand at = road.line().demand(s);
    // 3 %: samples lie 1.5 m apart.
    EXPECT_LE(at.speed * at.speed * std::fabs(at.curvature), 1.03 * 0.7 * car.friction * car.load_constant)
        << s;
    EXPECT_GE(at.speed, 2.0);
  }
}

TEST(SpeedPlan, NeverAsksForMoreThanDriveAndBrakesGive) {
  const model::VehicleParams car = model::road_car_params();
  Road road({.speed = {.brake_share = 0.5}}, car);
  learn(road, stadium());
  for (double s = 0.0; s < road.line().length(); s += 2.0) {
    const ReferenceLine::Demand at = road.line().demand(s);
    const double a = at.speed * at.speed_slope;
    // 0.15 m/s²: interpolation between samples.
    EXPECT_LE(a, longitudinal_acceleration(car, 1.0, at.speed) + 0.15) << s;
    EXPECT_GE(a, longitudinal_acceleration(car, -1.0, at.speed) - 0.15) << s;
  }
}

TEST(SpeedPlan, IsTheSameAtTheSeam) {
  Road road({}, model::udacity_params());
  learn(road, stadium());
  const auto samples = road.line().samples();
  EXPECT_EQ(samples.front().speed, samples.back().speed);
  EXPECT_NEAR(samples.front().curve.curvature, samples.back().curve.curvature, 1e-12);
  EXPECT_NEAR(samples.back().curve.heading - samples.front().curve.heading, kTwoPi, 1e-12);
  EXPECT_NEAR((samples.front().curve.position - samples.back().curve.position).norm(), 0.0, 1e-9);
}

}  // namespace
}  // namespace chicane::road
