// SPDX-License-Identifier: MIT
#include "chicane/path/road_data.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "chicane/base/angle.hpp"

namespace chicane::path {
namespace {

constexpr double kRadius = 100.0;

/// Counter-clockwise, 5 m to the left, 3 m to the right.
Track circle() {
  std::vector<TrackPoint> points;
  for (int i = 0; i < 200; ++i) {
    const double angle = kTwoPi * i / 200;
    points.push_back({kRadius * Vec2{std::cos(angle), std::sin(angle)}, 5.0, 3.0});
  }
  return Track::create("circle", points, true, {.smoothing_sigma = 0.0}).value();
}

/// 100 m along x, its right edge moving from 2 m to 4 m.
Track straight() {
  std::vector<TrackPoint> points;
  for (int i = 0; i <= 10; ++i) points.push_back({Vec2{10.0 * i, 0.0}, 6.0, 2.0 + 0.2 * i});
  return Track::create("straight", points, false, {.smoothing_sigma = 0.0}).value();
}

TEST(RoadData, SpacesItsPointsEvenlyAndByNoMoreThanAsked) {
  const RoadData road = road_data(circle(), 7.0);
  ASSERT_EQ(road.points.size(), 91u);  // 628.3 m in 90 intervals
  for (std::size_t i = 1; i < road.points.size(); ++i)
    EXPECT_NEAR(road.points[i].s - road.points[i - 1].s, road.length / 90.0, 1e-9);
  EXPECT_TRUE(road.racing_line.empty());
}

TEST(RoadData, ClosesWithTheFirstPointOneTurnLater) {
  const RoadData road = road_data(circle(), 5.0);
  EXPECT_TRUE(road.is_closed);
  EXPECT_NEAR(road.length, kTwoPi * kRadius, 0.01);
  const RoadPoint& first = road.points.front();
  const RoadPoint& last = road.points.back();
  EXPECT_EQ(first.s, 0.0);
  EXPECT_EQ(last.s, road.length);
  EXPECT_LT((last.position - first.position).norm(), 1e-9);
  EXPECT_NEAR(last.heading - first.heading, kTwoPi, 1e-9);
  EXPECT_EQ(last.left, first.left);
}

TEST(RoadData, HasTheTracksHeadingCurvatureAndWidthsOnEachSide) {
  for (const RoadPoint& point : road_data(circle(), 5.0).points) {
    EXPECT_NEAR(point.curvature, 1.0 / kRadius, 1e-4);
    EXPECT_NEAR(point.position.norm(), kRadius, 0.01);
    EXPECT_NEAR(angle_difference(point.heading, std::atan2(point.position.y(), point.position.x())),
                kPi / 2.0, 1e-3);
    EXPECT_NEAR(point.left, 5.0, 0.01);
    EXPECT_NEAR(point.right, 3.0, 0.01);
  }
}

TEST(RoadData, EndsWhereAnOpenRoadEnds) {
  const RoadData road = road_data(straight(), 25.0);
  EXPECT_FALSE(road.is_closed);
  ASSERT_EQ(road.points.size(), 5u);
  EXPECT_NEAR(road.points.back().position.x(), 100.0, 1e-9);
  EXPECT_NEAR(road.points[2].right, 3.0, 1e-9);
  EXPECT_NEAR(road.points.back().right, 4.0, 1e-9);
  EXPECT_NEAR(road.points.back().left, 6.0, 1e-9);
}

TEST(RoadData, HasItsTwoEndsHoweverWideTheSpacing) {
  EXPECT_EQ(road_data(straight(), 1e6).points.size(), 2u);
}

}  // namespace
}  // namespace chicane::path
