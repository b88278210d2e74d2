// SPDX-License-Identifier: MIT
#include "chicane/safety/stop_planner.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "chicane/base/math.hpp"
#include "support/alloc_guard.hpp"

namespace chicane::safety {
namespace {

/// A circle, 10 m wide; `side` 1 turns left.
road::KnownRoad circle(double radius, double side = 1.0) {
  road::RoadData data;
  data.length = kTwoPi * radius;
  constexpr int kCount = 400;
  for (int i = 0; i <= kCount; ++i) {
    const double angle = kTwoPi * i / kCount;
    data.points.push_back({.s = data.length * i / kCount,
                           .position = {radius * std::sin(angle), side * radius * (1.0 - std::cos(angle))},
                           .heading = side * angle,
                           .curvature = side / radius,
                           .left = 5.0,
                           .right = 5.0});
  }
  return {data, model::udacity_params()};
}

StopStart start_at(double s, double speed, double d = 0.0, double e = 0.0) {
  return {.time = 2.0, .s = s, .d = d, .e = e, .body = {.vx = speed}};
}

const model::VehicleParams kCars[] = {model::udacity_params(), model::road_car_params()};

TEST(StopPlanner, StopsOnAStraightRoadAsFastAsItBrakes) {
  const road::KnownRoad road = circle(1e5);
  for (const model::VehicleParams& car : kCars) {
    const StopPlanner planner(car);
    StopPlan stop;
    for (const double speed : {10.0, 20.0, 30.0}) {
      const StopCheck check = planner.plan(road, start_at(100.0, speed), {.braking = {.share = 1.0}}, stop);
      EXPECT_TRUE(check.stands) << car.name << speed;
      EXPECT_GT(check.least_edge, 3.5);
      const double ideal =
          speed * speed / (2.0 * -longitudinal_acceleration(car, -car.brake_throttle_limit, 0.5 * speed));
      EXPECT_GT(check.distance, 0.8 * ideal);
      EXPECT_LT(check.distance, 1.5 * ideal + 4.0) << car.name << " " << speed;
    }
  }
}

TEST(StopPlanner, PlanIsWhatAReceiverCanDrive) {
  const road::KnownRoad road = circle(80.0);
  const StopPlanner planner(kCars[0]);
  StopPlan stop;
  const StopCheck check = planner.plan(road, start_at(10.0, 25.0), {.braking = {.share = 0.8}}, stop);
  ASSERT_TRUE(check.stands);
  ASSERT_GT(stop.size, 10);
  EXPECT_EQ(stop.points[0].time, 2.0);
  for (int i = 1; i < stop.size; ++i) {
    const auto k = static_cast<std::size_t>(i);
    EXPECT_GT(stop.points[k].time, stop.points[k - 1].time);
    EXPECT_GE(stop.points[k].distance, stop.points[k - 1].distance);
    EXPECT_LE(stop.points[k].command.throttle, 0.0);
    EXPECT_LE(std::fabs(stop.points[k].command.steer), kCars[0].steer_limit);
  }
  EXPECT_NEAR(stop.points[static_cast<std::size_t>(stop.size - 1)].distance, check.distance, 1.0);
}

TEST(StopPlanner, IsTheSameInAMirror) {
  const road::KnownRoad left = circle(60.0), right = circle(60.0, -1.0);
  for (const model::VehicleParams& car : kCars) {
    const StopPlanner planner(car);
    StopPlan one, other;
    const StopCheck a =
        planner.plan(left, start_at(20.0, 18.0, 1.0, -0.05), {.braking = {.share = 0.8}}, one);
    const StopCheck b =
        planner.plan(right, start_at(20.0, 18.0, -1.0, 0.05), {.braking = {.share = 0.8}}, other);
    EXPECT_NEAR(a.least_edge, b.least_edge, 1e-9);
    EXPECT_NEAR(a.distance, b.distance, 1e-9);
    ASSERT_EQ(one.size, other.size);
    for (int i = 0; i < one.size; ++i) {
      const auto k = static_cast<std::size_t>(i);
      EXPECT_NEAR(one.points[k].command.steer, -other.points[k].command.steer, 1e-9) << i;
      EXPECT_NEAR(one.points[k].command.throttle, other.points[k].command.throttle, 1e-9);
    }
  }
}

/// The largest distance to the left of the middle [m] from which a car that stands on its road and heads to
/// the left edge may creep with its wheels to the right.
double farthest(const StopPlanner& planner, const road::KnownRoad& road, StopPlanner::Arc arc, double side) {
  arc.steer = -side * 0.9 * kCars[1].steer_limit;
  double inside = 0.0, outside = planner.edge(road, start_at(100.0, 0.0, 0.0, side * 0.9)) - 0.02;
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (inside + outside);
    (planner.creeps_inside(road, start_at(100.0, 0.0, side * middle, side * 0.9), arc) ? inside : outside) =
        middle;
  }
  return inside;
}

TEST(StopPlanner, CreepsOnArcsThatStayInsideAndJudgesTheirEndAgain) {
  const StopPlanner planner(kCars[1]);
  const road::KnownRoad road = circle(1e5);
  const double sure = farthest(planner, road, {.hold = 0.1}, 1.0);
  EXPECT_GT(sure, 2.0);
  EXPECT_NEAR(farthest(planner, road, {.hold = 0.1, .doubt = 0.1}, 1.0), sure + 0.1, 1e-3);
  EXPECT_NEAR(farthest(planner, road, {.hold = 0.1}, -1.0), sure, 1e-3) << "mirror";
  EXPECT_NEAR(farthest(planner, road, {.hold = 9.0, .doubt = 0.1}, 1.0), sure, 1e-6) << "no stop before it";
}

TEST(StopPlanner, SaysWhenTheCarIsTooFastForTheBend) {
  const road::KnownRoad road = circle(40.0);
  const StopPlanner planner(model::road_car_params());
  StopPlan stop;
  EXPECT_GT(planner.plan(road, start_at(10.0, 12.0), {.braking = {.share = 0.8}}, stop).least_edge, 1.0);
  const StopCheck fast =
      planner.plan(road, start_at(10.0, 35.0), {.braking = {.share = 1.0}}, stop);  // 3.1 g
  EXPECT_TRUE(fast.least_edge < 0.0 || !fast.stands);
}

TEST(StopPlanner, ComesBackToTheMiddleFromBothSides) {
  const road::KnownRoad road = circle(1e5);
  for (const model::VehicleParams& car : kCars) {
    const StopPlanner planner(car);
    for (const double d : {3.0, -3.0}) {
      double edge = 9.0;
      StopStart at = start_at(100.0, 30.0, d);
      for (int i = 0; i < 100 && at.body.vx > 0.5; ++i)
        at = planner.advance(road, at, planner.command(road, at, {.braking = {.share = 0.6}}), 0.05, edge);
      EXPECT_LT(std::fabs(at.d), 1.6) << car.name;
    }
  }
}

TEST(StopPlanner, MeasuresTheEdgeAtTheOutermostTyre) {
  const road::KnownRoad road = circle(1e5);
  const model::VehicleParams car = model::udacity_params();
  const StopPlanner planner(car);
  const double half = 0.5 * (car.track_width + car.tire_width);
  constexpr double kArc = 2e-5;  // [m] that a road of 100 km of radius bends away between the axles
  EXPECT_NEAR(planner.edge(road, start_at(100.0, 0.0, 1.0)), 5.0 - 1.0 - half, kArc);
  EXPECT_NEAR(planner.edge(road, start_at(100.0, 0.0, -2.0)), 5.0 - 2.0 - half, kArc);
  const double e = 0.3;
  EXPECT_NEAR(planner.edge(road, start_at(100.0, 0.0, 0.0, e)),
              5.0 - car.rear_axle * std::sin(e) - half * std::cos(e), kArc)
      << "the rear axle is further from the centre of mass";
}

/// On the outside of a hairpin the road bends away from the axles.
TEST(StopPlanner, MeasuresTheEdgeOfATightBend) {
  constexpr double kRadius = 12.0;
  const road::KnownRoad road = circle(kRadius);
  const model::VehicleParams car = model::udacity_params();
  const StopPlanner planner(car);
  const double half = 0.5 * (car.track_width + car.tire_width);
  for (const double e : {-0.3, 0.0, 0.3}) {
    const auto outside = [&](double x) {  // of an axle, from the bend's centre
      return std::hypot(kRadius + 2.0 - x * std::sin(e), x * std::cos(e)) + half * std::cos(e);
    };
    const double exact = kRadius + 5.0 - std::max(outside(car.front_axle), outside(-car.rear_axle));
    EXPECT_NEAR(planner.edge(road, start_at(20.0, 0.0, -2.0, e)), exact, 0.02) << e;
  }
}

TEST(StopPlanner, NeedsTheRoadAsFarAsItStops) {
  road::RoadData data;
  data.length = 60.0;
  for (int i = 0; i <= 30; ++i)
    data.points.push_back({.s = 2.0 * i, .position = {2.0 * i, 0.0}, .left = 5.0, .right = 5.0});
  const road::KnownRoad road(data, kCars[0]);
  const StopPlanner planner(kCars[0]);
  StopPlan stop;
  EXPECT_TRUE(planner.plan(road, start_at(5.0, 20.0), {.braking = {.share = 1.0}}, stop).stands);
  EXPECT_FALSE(planner.plan(road, start_at(5.0, 40.0), {.braking = {.share = 1.0}}, stop).stands);
}

/// Behind its lag the wheel turns with its rate, not with what the lag leaves of it.
TEST(StopPlanner, TurnsTheWheelAsFastAsTheActuatorDoes) {
  const road::KnownRoad road = circle(1e5);
  const model::VehicleParams car = kCars[1];
  const StopPlanner planner(car);
  double edge = 0.0;
  const StopStart at = planner.advance(road, start_at(100.0, 5.0), {.steer = car.steer_limit}, 0.2, edge);
  // The rate binds nearly all the way: what is left of the lag at the end is less than an eighth of it.
  EXPECT_GT(at.body.steer, 0.85 * 0.2 * car.steer_rate_limit);
  EXPECT_LE(at.body.steer, 0.2 * car.steer_rate_limit);
}

/// What a receiver that drives the stop by itself can count on: less room than planned, and less the longer.
TEST(StopPlanner, KnowsHowFarABlindDriverStrays) {
  for (const double side : {1.0, -1.0}) {
    const road::KnownRoad road = circle(120.0, side);
    for (const model::VehicleParams& car : kCars) {
      const StopPlanner planner(car);
      StopPlan stop;
      StopStart start = start_at(20.0, 24.0);
      start.body.r = side * 24.0 / 120.0;
      const StopCheck check = planner.plan(road, start, {.braking = {.share = 0.8}}, stop);
      ASSERT_TRUE(check.stands);
      double before = planner.played(road, start, stop, 0.25).edge_for;
      EXPECT_LT(before, check.least_edge + 0.5);
      EXPECT_GT(before, check.least_edge - 0.5);
      for (const double time : {0.5, 1.0, 2.0, 60.0}) {
        const DoubtCheck blind = planner.played(road, start, stop, time);
        const double edge = blind.edge_for;
        EXPECT_LE(blind.edge, edge);
        EXPECT_EQ(blind.speed, 0.0);
        EXPECT_LE(edge, before) << car.name << time;
        before = edge;
      }
      EXPECT_LT(before, check.least_edge + 0.05) << car.name;
      EXPECT_GT(before, check.least_edge - 3.0) << car.name;
    }
  }
}

/// A blind driver who leaves the road does so at a speed, and later than in the time asked for.
TEST(StopPlanner, KnowsHowFastABlindDriverLeavesTheRoad) {
  const road::KnownRoad road = circle(120.0);
  const StopPlanner planner(kCars[1]);
  StopPlan stop;
  const StopStart start = start_at(20.0, 24.0);
  static_cast<void>(planner.plan(road, start, {.braking = {.share = 0.5}}, stop));
  for (int i = 0; i < stop.size; ++i) stop.points[static_cast<std::size_t>(i)].command.steer = 0.0;
  const DoubtCheck blind = planner.played(road, start, stop, 0.5);
  EXPECT_GT(blind.edge_for, 0.0);
  EXPECT_LT(blind.edge, 0.0);
  EXPECT_GT(blind.speed, 8.0);
  EXPECT_LT(blind.speed, 24.0);
  EXPECT_LT(planner.played(road, start, stop, 10.0).edge_for, 0.0);
}

/// On a straight before a bend that it is too fast for, a car brakes harder than would leave it stable
/// without a driver, and gently again where the road ahead does not ask for it.
TEST(StopPlanner, BrakesForTheBendsAhead) {
  const model::VehicleParams car = kCars[1];
  const StopPlanner planner(car);
  const auto braking = [&](double radius, double foreseen) {
    road::RoadData data;
    constexpr double kStraight = 120.0;
    data.length = kStraight + 0.5 * kPi * radius;
    for (double s = 0.0; s <= data.length; s += 2.0) {
      const double angle = std::max(s - kStraight, 0.0) / radius;
      data.points.push_back(
          {.s = s,
           .position = {std::min(s, kStraight) + radius * std::sin(angle), radius * (1.0 - std::cos(angle))},
           .heading = angle,
           .curvature = s > kStraight ? 1.0 / radius : 0.0,
           .left = 5.0,
           .right = 5.0});
    }
    const road::KnownRoad road(data, car);
    return -planner.slowing(road, start_at(20.0, 45.0), {.stability = 1.6, .foreseen = foreseen});
  };
  EXPECT_GT(braking(80.0, 0.7), 1.2 * braking(80.0, 1.6));
  EXPECT_EQ(braking(1e4, 0.7), braking(1e4, 1.6));
}

/// What is stable on a straight may not be in a bend, where the rear axle has to hold the car: there the stop
/// brakes less, and more again as the car gets slower.
TEST(StopPlanner, BrakesNoHarderThanTheBendLetsItStayStable) {
  const model::VehicleParams car = model::road_car_params();
  const StopPlanner planner(car);
  const auto braking = [&](double radius, double v) {
    const road::KnownRoad road = circle(radius);
    StopStart start = start_at(50.0, v);
    start.body.r = v / radius;
    double edge = 0.0;  // until it has settled in the bend
    for (int i = 0; i < 20; ++i) {
      model::Command command = planner.command(road, start, {.braking = {.share = 1.0, .stability = 1.6}});
      command.throttle = 0.0;
      start = planner.advance(road, start, command, 0.05, edge);
      start.body.vx = v;
    }
    return -planner.command(road, start, {.braking = {.share = 1.0, .stability = 1.6}}).throttle;
  };
  EXPECT_GT(braking(1e5, 33.0), 2.0 * braking(150.0, 33.0));
  EXPECT_GT(braking(150.0, 20.0), 2.0 * braking(150.0, 33.0));
  EXPECT_GT(braking(150.0, 33.0), 0.0);
}

/// `turns`: the yaw rate over that of the bend. One that turns faster slides with its rear axle.
TEST(StopPlanner, BrakesInBendsThatNoCarFollows) {
  const StopPlanner planner(kCars[1]);
  const auto braking = [&](double speed, double side, double turns = 0.0) {
    const StopStart start{.s = 20.0, .body = {.vx = speed, .r = side * turns * speed / 60.0}};
    return -planner.slowing(circle(60.0, side), start, {.share = 1.0, .stability = 0.0});
  };
  for (const double side : {1.0, -1.0}) {
    EXPECT_LT(braking(24.0, side), 3.0);  // the rear axle holds the car in the bend with all that it has
    EXPECT_GT(braking(32.0, side, 1.0), 5.0);
    EXPECT_LT(braking(32.0, side, 1.5), 3.0);
    EXPECT_EQ(braking(32.0, side), braking(32.0, -side));
  }
}

/// What the air brakes takes nothing of the tyres: a car of much drag brakes as hard beside it.
TEST(StopPlanner, CountsDragNotAsForceOfTheTyres) {
  model::VehicleParams light = kCars[1];
  model::VehicleParams draggy = light;
  draggy.height = light.height = 0.0;  // no load moves
  draggy.drag_quadratic = 6.0 / (30.0 * 30.0);
  const road::KnownRoad road = circle(100.0);
  StopStart start = start_at(50.0, 30.0);
  start.body.r = 0.2;
  const auto by_tyres = [&](const model::VehicleParams& car) {
    const double slowing = StopPlanner(car).slowing(road, start, {.share = 1.0, .stability = 0.0});
    return longitudinal_acceleration(car, 0.0, 30.0) - slowing;
  };
  EXPECT_GT(by_tyres(light), 1.0);
  EXPECT_NEAR(by_tyres(draggy), by_tyres(light), 0.5);
}

TEST(StopPlanner, AllocatesNothing) {
  const road::KnownRoad road = circle(60.0);
  const StopPlanner planner(kCars[1]);
  StopPlan stop;
  const test::AllocationGuard guard;
  static_cast<void>(planner.plan(road, start_at(20.0, 18.0), {.braking = {.share = 0.8}}, stop));
  static_cast<void>(planner.played(road, start_at(20.0, 18.0), stop, 2.0));
  EXPECT_EQ(guard.count(), 0);
}

/// No model says where a car goes that spins: it came 2 m off speedway where its stop was to keep 2 m.
TEST(StopPlanner, TakesASpinForNoStop) {
  const road::KnownRoad road = circle(1e5);
  const StopPlanner planner(model::road_car_params());
  StopPlan stop;
  StopStart spinning = start_at(100.0, 30.0);
  spinning.body.r = 2.5;
  const StopCheck check = planner.plan(road, spinning, {.braking = {.share = 1.0, .stability = 0.0}}, stop);
  EXPECT_FALSE(check.stands);
  EXPECT_GT(check.spins_at, 10.0);
  EXPECT_EQ(planner.plan(road, start_at(100.0, 30.0), {.braking = {.share = 1.0}}, stop).spins_at, 0.0);
}

/// Against the path of a car that turns back at full lock at walking pace.
TEST(StopPlanner, KnowsTheRoomThatTurningBackTakes) {
  for (const double side : {1.0, -1.0}) {
    for (const double radius : {1e5, 40.0}) {
      const road::KnownRoad road = circle(radius);
      for (const model::VehicleParams& car : kCars) {
        const StopPlanner planner(car);
        EXPECT_NEAR(planner.turning_room(road, start_at(50.0, 0.0)), 0.0, 0.05);
        for (const double e : {0.3, 0.6}) {
          StopStart at = start_at(50.0, 1.0, 0.0, side * e);
          at.body.steer = -side * car.steer_limit;
          const double room = planner.turning_room(road, at);
          const double before = planner.edge(road, at);
          double least = before;
          for (int i = 0; i < 400 && side * at.e > 0.0; ++i) {
            at = planner.advance(road, at, {-side * car.steer_limit, 0.1}, 0.05, least);
            at.body.vx = 1.0;
          }
          EXPECT_LT(before - least, 1.2 * room + 0.05) << car.name << ' ' << e << ' ' << side * radius;
          EXPECT_GT(before - least, room - 0.2) << car.name << ' ' << e << ' ' << side * radius;
        }
      }
    }
  }
}

}  // namespace
}  // namespace chicane::safety
