// SPDX-License-Identifier: MIT
#include "chicane/road/road.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "chicane/base/angle.hpp"
#include "chicane/base/math.hpp"

namespace chicane::road {
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

/// Drives round until the lap is planned. Returns how many measurements that took after the loop was closed.
int learn(Road& road, const std::vector<Vec2>& points, int begin = 0) {
  const int count = static_cast<int>(points.size());
  for (int i = 0; i < count; ++i) road.add(seeing(points, begin + i));
  int more = 0;
  for (; !road.line().is_closed() && more < 1000; ++more) road.add(seeing(points, begin + more / 8));
  EXPECT_TRUE(road.line().is_closed());
  return more;
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

/// The line's own figures agree with each other: tangent, heading and curvature are those of its positions.
void expect_a_curve(const ReferenceLine& line) {
  constexpr double kStep = 0.5;  // [m]
  for (double s = 2.0; s < line.length() - 2.0; s += 0.7) {
    const CurvePoint at = line.at(s);
    const Vec2 before = line.at(s - kStep).position;
    const Vec2 after = line.at(s + kStep).position;
    EXPECT_NEAR((after - before).norm(), 2.0 * kStep, 2e-3) << s;
    EXPECT_NEAR(angle_difference(atan2(at.tangent.y(), at.tangent.x()), at.heading), 0.0, 2e-3) << s;
    const Vec2 bend = (after - 2.0 * at.position + before) / (kStep * kStep);
    const double curvature = at.tangent.x() * bend.y() - at.tangent.y() * bend.x();
    EXPECT_NEAR(curvature, at.curvature, 4e-3) << s;  // a cubic between samples against a line through them
  }
}

TEST(ReferenceLine, IsOneCurveInPositionHeadingAndCurvature) {
  Road road({.smoothing_width = 1.0}, model::udacity_params());
  const std::vector<Vec2> points = stadium();
  for (int i = 0; i < 20; ++i) road.add(seeing(points, i));
  ASSERT_FALSE(road.line().is_empty());
  expect_a_curve(road.line());
  learn(road, points, 20);
  expect_a_curve(road.line());
}

TEST(ReferenceLine, ProjectsOntoTheNearestPlace) {
  Road road({}, model::udacity_params());
  learn(road, stadium());
  const ReferenceLine& line = road.line();
  for (double s = 0.0; s < line.length(); s += 3.3) {
    for (const double d : {-3.0, 0.0, 2.0}) {
      const CurvePoint at = line.at(s);
      const Vec2 point = at.position + d * Vec2{-at.tangent.y(), at.tangent.x()};
      const auto near = line.project(point, s + 10.0, 30.0);
      EXPECT_NEAR(std::remainder(near.s - s, line.length()), 0.0,
                  1e-4);  // the foot of a cubic between samples
      EXPECT_NEAR(near.d, d, 1e-6);
      EXPECT_NEAR(near.distance, std::fabs(d), 1e-6);
      EXPECT_NEAR(std::remainder(line.project(point).s - near.s, line.length()), 0.0, 1e-9);
    }
  }
}

TEST(Road, SmoothsWithinItsWidthAndBendsLess) {
  std::vector<Vec2> points = stadium();
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] *= 1.0 + (i % 2 == 0 ? 0.002 : -0.002);  // ±0.3 m zigzag
  const auto bending = [&](double width) {
    Road road({.half_width = 3.0, .smoothing_width = width}, model::udacity_params());
    learn(road, points);
    double sum = 0.0;
    for (double s = 0.0; s < road.line().length(); s += 1.0) {
      const ReferenceLine::Demand at = road.line().demand(s);
      sum += at.curvature * at.curvature;
      const Road::Room room = road.room(at.offset);
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
    learn(road, points, begin);
    double time = 0.0;
    for (double s = 0.0; s < road.line().length(); s += 1.0) time += 1.0 / road.line().demand(s).speed;
    shortest = std::min(shortest, time);
    longest = std::max(longest, time);
  }
  EXPECT_LT(longest, 1.002 * shortest);
}

TEST(Road, PlansTheLapInInstalmentsAndHasALineAllTheTime) {
  Road road({}, model::udacity_params());
  const std::vector<Vec2> points = stadium();
  for (int i = 0; i < 55; ++i) road.add(seeing(points, i));
  int cycles = 0;
  for (; !road.line().is_closed() && cycles < 1000; ++cycles) {
    EXPECT_FALSE(road.line().is_empty());
    const Vec2 car = points[static_cast<std::size_t>(55 + cycles / 8) % points.size()];
    EXPECT_LT(road.line().project(car).distance, 2.0) << "the line is where the car is";
    EXPECT_GT(road.line().length() - road.line().project(car).s, 30.0) << "and reaches on from there";
    road.add(seeing(points, 55 + cycles / 8));
  }
  EXPECT_GT(cycles, 5);
  EXPECT_LT(cycles, 60);
}

TEST(Road, PlansTheLapAsSoonHoweverRarelyItIsAsked) {
  const std::vector<Vec2> points = stadium();
  const auto seconds_until_closed = [&](double period) {
    Road road({}, model::udacity_params());
    double time = 100.0;
    const auto add = [&](int first) {
      model::Measurement now = seeing(points, first);
      now.time = time;
      road.add(now);
      time += period;
    };
    for (int i = 0; i < 55; ++i) add(i);
    const double closed = time;
    while (!road.line().is_closed() && time < closed + 20.0)
      add(55 + static_cast<int>((time - closed) * 3.0));
    return time - closed;
  };
  const double often = seconds_until_closed(0.04);
  EXPECT_GT(often, 0.3);
  EXPECT_LT(seconds_until_closed(0.32), often + 2.0 * 0.32);
  EXPECT_LT(seconds_until_closed(0.12), often + 2.0 * 0.12);
}

TEST(Road, KeepsDrivingByTheOldLineWhileNewSettingsArePlanned) {
  Road road({}, model::udacity_params());
  const std::vector<Vec2> points = stadium();
  learn(road, points);
  const double before = road.line().demand(100.0).speed;
  road.configure({.speed = {.grip_share = 0.5}}, model::udacity_params());
  EXPECT_TRUE(road.line().is_closed());
  int cycles = 0;
  for (; road.line().demand(100.0).speed == before && cycles < 100; ++cycles) road.add(seeing(points, 10));
  EXPECT_GT(cycles, 3);
  EXPECT_LT(road.line().demand(100.0).speed, 0.9 * before);
}

TEST(Road, GoesOnFromAMapThatIsFull) {
  Road road({}, model::udacity_params());
  model::Measurement now;
  now.waypoint_count = 6;
  for (int i = 0; i < WaypointMap::kCapacity + 100; ++i) {
    for (int j = 0; j < 6; ++j)
      now.waypoints[static_cast<std::size_t>(j)] = {10.0 * (i + j), 20.0 * sin(0.05 * (i + j))};
    road.add(now);
    ASSERT_FALSE(road.line().is_empty()) << i;
    EXPECT_LT(road.line().project(now.waypoints[4]).distance, 2.0) << i;
  }
}

}  // namespace
}  // namespace chicane::road
