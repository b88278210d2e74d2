// SPDX-License-Identifier: MIT
#include "chicane/road/waypoint_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "road/sample_loop.hpp"

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
  std::vector<Vec2> points;
  for (int i = 0; i < 60; ++i) {
    const double angle = kTwoPi * i / 60.0;
    points.push_back({100.0 * std::sin(angle), 60.0 * std::sin(2.0 * angle)});
  }
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

}  // namespace
}  // namespace chicane::road
