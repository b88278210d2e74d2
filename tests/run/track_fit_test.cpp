// SPDX-License-Identifier: MIT
#include "chicane/run/roads.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "chicane/base/math.hpp"

namespace chicane::run {
namespace {

/// Circle of 60 m about the origin, 4 m to each edge.
road::Track circle() {
  std::vector<road::TrackPoint> points;
  for (int i = 0; i < 120; ++i) {
    const double angle = kTwoPi * i / 120;
    points.push_back({Vec2{60.0 * std::cos(angle), 60.0 * std::sin(angle)}, 4.0, 4.0});
  }
  return road::Track::create("circle", points, true).value();
}

/// Six waypoints on a circle of `radius`, `moved` metres to the east.
model::Measurement shown(double radius, double moved = 0.0) {
  model::Measurement measurement;
  measurement.waypoint_count = 6;
  for (int i = 0; i < 6; ++i)
    measurement.waypoints[static_cast<std::size_t>(i)] =
        Vec2{radius * std::cos(0.2 * i) + moved, radius * std::sin(0.2 * i)};
  return measurement;
}

TEST(TrackFit, TakesWaypointsOnTheRoadAndCloseToIt) {
  const road::Track track = circle();
  EXPECT_FALSE(distance_to_other_road(track, shown(60.0)));
  EXPECT_FALSE(distance_to_other_road(track, shown(63.0)));
  EXPECT_FALSE(distance_to_other_road(track, shown(60.0 + 4.0 + kBesideRoad - 0.5)));
}

TEST(TrackFit, SaysHowFarAnotherRoadIs) {
  const road::Track track = circle();
  const auto distance = distance_to_other_road(track, shown(60.0, 63.0));
  ASSERT_TRUE(distance);
  EXPECT_NEAR(*distance, 63.0, 0.5);  // the first waypoint is the farthest
  EXPECT_TRUE(distance_to_other_road(track, shown(60.0 - 4.0 - kBesideRoad - 0.5)));
}

TEST(TrackFit, OneWaypointAstrayOrTooFewSayNothing) {
  const road::Track track = circle();
  model::Measurement measurement = shown(60.0);
  measurement.waypoints[2] = Vec2{500.0, 0.0};
  EXPECT_FALSE(distance_to_other_road(track, measurement));
  measurement = shown(500.0);
  measurement.waypoint_count = 1;
  EXPECT_FALSE(distance_to_other_road(track, measurement));
}

}  // namespace
}  // namespace chicane::run
