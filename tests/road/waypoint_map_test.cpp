// SPDX-License-Identifier: MIT
#include "chicane/road/waypoint_map.hpp"
#include "chicane/base/math.hpp"
#include "chicane/road/road.hpp"

#include "road/sample_loop.hpp"
#include "support/chicane_test.hpp"
#include "support/roads.hpp"

namespace chicane::road {
namespace {

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

TEST(WaypointMap, StartsAnewBeforeItsFirstWaypointUntilItIsClosed) {
  WaypointMap map;
  const std::vector<Vec2> points = stadium();
  (void)map.add(seeing(points, 3));
  EXPECT_FALSE(map.add(seeing(points, 2))) << "a noisy place";
  EXPECT_TRUE(map.add(seeing(points, 1))) << "the car rolled back";
  EXPECT_EQ(map.points().front(), points[1]);
  for (int i = 1; i < 57; ++i) (void)map.add(seeing(points, i));
  ASSERT_TRUE(map.is_closed());
  EXPECT_FALSE(map.add(seeing(points, 0)));
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

TEST(WaypointMap, SaysWhereOnTheMapTheCarIsAndCountsTheMaps) {
  WaypointMap map;
  const std::vector<Vec2> points = stadium();
  (void)map.add(seeing(points, 0));
  const unsigned generation = map.generation();
  (void)map.add(seeing(points, 3));
  EXPECT_EQ(map.first_seen(), 3);
  EXPECT_EQ(map.generation(), generation);
  std::vector<Vec2> elsewhere = points;
  for (Vec2& p : elsewhere) p.y() -= 500.0;
  (void)map.add(seeing(elsewhere, 3));
  EXPECT_EQ(map.first_seen(), 0);
  EXPECT_GT(map.generation(), generation);
}

TEST(WaypointMap, TakesWaypointsNearerThanTelemetrysRoundingForOne) {
  WaypointMap map;
  std::vector<Vec2> points = stadium();
  (void)map.add(seeing(points, 0));
  for (Vec2& p : points) p.x() += 0.9 * WaypointMap::kSame;
  EXPECT_FALSE(map.add(seeing(points, 0)));
  EXPECT_EQ(map.points().size(), 6U);
}

// Both passages of a crossing may have a waypoint in the same place, also the first one of the map.
TEST(WaypointMap, IsNotClosedByAnotherPassageOfACrossing) {
  const std::vector<Vec2> points = test::eight_points(60, 60.0);
  for (int start = 0; start < 60; ++start) {
    WaypointMap map;
    for (int i = start; i < start + 54; ++i) {
      (void)map.add(seeing(points, i));
      EXPECT_FALSE(map.is_closed()) << start << ", at " << i;
    }
    for (int i = start + 54; i < start + 62; ++i) (void)map.add(seeing(points, i));
    EXPECT_TRUE(map.is_closed()) << start;
    EXPECT_EQ(map.points().size(), points.size()) << start;
  }
}

constexpr double kRingRadius = 100.0;
constexpr int kRingWaypoints = 52;  // waypoints, 12.1 m apart

std::vector<Vec2> ring_points() { return test::circle_points(kRingRadius, kRingWaypoints); }

/// A car that has seen `seen` waypoints of the circle.
WaypointMap map_of(int seen) {
  WaypointMap map;
  for (int i = 0; i + 6 <= seen; ++i) (void)map.add(seeing(ring_points(), i));
  return map;
}

TEST(WaypointLine, GoesThroughTheWaypointsAtTheirArcLength) {
  const WaypointMap map = map_of(20);
  WaypointLine line;
  line.clear();
  ASSERT_TRUE(line.extend(map, 19));
  EXPECT_EQ(line.newest(), 19);
  for (int i = 0; i < 20; ++i) {
    // Cubics between knots 3 m apart: 3⁴ / (384 R³) = 2e-7 m, more where the spline's ends lose their
    // curvature.
    EXPECT_LT((line.at(line.along(i)).position - map.points()[static_cast<std::size_t>(i)]).norm(), 0.01)
        << i;
  }
  for (int i = 5; i < 15; ++i) {
    EXPECT_NEAR(line.along(i + 1) - line.along(i), kTwoPi * kRingRadius / kRingWaypoints, 0.01) << i;
    EXPECT_NEAR(line.at(line.along(i)).curvature, 1.0 / kRingRadius, 2e-4) << i;
  }
}

TEST(WaypointLine, RefusesASingleWaypointAndKeepsWhatItHas) {
  const WaypointMap map = map_of(12);
  WaypointLine line;
  line.clear();
  EXPECT_FALSE(line.extend(map, 0));
  EXPECT_EQ(line.newest(), -1);
  ASSERT_TRUE(line.extend(map, 11));
  EXPECT_FALSE(line.extend(map, WaypointLine::kMostWaypoints));
  EXPECT_EQ(line.newest(), 11);
}

TEST(WaypointLine, NeverMovesWhatIsSettled) {
  WaypointLine line;
  line.clear();
  ASSERT_TRUE(line.extend(map_of(12), 11));
  const double settled = line.along(line.settled());
  EXPECT_EQ(line.settled(), 11 - WaypointLine::kSettled);
  std::vector<Vec2> before;
  for (double s = 0.0; s < settled - WaypointLine::kSpacing; s += 1.0) before.push_back(line.at(s).position);
  for (int newest = 12; newest < 30; ++newest) ASSERT_TRUE(line.extend(map_of(30), newest));
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_EQ(line.at(static_cast<double>(i)).position, before[i]) << i;
}

TEST(WaypointLine, GoesStraightOnBehindItsLastWaypoint) {
  WaypointLine line;
  line.clear();
  ASSERT_TRUE(line.extend(map_of(12), 11));
  const double end = line.along(11);
  const CurvePoint last = line.at(end);
  const CurvePoint beyond = line.at(end + WaypointLine::kTail - 1.0);
  // The curvature fades out between knots: centimetres.
  EXPECT_LT((beyond.position - last.position - (WaypointLine::kTail - 1.0) * last.tangent).norm(), 0.1);
}

TEST(WaypointLine, CountsWaypointsOnInTheSecondLap) {
  const WaypointMap map = map_of(kRingWaypoints + 6);
  ASSERT_TRUE(map.is_closed());
  ASSERT_EQ(map.points().size(), static_cast<std::size_t>(kRingWaypoints));
  WaypointLine line;
  line.clear();
  for (int newest = 11; newest < kRingWaypoints + 10; ++newest) ASSERT_TRUE(line.extend(map, newest));
  EXPECT_LT((line.at(line.along(kRingWaypoints + 3)).position - map.points()[3]).norm(), 0.01);
  EXPECT_NEAR(line.along(kRingWaypoints + 4) - line.along(4), kTwoPi * kRingRadius, 0.1);
  EXPECT_NEAR(line.at(line.along(kRingWaypoints + 4)).heading - line.at(line.along(4)).heading, kTwoPi, 0.01);
  EXPECT_FALSE(line.is_full());
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
