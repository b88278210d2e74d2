// SPDX-License-Identifier: MIT
#include "chicane/road/line_planner.hpp"
#include "chicane/model/vehicle.hpp"

#include "road/sample_loop.hpp"
#include "support/chicane_test.hpp"

namespace chicane::road {
namespace {

constexpr int kKnots = 300;

/// The stadium's waypoints, and on into the second lap.
struct Source {
  Source() {
    const std::vector<Vec2> points = stadium();
    WaypointMap map;
    for (int i = 0; i < 60; ++i) (void)map.add(seeing(points, i));
    EXPECT_TRUE(map.is_closed());
    line.clear();
    for (int newest = 11; newest < 80; ++newest) EXPECT_TRUE(line.extend(map, newest));
  }
  WaypointLine line;
};

struct Planned {
  ReferenceLine line{LinePlanner::samples_for(kKnots)};
  int cycles = 0;
};

Planned plan(const Source& source, double from, double to, bool is_lap, double width, int share = 1'000'000) {
  LinePlanner planner(kKnots);
  planner.configure({.smoothing_width = width}, model::road_car_params());
  Planned planned;
  EXPECT_TRUE(planner.begin(from, to, is_lap));
  while (!planner.advance(share, source.line, planned.line)) ++planned.cycles;
  return planned;
}

TEST(LinePlanner, KeepsToAStretchOfTheWaypointLineWithoutRoomToSmooth) {
  const Source source;
  const Planned planned = plan(source, 30.0, 230.0, false, 0.0);
  const ReferenceLine& line = planned.line;
  EXPECT_FALSE(line.is_closed());
  EXPECT_NEAR(line.length(), 200.0, 0.1);
  EXPECT_LE(line.spacing(), LinePlanner::kSampleSpacing);
  EXPECT_LT((line.at(0.0).position - source.line.at(30.0).position).norm(), 1e-9);
  EXPECT_LT((line.at(line.length()).position - source.line.at(230.0).position).norm(), 0.02);
  for (const ReferenceLine::Sample& sample : line.samples()) {
    EXPECT_EQ(sample.offset, 0.0);
    EXPECT_GE(sample.speed, 2.0);
  }
}

TEST(LinePlanner, ClosesALap) {
  const Source source;
  const Planned planned = plan(source, source.line.along(8), source.line.along(68), true, 1.5);
  const auto samples = planned.line.samples();
  ASSERT_TRUE(planned.line.is_closed());
  EXPECT_LT((samples.front().curve.position - samples.back().curve.position).norm(), 1e-9);
  EXPECT_EQ(samples.front().speed, samples.back().speed);
  // A turn more to one side makes the lap longer or shorter by 2π times the offset.
  EXPECT_NEAR(planned.line.length(), source.line.along(68) - source.line.along(8), kTwoPi * 1.3 * 1.5);
}

TEST(LinePlanner, PlansTheSameLineInInstalments) {
  const Source source;
  const Planned whole = plan(source, 30.0, 330.0, false, 1.5);
  const Planned in_parts = plan(source, 30.0, 330.0, false, 1.5, 200);
  EXPECT_LE(whole.cycles, 1);
  EXPECT_GT(in_parts.cycles, 10);
  ASSERT_EQ(whole.line.samples().size(), in_parts.line.samples().size());
  for (std::size_t i = 0; i < whole.line.samples().size(); ++i) {
    ASSERT_EQ(whole.line.samples()[i].curve.position, in_parts.line.samples()[i].curve.position) << i;
    ASSERT_EQ(whole.line.samples()[i].speed, in_parts.line.samples()[i].speed) << i;
  }
}

TEST(LinePlanner, TakesAboutTheWorkItSays) {
  const Source source;
  const Planned planned = plan(source, 30.0, 630.0, false, 1.5, 20);
  EXPECT_NEAR(planned.cycles, 600, 200) << "20 units for each metre";
}

TEST(LinePlanner, RefusesAStretchWithoutLengthOrWithTooManyKnots) {
  const Source source;
  LinePlanner planner(50);
  planner.configure({}, model::road_car_params());
  EXPECT_FALSE(planner.begin(30.0, 30.0, false));
  EXPECT_FALSE(planner.begin(60.0, 30.0, false));
  EXPECT_FALSE(planner.begin(0.0, std::nan(""), false));
  EXPECT_FALSE(planner.begin(0.0, 50 * WaypointLine::kSpacing, false));
  EXPECT_TRUE(planner.begin(0.0, 49 * WaypointLine::kSpacing, false));
}

constexpr int kKnotCount = 80;
constexpr double kSpacing = 3.0;

/// Offsets for a line of the given curvatures.
std::vector<double> smooth(const std::vector<double>& curvature, double width, int share = 1'000'000) {
  LineSmoother smoother(kKnotCount);
  smoother.configure(width, 4.0);
  smoother.begin(kKnotCount, kSpacing, 0);
  std::copy(curvature.begin(), curvature.end(), smoother.curvature().begin());
  for (int work = share; !smoother.advance(work); work = share) {
  }
  std::vector<double> offsets;
  for (int k = 0; k < kKnotCount; ++k) offsets.push_back(smoother.offset(k));
  return offsets;
}

/// One bend to the left by 1.2 rad in the middle of a straight.
std::vector<double> bend() {
  std::vector<double> curvature(kKnotCount, 0.0);
  for (std::size_t k = 30; k < 50; ++k) curvature[k] = 0.02;
  return curvature;
}

double bending(const std::vector<double>& curvature, const std::vector<double>& n) {
  double sum = 0.0;
  for (std::size_t k = 1; k + 1 < n.size(); ++k) {
    const double kappa = curvature[k] * (1.0 + curvature[k] * n[k]) +
                         (n[k - 1] - 2.0 * n[k] + n[k + 1]) / (kSpacing * kSpacing);
    sum += kappa * kappa;
  }
  return sum;
}

TEST(LineSmoother, LeavesAStraightLineAndALineWithoutRoomWhereTheyAre) {
  for (const double n : smooth(std::vector<double>(kKnotCount, 0.0), 2.0)) EXPECT_EQ(n, 0.0);
  for (const double n : smooth(bend(), 0.0)) EXPECT_EQ(n, 0.0);
}

TEST(LineSmoother, CutsABendOnItsInsideAndBendsLess) {
  const std::vector<double> n = smooth(bend(), 1.5);
  EXPECT_GT(*std::max_element(n.begin() + 35, n.begin() + 45), 0.5) << "left is the inside";
  EXPECT_LT(std::min(n[25], n[54]), -0.3) << "and comes from the outside";
  EXPECT_LT(bending(bend(), n), 0.8 * bending(bend(), std::vector<double>(kKnotCount, 0.0)));
}

TEST(LineSmoother, KeepsWithinAboutItsWidth) {
  for (const double width : {0.5, 1.0, 2.0}) {
    // The weight is raised a few times over, and not until the bound holds.
    for (const double n : smooth(bend(), width)) EXPECT_LT(std::fabs(n), 1.3 * width) << width;
  }
}

TEST(LineSmoother, MirrorsLeftAndRightExactly) {
  std::vector<double> right = bend();
  for (double& kappa : right) kappa = -kappa;
  const std::vector<double> n = smooth(bend(), 1.5);
  const std::vector<double> mirrored = smooth(right, 1.5);
  for (std::size_t k = 0; k < n.size(); ++k) EXPECT_EQ(mirrored[k], -n[k]) << k;
}

TEST(LineSmoother, GivesTheSameBitsHoweverTheWorkIsShared) {
  EXPECT_EQ(smooth(bend(), 1.5, 7), smooth(bend(), 1.5));
}

TEST(LineSmoother, MovesAClosedLineAlikeWhereItMeetsItself) {
  constexpr int kPeriod = 84;  // knots 84 to 167, and a lap more at both ends
  constexpr int kAll = 3 * kPeriod;
  LineSmoother smoother(kAll);
  smoother.configure(1.0, 4.0);
  smoother.begin(kAll, kSpacing, kPeriod);
  for (int k = 0; k < kAll; ++k)
    smoother.curvature()[static_cast<std::size_t>(k)] = 0.03 * (k % 42 < 20 ? 1.0 : 0.2);
  for (int work = 1'000'000; !smoother.advance(work); work = 1'000'000) {
  }
  // Both places are 250 m from an end, where the line is held.
  for (int k = 82; k < 87; ++k) EXPECT_NEAR(smoother.offset(k), smoother.offset(k + kPeriod), 0.02) << k;
}

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

void plan(ReferenceLine& line, const model::VehicleParams& car, const SpeedPlanOptions& options,
          int share = 1'000'000) {
  SpeedPlan speeds(401);
  speeds.begin(car, options);
  for (int work = share; !speeds.advance(work, line); work = share) ASSERT_GT(share, 0);
}

TEST(SpeedPlan, SaysWhatLimitsTheSpeedBeforeInAndBehindABend) {
  ReferenceLine line = with_a_bend(40.0);
  plan(line, uncoupled_car(), {.speed_limit = 40.0});
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
  plan(line, car, {.speed_limit = 40.0});
  EXPECT_EQ(line.samples()[10].speed, 30.0);
  EXPECT_EQ(line.samples()[10].limiter, SpeedLimiter::kAsked);
}

// To turn in, the front axle needs more than the bend; to turn out, the rear one (docs/controller.md, eq.
// 11).
TEST(SpeedPlan, HoldsTheAxleThatNeedsMoreWhereTheCurvatureChanges) {
  ReferenceLine line = with_a_bend(40.0);
  plan(line, uncoupled_car(), {.speed_limit = 40.0});
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
    plan(line, model::with_grip(model::road_car_params(), grip), {.speed_limit = 60.0, .brake_share = 1.0});
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
    plan(line, car, options);
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
  plan(line, uncoupled_car(), {.end_curvature = 0.02});
  const model::VehicleParams car = model::road_car_params();
  EXPECT_NEAR(line.samples().back().speed,
              std::sqrt(0.9 * car.cornering_friction() * car.load_constant / 0.02), 1e-9);
  EXPECT_EQ(line.samples().back().limiter, SpeedLimiter::kSight);
}

TEST(SpeedPlan, IsTheSameHoweverTheWorkIsShared) {
  ReferenceLine whole = with_a_bend(60.0);
  ReferenceLine in_parts = with_a_bend(60.0);
  plan(whole, uncoupled_car(), {});
  plan(in_parts, uncoupled_car(), {}, 37);
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
