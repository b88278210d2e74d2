// SPDX-License-Identifier: MIT
#include "chicane/safety/predictive_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "chicane/base/math.hpp"
#include "chicane/road/racing_road.hpp"
#include "support/alloc_guard.hpp"

namespace chicane::safety {
namespace {

/// A circle of 100 m radius, 10 m wide; `side` 1 turns left.
road::KnownRoad round_road(double side) {
  road::RoadData data;
  constexpr double kRadius = 100.0;
  data.length = kTwoPi * kRadius;
  constexpr int kCount = 400;
  for (int i = 0; i <= kCount; ++i) {
    const double angle = kTwoPi * i / kCount;
    data.points.push_back({.s = data.length * i / kCount,
                           .position = {kRadius * std::sin(angle), side * kRadius * (1.0 - std::cos(angle))},
                           .heading = side * angle,
                           .curvature = side / kRadius,
                           .left = 5.0,
                           .right = 5.0});
  }
  return {data, model::udacity_params()};
}

/// A car that drives along the middle of it.
StopStart driving(double speed, double side) {
  StopStart at{.time = 2.0, .s = 50.0, .body = {.vx = speed}};
  at.body.r = side * speed / 100.0;
  at.body.steer = side * 0.03;
  return at;
}

const model::VehicleParams kBoth[] = {model::udacity_params(), model::road_car_params()};

TEST(PredictiveFilter, StoresABackupAfterACommandThatLeavesOne) {
  for (const double side : {1.0, -1.0}) {
    const road::KnownRoad road = round_road(side);
    for (const model::VehicleParams& car : kBoth) {
      PredictiveFilter filter(car, {});
      GuardReport report;
      const StopStart start = driving(15.0, side);
      const Fit fit = filter.verify({road, start, {side * 0.03, 0.1}, 0.04}, report);
      EXPECT_EQ(fit, Fit::kOpen) << car.name;
      ASSERT_GT(filter.stop().size, 5);
      EXPECT_NEAR(filter.stop().points[0].time, start.time + 0.10, 1e-9)
          << "a late next command is waited for";
      EXPECT_GT(report.stop_edge, 0.2);
      EXPECT_GT(report.stop_distance, 5.0);
    }
  }
}

TEST(PredictiveFilter, IsTheSameInAMirror) {
  for (const model::VehicleParams& car : kBoth) {
    double edges[2], distances[2], steers[2];
    for (const int i : {0, 1}) {
      const double side = i == 0 ? 1.0 : -1.0;
      const road::KnownRoad road = round_road(side);
      PredictiveFilter filter(car, {});
      GuardReport report;
      StopStart start = driving(20.0, side);
      start.d = side * 0.7;
      static_cast<void>(filter.verify({road, start, {side * 0.04, 0.3}, 0.04}, report));
      edges[i] = report.stop_edge;
      distances[i] = report.stop_distance;
      steers[i] = side * filter.stop().points[2].command.steer;
    }
    EXPECT_NEAR(edges[0], edges[1], 1e-9) << car.name;
    EXPECT_NEAR(distances[0], distances[1], 1e-9) << car.name;
    EXPECT_NEAR(steers[0], steers[1], 1e-9) << car.name;
  }
}

/// The invariant: whatever is asked, refused commands leave a backup that brings the car to rest on the road.
TEST(PredictiveFilter, BringsARefusedCarToRestOnTheRoad) {
  for (const double side : {1.0, -1.0}) {
    const road::KnownRoad road = round_road(side);
    for (const model::VehicleParams& car : kBoth) {
      PredictiveFilter filter(car, {});
      StopStart at = driving(18.0, side);
      double edge = 5.0;
      int refused = 0;
      for (int i = 0; i < 600 && at.body.vx > 0.5; ++i) {
        GuardReport report;
        model::Command command{-side * car.steer_limit, 1.0};  // out of the bend
        if (filter.verify({road, at, command, 0.04}, report) != Fit::kOpen) {
          ++refused;
          ASSERT_TRUE(filter.drive(road, at, false, false, report)) << car.name;
          command = filter.stop().points[0].command;
        }
        at = filter.planner().advance(road, at, command, 0.04, edge);
      }
      EXPECT_GT(refused, 5) << car.name;
      EXPECT_GT(edge, 0.0) << car.name;
    }
  }
}

TEST(PredictiveFilter, RefusesACommandThatMakesTheCarSlide) {
  const road::KnownRoad road = round_road(1.0);
  model::VehicleParams car = model::road_car_params();
  car.steer_rate_limit = 100.0;
  PredictiveFilter filter(car, {.margin = 0.0, .open_time = 0.0});
  GuardReport report;
  const StopStart start = driving(30.0, 1.0);
  EXPECT_EQ(filter.verify({road, start, {car.steer_limit, 0.0}, 0.3}, report), Fit::kNone);
  EXPECT_EQ(filter.stop().size, 0);
}

/// A car within the margin is led back along the road or away from its edge, not nearer to it.
TEST(PredictiveFilter, LeadsACarNearTheEdgeNoNearer) {
  const road::KnownRoad road = round_road(1.0);
  const model::VehicleParams car = model::road_car_params();
  const double half = 0.5 * (car.track_width + car.tire_width);
  PredictiveFilter filter(car, {.margin = 0.5});
  GuardReport report;
  StopStart start{.time = 2.0, .s = 50.0, .d = 5.0 - half - 0.2, .body = {.vx = 1.0}};
  EXPECT_EQ(filter.verify({road, start, {0.3, 0.3}, 0.1, true}, report), Fit::kNone) << "towards the edge";
  start.e = -0.1;
  EXPECT_EQ(filter.verify({road, start, {-0.2, 0.0}, 0.1, true}, report), Fit::kOpen) << "away from it";
  EXPECT_EQ(filter.verify({road, start, {-0.2, 0.0}, 0.1}, report), Fit::kNone) << "unled";
}

TEST(PredictiveFilter, GoesOnWithTheBackupByTimeWhereNothingIsMeasured) {
  const road::KnownRoad road = round_road(1.0);
  PredictiveFilter filter(model::road_car_params(), {});
  GuardReport report;
  const StopStart start = driving(20.0, 1.0);
  ASSERT_EQ(filter.verify({road, start, {0.03, 0.1}, 0.04}, report), Fit::kOpen);
  const StopPlan before = filter.stop();
  StopStart later = start;
  later.time = before.points[3].time + 0.01;
  later.d = 3.0;  // what an estimate without measurements says does not count
  ASSERT_TRUE(filter.drive(road, later, true, false, report));
  EXPECT_EQ(filter.stop().points[0].command.steer, before.points[3].command.steer);
  EXPECT_EQ(filter.stop().points[0].command.throttle, before.points[3].command.throttle);
  EXPECT_EQ(filter.stop().size, before.size - 3);
}

/// The same circle by a line that is `outside` [m] of its middle.
road::KnownRoad round_road_by_another_line(double outside = 2.0) {
  std::vector<road::LinePoint> lap;
  const double radius = 100.0 + outside;
  for (int i = 0; i <= 400; ++i) {
    const double angle = kTwoPi * (i / 400.0 - 0.3);  // and begins elsewhere
    road::LinePoint point;
    point.position = {radius * std::sin(angle), 100.0 - radius * std::cos(angle)};
    point.heading = angle;
    point.curvature = 1.0 / radius;
    point.speed = 25.0;
    point.left = 5.0 + outside;
    point.right = 5.0 - outside;
    lap.push_back(point);
  }
  const road::RacingRoad planned(lap);
  road::KnownRoad road = round_road(1.0);
  road.use_line(&planned);
  return road;
}

TEST(PredictiveFilter, DrivesTheStoredPolicyAlongAnotherLineOfTheRoad) {
  const road::KnownRoad road = round_road(1.0);
  const road::KnownRoad other = round_road_by_another_line();
  PredictiveFilter filter(model::road_car_params(), {.open_time = 0.0});
  GuardReport report;
  ASSERT_NE(filter.verify({road, driving(20.0, 1.0), {0.03, 0.1}, 0.04}, report), Fit::kNone);
  const StopPlan before = filter.stop();
  const double edge = report.stop_edge;
  ASSERT_EQ(filter.stop().size, before.size);
  StopStart car = driving(20.0, 1.0);
  car.s = other.line().project({100.0 * std::sin(0.5), 100.0 - 100.0 * std::cos(0.5)}).s + 2.0;
  car.d = 2.0;
  car.time = before.points[0].time;
  ASSERT_TRUE(filter.drive(other, car, false, false, report)) << "where the car was going to be";
  EXPECT_LT(report.stop_edge, edge) << "it leads to the line that is raced, 2 m beside the middle";
  EXPECT_GT(report.stop_edge, 2.5);
  for (const int i : {0, 5, 10}) {
    const auto k = static_cast<std::size_t>(i);
    EXPECT_NEAR(filter.stop().points[k].command.throttle, before.points[k].command.throttle, 0.1) << i;
  }
}

/// A car that races may cross its lap's line for a moment; one that is led stops on the road.
TEST(PredictiveFilter, LeadsACarAcrossALapAsOnAnyRoad) {
  const road::KnownRoad raced = round_road_by_another_line(3.6);
  int led = 0, unled = 0;
  for (double course = -0.05; course > -0.5; course -= 0.05) {
    PredictiveFilter filter(model::road_car_params(), {.margin = 0.05, .open_time = 0.0});
    GuardReport report;
    const StopStart start{.time = 2.0, .s = 50.0, .e = course, .body = {.vx = 4.0}};
    const model::Command command{-0.1, 0.0};
    led += filter.verify({raced, start, command, 0.1, true}, report) != Fit::kNone ? 1 : 0;
    unled += filter.verify({raced, start, command, 0.1}, report) != Fit::kNone ? 1 : 0;
  }
  EXPECT_GT(led, 0) << "one that is nearly along the road";
  EXPECT_GT(unled, led);
}

/// A stop that ends across the road beside its edge leaves no way on but over the edge.
TEST(PredictiveFilter, KeepsTheRoomToTurnBackAlongTheRoad) {
  const road::KnownRoad road = round_road(1.0);
  const model::VehicleParams car = model::road_car_params();
  PredictiveFilter filter(car, {});
  GuardReport report;
  StopStart start{.time = 2.0, .s = 50.0, .d = 2.8, .e = 0.7, .body = {.vx = 1.0}};
  EXPECT_EQ(filter.verify({road, start, {0.43, 0.0}, 0.04}, report), Fit::kNone);
  EXPECT_GT(filter.planner().edge(road, start), 0.5) << "though it stands on the road";
  start.d = 0.0;
  EXPECT_NE(filter.verify({road, start, {0.43, 0.0}, 0.04}, report), Fit::kNone);
  start.d = 2.8;
  start.e = 0.2;
  EXPECT_NE(filter.verify({road, start, {-0.43, 0.0}, 0.04}, report), Fit::kNone) << "along it";
}

/// A new run may begin at an earlier time than a refusal of the last one: nobody waits for that time.
TEST(PredictiveFilter, ForgetsWhenItRefused) {
  const road::KnownRoad road = round_road(1.0);
  PredictiveFilter filter(model::udacity_params(), {});
  GuardReport report;
  const StopStart fast = driving(25.0, 1.0);
  const auto answer = [&](double time) {
    StopStart start = fast;
    start.time = time;
    start.d = -2.0;
    start.e = -0.2;  // stopped by the laws with more feedback only
    return filter.verify({road, start, {0.03, 0.1}, 0.04}, report);
  };
  const Fit first = answer(1.0);
  ASSERT_NE(first, Fit::kNone);
  StopStart refused = fast;
  refused.time = 900.0;
  ASSERT_TRUE(filter.drive(road, refused, false, false, report));
  EXPECT_EQ(answer(900.1), Fit::kNone) << "right after a refusal only a calm car is given back";
  EXPECT_EQ(answer(900.7), first);
  ASSERT_TRUE(filter.drive(road, refused, false, false, report));
  filter.forget();
  EXPECT_EQ(answer(1.0), first);
}

/// docs/guard.md, eq. 5d: a stop that comes nearer to the edge than it was verified for asks for that room.
TEST(PredictiveFilter, AsksForTheRoomThatADrivenStopHasLost) {
  for (const double side : {1.0, -1.0}) {
    const road::KnownRoad road = round_road(side);
    const auto fit_after = [&](double pushed, bool is_measured, bool forgets) {
      PredictiveFilter filter(model::udacity_params(), {});
      GuardReport report;
      StopStart at = driving(20.0, side);
      for (int i = 0; i < 5; ++i) {  // pushed outwards while its stop is driven
        EXPECT_TRUE(filter.drive(road, at, false, is_measured, report));
        at.time += 0.04;
        at.d -= 0.2 * side * pushed;
      }
      if (forgets) filter.forget();
      StopStart outwards = driving(20.0, side);  // its stop comes nearer to the edge than it is
      outwards.time = at.time + 2.0;
      outwards.d = -3.0 * side;
      outwards.e = -0.06 * side;
      const Fit fit = filter.verify({road, outwards, {side * 0.03, 0.0}, 0.04}, report);
      if (fit != Fit::kNone) {
        EXPECT_GT(report.stop_edge, 0.2);
        EXPECT_LT(report.stop_edge, 0.6);
      }
      return fit;
    };
    EXPECT_NE(fit_after(0.0, true, false), Fit::kNone);
    EXPECT_EQ(fit_after(1.0, true, false), Fit::kNone);
    EXPECT_NE(fit_after(1.0, false, false), Fit::kNone) << "a doubted measurement says nothing of the model";
    EXPECT_NE(fit_after(1.0, true, true), Fit::kNone) << "another run";
  }
}

TEST(PredictiveFilter, AllocatesNothing) {
  const road::KnownRoad road = round_road(1.0);
  PredictiveFilter filter(model::road_car_params(), {});
  const test::AllocationGuard counter;
  StopStart at = driving(25.0, 1.0);
  for (int i = 0; i < 20; ++i) {
    GuardReport report;
    static_cast<void>(filter.verify({road, at, {i % 2 == 0 ? 0.4 : -0.4, 1.0}, 0.04}, report));
    static_cast<void>(filter.drive(road, at, i % 3 == 0, false, report));
    at.time += 0.04;
  }
  EXPECT_EQ(counter.count(), 0);
}

}  // namespace
}  // namespace chicane::safety
