// SPDX-License-Identifier: MIT
#include "chicane/road/road.hpp"

#include "chicane/base/math.hpp"
#include "road/sample_loop.hpp"
#include "support/chicane_test.hpp"

namespace chicane::road {
namespace {

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
          << "the weight keeps it within about the width";
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
