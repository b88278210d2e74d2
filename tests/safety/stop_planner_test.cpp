// SPDX-License-Identifier: MIT
#include "chicane/safety/stop_planner.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "chicane/base/angle.hpp"
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
    StopCourse stop;
    for (const double speed : {10.0, 20.0, 30.0}) {
      const StopCheck check = planner.plan(road, start_at(100.0, speed), {.share = 1.0}, stop);
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
  StopCourse stop;
  const StopCheck check = planner.plan(road, start_at(10.0, 25.0), {.share = 0.8}, stop);
  ASSERT_TRUE(check.stands);
  ASSERT_GT(stop.stop.size, 10);
  EXPECT_EQ(stop.stop.points[0].time, 2.0);
  for (int i = 1; i < stop.stop.size; ++i) {
    const auto k = static_cast<std::size_t>(i);
    EXPECT_GT(stop.stop.points[k].time, stop.stop.points[k - 1].time);
    EXPECT_GE(stop.stop.points[k].distance, stop.stop.points[k - 1].distance);
    EXPECT_LE(stop.stop.points[k].command.throttle, 0.0);
    EXPECT_LE(std::fabs(stop.stop.points[k].command.steer), kCars[0].steer_limit);
  }
  EXPECT_NEAR(stop.stop.points[static_cast<std::size_t>(stop.stop.size - 1)].distance, check.distance, 1.0);
}

TEST(StopPlanner, IsTheSameInAMirror) {
  const road::KnownRoad left = circle(60.0);
  const road::KnownRoad right = circle(60.0, -1.0);
  for (const model::VehicleParams& car : kCars) {
    const StopPlanner planner(car);
    StopCourse one;
    StopCourse other;
    const StopCheck a = planner.plan(left, start_at(20.0, 18.0, 1.0, -0.05), {.share = 0.8}, one);
    const StopCheck b = planner.plan(right, start_at(20.0, 18.0, -1.0, 0.05), {.share = 0.8}, other);
    EXPECT_NEAR(a.least_edge, b.least_edge, 1e-9);
    EXPECT_NEAR(a.distance, b.distance, 1e-9);
    ASSERT_EQ(one.stop.size, other.stop.size);
    for (int i = 0; i < one.stop.size; ++i) {
      const auto k = static_cast<std::size_t>(i);
      EXPECT_NEAR(one.stop.points[k].command.steer, -other.stop.points[k].command.steer, 1e-9) << i;
      EXPECT_NEAR(one.stop.points[k].command.throttle, other.stop.points[k].command.throttle, 1e-9);
    }
  }
}

TEST(StopPlanner, SaysWhenTheCarIsTooFastForTheBend) {
  const road::KnownRoad road = circle(40.0);
  const StopPlanner planner(model::road_car_params());
  StopCourse stop;
  EXPECT_GT(planner.plan(road, start_at(10.0, 12.0), {.share = 0.8}, stop).least_edge, 1.0);
  const StopCheck fast = planner.plan(road, start_at(10.0, 35.0), {.share = 1.0}, stop);  // 3.1 g
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
        at = planner.advance(road, at, planner.law(road, at, {.share = 0.6}), 0.05, edge);
      EXPECT_LT(std::fabs(at.d), 1.6) << car.name;
    }
  }
}

TEST(StopPlanner, MeasuresTheEdgeAtTheOutermostTyre) {
  const road::KnownRoad road = circle(1e5);
  const model::VehicleParams car = model::udacity_params();
  const StopPlanner planner(car);
  const double half = 0.5 * (car.track_width + car.tire_width);
  EXPECT_NEAR(planner.edge(road, start_at(100.0, 0.0, 1.0)), 5.0 - 1.0 - half, 1e-9);
  EXPECT_NEAR(planner.edge(road, start_at(100.0, 0.0, -2.0)), 5.0 - 2.0 - half, 1e-9);
  const double e = 0.3;
  EXPECT_NEAR(planner.edge(road, start_at(100.0, 0.0, 0.0, e)),
              5.0 - car.rear_axle * std::sin(e) - half * std::cos(e), 1e-9)
      << "the rear axle is further from the centre of mass";
}

TEST(StopPlanner, NeedsTheRoadAsFarAsItStops) {
  road::RoadData data;
  data.length = 60.0;
  for (int i = 0; i <= 30; ++i)
    data.points.push_back({.s = 2.0 * i, .position = {2.0 * i, 0.0}, .left = 5.0, .right = 5.0});
  const road::KnownRoad road(data, kCars[0]);
  const StopPlanner planner(kCars[0]);
  StopCourse stop;
  EXPECT_TRUE(planner.plan(road, start_at(5.0, 20.0), {.share = 1.0}, stop).stands);
  EXPECT_FALSE(planner.plan(road, start_at(5.0, 40.0), {.share = 1.0}, stop).stands);
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
      StopCourse stop;
      StopStart start = start_at(20.0, 24.0);
      start.body.r = side * 24.0 / 120.0;
      const StopCheck check = planner.plan(road, start, {.share = 0.8}, stop);
      ASSERT_TRUE(check.stands);
      double before = planner.played_edge(road, start, stop.stop, 0.25).edge_for;
      EXPECT_LT(before, check.least_edge + 0.5);
      EXPECT_GT(before, check.least_edge - 0.5);
      for (const double time : {0.5, 1.0, 2.0, 60.0}) {
        const BlindCheck blind = planner.played_edge(road, start, stop.stop, time);
        const double edge = blind.edge_for;
        EXPECT_LE(blind.edge, edge);
        EXPECT_EQ(blind.speed, 0.0);
        EXPECT_LE(edge, before) << car.name << time;
        before = edge;
      }
      EXPECT_LT(before, check.least_edge - 0.1) << car.name << " strays by some decimetres";
      EXPECT_GT(before, check.least_edge - 3.0) << car.name;
    }
  }
}

/// A blind driver who leaves the road does so at a speed, and later than in the time asked for.
TEST(StopPlanner, KnowsHowFastABlindDriverLeavesTheRoad) {
  const road::KnownRoad road = circle(120.0);
  const StopPlanner planner(kCars[1]);
  StopCourse stop;
  const StopStart start = start_at(20.0, 24.0);
  static_cast<void>(planner.plan(road, start, {.share = 0.5}, stop));
  for (int i = 0; i < stop.stop.size; ++i) stop.stop.points[static_cast<std::size_t>(i)].command.steer = 0.0;
  const BlindCheck blind = planner.played_edge(road, start, stop.stop, 0.5);
  EXPECT_GT(blind.edge_for, 0.0);
  EXPECT_LT(blind.edge, 0.0);
  EXPECT_GT(blind.speed, 8.0);
  EXPECT_LT(blind.speed, 24.0);
  EXPECT_LT(planner.played_edge(road, start, stop.stop, 10.0).edge_for, 0.0);
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
      model::Command command = planner.law(road, start, {.share = 1.0, .stability = 1.6});
      command.throttle = 0.0;
      start = planner.advance(road, start, command, 0.05, edge);
      start.body.vx = v;
    }
    return -planner.law(road, start, {.share = 1.0, .stability = 1.6}).throttle;
  };
  EXPECT_GT(braking(1e5, 33.0), 2.0 * braking(150.0, 33.0));
  EXPECT_GT(braking(150.0, 20.0), 2.0 * braking(150.0, 33.0));
  EXPECT_GT(braking(150.0, 33.0), 0.0);
}

/// Who is where a stop says drives it; who is beside it comes back to it, and not to the middle of the road.
TEST(StopPlanner, FollowsAStopFromItsPlacesAndFromBesideThem) {
  for (const double side : {1.0, -1.0}) {
    const road::KnownRoad road = circle(120.0, side);
    for (const model::VehicleParams& car : kCars) {
      const StopPlanner planner(car);
      StopCourse stop;
      StopStart start = start_at(300.0, 24.0, side * 1.5);
      start.body.r = side * 24.0 / 120.0;
      const StopCheck planned = planner.plan(road, start, {.share = 0.6}, stop);
      ASSERT_TRUE(planned.stands);
      StopCourse same;
      const StopCheck followed = planner.follow(road, start, stop, same);
      EXPECT_TRUE(followed.stands);
      EXPECT_NEAR(followed.distance, planned.distance, 1.0) << car.name;
      EXPECT_NEAR(followed.least_edge, planned.least_edge, 0.1) << car.name;
      // A second later, and half a metre beside.
      StopStart later = stop.places[10];
      later.d += 0.5;
      StopCourse back;
      EXPECT_TRUE(planner.follow(road, later, stop, back).stands);
      const auto at_end = static_cast<std::size_t>(back.stop.size - 1);
      const double strayed =
          back.places[at_end].d - stop.places[static_cast<std::size_t>(stop.stop.size - 1)].d;
      EXPECT_LT(std::fabs(strayed), 0.35) << car.name;
    }
  }
}

/// Each of these stops begins with the first command of the one before: with the wheel held until the next
/// place, which none of them reaches, it stood still, and `road-car` came 6 m from where it was to stop.
TEST(StopPlanner, TurnsTheWheelOnWhereAStopIsFollowedAnewInEachCycle) {
  for (const double side : {1.0, -1.0}) {
    const road::KnownRoad road = circle(150.0, side);
    for (const model::VehicleParams& car : kCars) {
      const StopPlanner planner(car);
      StopStart at = start_at(20.0, 22.0, 1.5 * side, -0.03 * side);
      StopCourse stop, next;
      ASSERT_TRUE(planner.plan(road, at, {.share = 0.4}, stop).stands);
      const StopStart planned = stop.places[static_cast<std::size_t>(stop.stop.size - 1)];
      double edge = 5.0;
      while (at.body.vx > 2.0) {
        static_cast<void>(planner.follow(road, at, stop, next));
        at = planner.advance(road, at, next.stop.points[0].command, 0.04, edge);
        std::swap(stop, next);
        ASSERT_LT(at.time, 20.0) << car.name;
      }
      EXPECT_NEAR(at.d, planned.d, 0.5) << car.name << ' ' << side;
    }
  }
}

/// A driver who sees loses less of the road than one who plays blindly.
TEST(StopPlanner, KnowsThatADriverWhoSeesStraysLess) {
  const road::KnownRoad road = circle(120.0);
  for (const model::VehicleParams& car : kCars) {
    const StopPlanner planner(car);
    StopCourse stop;
    StopStart start = start_at(20.0, 24.0);
    start.body.r = 24.0 / 120.0;
    const StopCheck check = planner.plan(road, start, {.share = 0.8}, stop);
    ASSERT_TRUE(check.stands);
    const double seen = planner.followed_edge(road, start, stop);
    EXPECT_GT(seen, planner.played_edge(road, start, stop.stop, 60.0).edge_for) << car.name;
    EXPECT_GT(seen, check.least_edge - 1.0) << car.name;
    EXPECT_LT(seen, check.least_edge + 0.5) << car.name;
  }
}

/// The stop that begins later drives on as the controller plans, with its drive.
TEST(StopPlanner, BeginsAStopLaterAsTheControllerIntends) {
  const road::KnownRoad road = circle(1e5);
  const StopPlanner planner(kCars[1]);
  controller::Plan intended;
  const StopStart start = start_at(100.0, 25.0);
  const double drive = throttle_for(kCars[1], 0.0, 25.0);
  for (int i = 0; i < 40; ++i)
    intended.points[static_cast<std::size_t>(intended.size++)] = {
        .time = start.time + 0.05 * i, .x = 100.0 + 1.25 * i, .speed = 25.0, .command = {.throttle = drive}};
  StopCourse course, at_once, later;
  planner.course_of(road, start, intended, StopPlanner::kLongestDriveOn, course);
  ASSERT_GT(course.stop.size, 15);
  const StopCheck now = planner.plan(road, start, {.share = 1.0}, at_once);
  const StopCheck then = planner.plan_later(road, start, course, 1.0, {.share = 1.0}, later);
  EXPECT_TRUE(then.stands);
  EXPECT_GT(later.stop.points[3].command.throttle, 0.5 * drive);
  EXPECT_LT(later.stop.points[12].command.throttle, 0.0);
  EXPECT_NEAR(then.distance - now.distance, 25.0, 3.0) << "a second at 25 m/s";
}

/// A plan that is no motion gives no course.
TEST(StopPlanner, TakesNoCourseFromAPlanThatIsNone) {
  const road::KnownRoad road = circle(1e5);
  const StopPlanner planner(kCars[1]);
  StopCourse course;
  controller::Plan plan;
  plan.size = 3;
  for (int i = 0; i < 3; ++i)
    plan.points[static_cast<std::size_t>(i)] = {
        .time = 2.0 + 0.05 * i, .x = 1e6 * i, .speed = 25.0, .command = {}};
  planner.course_of(road, start_at(100.0, 25.0), plan, StopPlanner::kLongestDriveOn, course);
  EXPECT_EQ(course.stop.size, 0);
  plan.points[1].x = std::numeric_limits<double>::quiet_NaN();
  planner.course_of(road, start_at(100.0, 25.0), plan, StopPlanner::kLongestDriveOn, course);
  EXPECT_EQ(course.stop.size, 0);
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
  StopCourse stop;
  const test::AllocationGuard guard;
  static_cast<void>(planner.plan(road, start_at(20.0, 18.0), {.share = 0.8}, stop));
  static_cast<void>(planner.played_edge(road, start_at(20.0, 18.0), stop.stop, 2.0));
  EXPECT_EQ(guard.count(), 0);
}

/// No model says where a car goes that spins: it came 2 m off speedway where its stop was to keep 2 m.
TEST(StopPlanner, TakesASpinForNoStop) {
  const road::KnownRoad road = circle(1e5);
  const StopPlanner planner(model::road_car_params());
  StopCourse stop;
  StopStart spinning = start_at(100.0, 30.0);
  spinning.body.r = 2.5;
  const StopCheck check = planner.plan(road, spinning, {.share = 1.0, .stability = 0.0}, stop);
  double most = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(stop.stop.size); ++i)
    most = std::max(most, std::fabs(std::atan2(stop.places[i].body.vy, stop.places[i].body.vx)));
  EXPECT_GT(most, 0.35);
  EXPECT_FALSE(check.stands);
  EXPECT_GT(check.spins_at, 10.0);
  EXPECT_EQ(planner.plan(road, start_at(100.0, 30.0), {.share = 1.0}, stop).spins_at, 0.0);
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
            at.body.vy = car.rear_axle * at.body.r;
            at.body.r = -side * std::tan(car.steer_limit) / car.wheelbase();
          }
          EXPECT_NEAR(before - least, room, 0.1 + 0.2 * room) << car.name << ' ' << e << ' ' << side * radius;
        }
      }
    }
  }
}

}  // namespace
}  // namespace chicane::safety
