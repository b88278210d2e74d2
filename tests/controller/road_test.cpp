// SPDX-License-Identifier: MIT
#include "chicane/controller/road.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "chicane/base/angle.hpp"
#include "chicane/base/math.hpp"

namespace chicane::controller {
namespace {

/// Waypoints of a flattened circle, about 12 m apart.
std::vector<Vec2> stadium(int count = 60) {
  std::vector<Vec2> points;
  for (int i = 0; i < count; ++i) {
    const double angle = kTwoPi * i / count;
    points.emplace_back(150.0 * cos(angle), 80.0 * sin(angle));
  }
  return points;
}

model::Measurement seeing(const std::vector<Vec2>& points, int first, int count = 6) {
  model::Measurement now;
  now.waypoint_count = count;
  for (int i = 0; i < count; ++i) now.waypoints[i] = points[(first + i) % points.size()];
  return now;
}

TEST(WaypointMap, ClosesTheLoopWhenTheFirstWaypointComesBack) {
  const std::vector<Vec2> points = stadium();
  WaypointMap map;
  for (int i = 0; i < 54; ++i) {
    EXPECT_TRUE(map.add(seeing(points, i)) || i == 0) << i;
    EXPECT_FALSE(map.add(seeing(points, i))) << "nothing new the second time";
  }
  EXPECT_FALSE(map.is_closed());
  EXPECT_TRUE(map.add(seeing(points, 55)));
  EXPECT_TRUE(map.is_closed());
  ASSERT_EQ(map.points().size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(map.points()[i], points[i]);
}

TEST(WaypointMap, StartsAnewOnAnotherRoad) {
  WaypointMap map;
  const std::vector<Vec2> points = stadium();
  (void)map.add(seeing(points, 0));
  std::vector<Vec2> elsewhere = points;
  for (Vec2& p : elsewhere) p.x() += 1000.0;
  EXPECT_TRUE(map.add(seeing(elsewhere, 0)));
  EXPECT_EQ(map.points().size(), 6U);
  EXPECT_EQ(map.points().front().x(), 1150.0);
}

TEST(WaypointMap, IgnoresWaypointsThatAreNotNumbersAndKeepsWithinItsMemory) {
  WaypointMap map;
  model::Measurement now = seeing(stadium(), 0);
  now.waypoints[2].x() = std::nan("");
  EXPECT_TRUE(map.add(now));
  EXPECT_EQ(map.points().size(), 5U);
  for (int i = 0; i < 3 * WaypointMap::kCapacity; ++i) {
    model::Measurement on;
    on.waypoint_count = 2;
    on.waypoints[0] = {10.0 * i, 1e4};
    on.waypoints[1] = {10.0 * (i + 1), 1e4};
    (void)map.add(on);
  }
  EXPECT_LE(map.points().size(), static_cast<std::size_t>(WaypointMap::kCapacity));
}

TEST(SpeedPlan, KeepsTheTyresWithinTheirShare) {
  Road road({.smoothing_width = 0.0, .speed = {.grip_share = 0.7}}, model::road_car_params());
  const std::vector<Vec2> points = stadium();
  for (int i = 0; i < 60; ++i) road.add(seeing(points, i));
  ASSERT_TRUE(road.is_closed());
  const model::VehicleParams car = model::road_car_params();
  for (double s = 0.0; s < road.line().length(); s += 5.0) {
    const double v = road.speed(s).speed;
    // 3 %: samples lie 1.5 m apart.
    EXPECT_LE(v * v * std::fabs(road.line().at(s).curvature), 1.03 * 0.7 * car.friction * car.load_constant)
        << s;
    EXPECT_GE(v, 2.0);
  }
}

TEST(SpeedPlan, NeverAsksForMoreThanDriveAndBrakesGive) {
  const model::VehicleParams car = model::road_car_params();
  Road road({.speed = {.brake_share = 0.5}}, car);
  const std::vector<Vec2> points = stadium();
  for (int i = 0; i < 60; ++i) road.add(seeing(points, i));
  for (double s = 0.0; s < road.line().length(); s += 2.0) {
    const SpeedPlan::Sample sample = road.speed(s);
    const double a = sample.speed * sample.slope;
    // 0.15 m/s²: interpolation between samples.
    EXPECT_LE(a, longitudinal_acceleration(car, 1.0, sample.speed) + 0.15) << s;
    EXPECT_GE(a, longitudinal_acceleration(car, -1.0, sample.speed) - 0.15) << s;
  }
}

TEST(Road, SmoothsWithinItsWidthAndBendsLess) {
  std::vector<Vec2> points = stadium();
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] *= 1.0 + (i % 2 == 0 ? 0.002 : -0.002);  // ±0.3 m zigzag
  const auto bending = [&](double width) {
    Road road({.half_width = 3.0, .smoothing_width = width}, model::udacity_params());
    for (int i = 0; i < 60; ++i) road.add(seeing(points, i));
    double sum = 0.0;
    for (double s = 0.0; s < road.line().length(); s += 1.0) {
      const double curvature = road.line().at(s).curvature;
      sum += curvature * curvature;
      const Road::Room room = road.room(s);
      EXPECT_NEAR(room.left + room.right, 6.0, 1e-9);
      EXPECT_GE(std::min(room.left, room.right), 3.0 - 1.3 * width)
          << "the price keeps it within about the width";
    }
    return sum;
  };
  EXPECT_LT(bending(1.0), 0.7 * bending(0.0));
}

TEST(Road, IsTheSameWhereverItsMapBegins) {
  const std::vector<Vec2> points = stadium();
  double shortest = 1e9, longest = 0.0;
  for (int begin : {0, 7, 23, 41}) {
    Road road({}, model::udacity_params());
    for (int i = 0; i < 60; ++i) road.add(seeing(points, begin + i));
    double time = 0.0;
    for (double s = 0.0; s < road.line().length(); s += 1.0) time += 1.0 / road.speed(s).speed;
    shortest = std::min(shortest, time);
    longest = std::max(longest, time);
  }
  EXPECT_LT(longest, 1.02 * shortest);
}

}  // namespace
}  // namespace chicane::controller
