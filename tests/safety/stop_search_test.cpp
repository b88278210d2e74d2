// SPDX-License-Identifier: MIT
#include "chicane/safety/stop_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "chicane/base/angle.hpp"
#include "support/alloc_guard.hpp"

namespace chicane::safety {
namespace {

/// Straight on for half of its length, then half a circle of `radius` [m] that a clothoid of 20 m leads into;
/// 8 m wide. `side` 1 turns left.
road::KnownRoad bend_ahead(double radius, double side) {
  road::RoadData data;
  constexpr int kCount = 600;
  constexpr double kSpacing = 0.5;
  constexpr double kBegin = 100.0, kClothoid = 20.0;  // [m]
  data.length = kCount * kSpacing;
  data.is_closed = false;
  double x = 0.0, y = 0.0, heading = 0.0;
  for (int i = 0; i <= kCount; ++i) {
    const double s = i * kSpacing;
    const double share = std::min(std::max((s - kBegin) / kClothoid, 0.0), 1.0);
    data.points.push_back({.s = s,
                           .position = {x, y},
                           .heading = heading,
                           .curvature = side * share / radius,
                           .left = 4.0,
                           .right = 4.0});
    x += kSpacing * std::cos(heading);
    y += kSpacing * std::sin(heading);
    heading += kSpacing * side * share / radius;
  }
  return {data, model::road_car_params()};
}

StopStart start_at(double s, double speed) {
  return {.time = 2.0, .s = s, .d = 0.0, .e = 0.0, .body = {.vx = speed}};
}

const model::VehicleParams kCar = model::road_car_params();

/// The law brakes with what the place leaves, and sees the bend when it is there. The search brakes before.
TEST(StopSearch, BrakesBeforeTheBendWhereTheLawLeavesTheRoad) {
  const StopPlanner planner(kCar);
  for (const double side : {1.0, -1.0}) {
    const road::KnownRoad road = bend_ahead(40.0, side);
    const StopStart start = start_at(80.0, 31.0);
    StopSearch search(kCar);
    StopCourse stop;
    const StopCheck found = search.plan(road, start, 0.1, planner, stop);
    EXPECT_TRUE(found.stands) << side;
    EXPECT_GT(found.least_edge, 0.5) << side;
    for (const Braking& braking : {Braking{}, Braking{1.0, 1.6}}) {
      StopCourse by_law;
      const StopCheck law = planner.plan(road, start, braking, by_law);
      EXPECT_LT(law.least_edge, found.least_edge - 0.5) << side;
    }
  }
}

TEST(StopSearch, IsTheSameInAMirror) {
  const StopPlanner planner(kCar);
  StopCourse stops[2];
  StopCheck found[2];
  for (const int i : {0, 1}) {
    const double side = i == 0 ? 1.0 : -1.0;
    const road::KnownRoad road = bend_ahead(50.0, side);
    StopSearch search(kCar);
    StopStart start = start_at(90.0, 28.0);
    start.d = side * 0.5;
    start.e = side * 0.02;
    start.body.r = side * 0.05;
    found[i] = search.plan(road, start, 0.1, planner, stops[i]);
    ASSERT_TRUE(found[i].stands);
  }
  EXPECT_NEAR(found[0].distance, found[1].distance, 0.01);
  EXPECT_NEAR(found[0].least_edge, found[1].least_edge, 1e-3);
  ASSERT_EQ(stops[0].stop.size, stops[1].stop.size);
  for (int k = 0; k < stops[0].stop.size; ++k) {
    const auto i = static_cast<std::size_t>(k);
    EXPECT_NEAR(stops[0].stop.points[i].command.steer, -stops[1].stop.points[i].command.steer, 1e-3) << k;
    EXPECT_NEAR(stops[0].stop.points[i].command.throttle, stops[1].stop.points[i].command.throttle, 1e-3)
        << k;
  }
}

/// A receiver that plays what was found, in the model, comes to rest where the search says.
TEST(StopSearch, TellsWhatAReceiverDrives) {
  const road::KnownRoad road = bend_ahead(60.0, 1.0);
  const StopPlanner planner(kCar);
  StopSearch search(kCar);
  StopCourse stop;
  const StopStart start = start_at(85.0, 28.0);
  const StopCheck found = search.plan(road, start, 0.1, planner, stop);
  ASSERT_TRUE(found.stands);
  ASSERT_GT(stop.stop.size, 10);
  EXPECT_DOUBLE_EQ(stop.stop.points[0].time, start.time);
  for (int k = 1; k < stop.stop.size; ++k) {
    const auto i = static_cast<std::size_t>(k);
    EXPECT_GE(stop.stop.points[i].time, stop.stop.points[i - 1].time);
    EXPECT_GE(stop.stop.points[i].distance, stop.stop.points[i - 1].distance);
    EXPECT_LE(stop.stop.points[i].speed, stop.stop.points[i - 1].speed + 0.1);
    EXPECT_LE(std::fabs(stop.stop.points[i].command.steer), kCar.steer_limit);
    EXPECT_LE(stop.stop.points[i].command.throttle, 0.0);
  }
  EXPECT_NEAR(planner.played_edge(road, start, stop.stop, 0.5).edge_for, planner.edge(road, start), 0.3);
}

TEST(StopSearch, FindsNothingForACarThatIsSlowAndForgets) {
  const road::KnownRoad road = bend_ahead(60.0, 1.0);
  const StopPlanner planner(kCar);
  StopSearch search(kCar);
  StopCourse stop;
  EXPECT_FALSE(search.plan(road, start_at(10.0, 2.0), 0.1, planner, stop).stands);
  EXPECT_EQ(stop.stop.size, 0);
  const StopCheck first = search.plan(road, start_at(60.0, 25.0), 0.1, planner, stop);
  search.forget();
  const StopCheck again = search.plan(road, start_at(60.0, 25.0), 0.1, planner, stop);
  EXPECT_EQ(first.distance, again.distance);
  EXPECT_EQ(first.least_edge, again.least_edge);
}

TEST(StopSearch, AllocatesNothing) {
  const road::KnownRoad road = bend_ahead(60.0, 1.0);
  const StopPlanner planner(kCar);
  StopSearch search(kCar);
  StopCourse stop;
  const test::AllocationGuard guard;
  for (int i = 0; i < 3; ++i) {
    StopStart start = start_at(80.0 + i, 28.0);
    start.time += 0.04 * i;
    static_cast<void>(search.plan(road, start, 0.1, planner, stop));
  }
  EXPECT_EQ(guard.count(), 0);
}

}  // namespace
}  // namespace chicane::safety
