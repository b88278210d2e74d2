// SPDX-License-Identifier: MIT
#include "chicane/road/racing_road.hpp"

#include "chicane/base/math.hpp"
#include "support/chicane_test.hpp"
#include "support/roads.hpp"

namespace chicane::road {
namespace {

constexpr double kCornerRadius = 100.0;

/// Counter-clockwise, 5 m to the left, 3 m to the right.
Track circle() { return test::circle_road(kCornerRadius, 200, 5.0, 3.0); }

/// 100 m along x, its right edge moving from 2 m to 4 m.
Track straight() {
  std::vector<TrackPoint> points = test::straight_points(10, 6.0, 2.0);
  for (std::size_t i = 0; i < points.size(); ++i) points[i].right += 0.2 * static_cast<double>(i);
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
  EXPECT_NEAR(road.length, kTwoPi * kCornerRadius, 0.01);
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
    EXPECT_NEAR(point.curvature, 1.0 / kCornerRadius, 1e-4);
    EXPECT_NEAR(point.position.norm(), kCornerRadius, 0.01);
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
  EXPECT_EQ(road_data(straight(), 1e6).points.size(), 2u);
}

TEST(LinePoints, OfAnOpenRoadEndAsTheyGoOn) {
  const Track track = straight();
  RacingLine line;
  line.length = track.length();
  for (int i = 0; i <= 20; ++i)  // from left to right over the road, faster and faster
    line.points.push_back({.s = 5.0 * i, .time = 0.25 * i, .offset = 1.0 - 0.1 * i, .vx = 20.0 + 0.5 * i});
  const std::vector<LinePoint> points = line_points(track, line);
  EXPECT_NEAR(points.back().heading, points.front().heading, 1e-9);
  for (const LinePoint& point : points) {
    EXPECT_NEAR(point.curvature, 0.0, 1e-9) << "no turn back to the beginning";
    EXPECT_NEAR(point.longitudinal_acceleration, 2.0, 1e-9);
  }
}

TEST(LinePoints, AreThePlannedCoursesPlacesAndRoom) {
  // Round a circle 1 m to the right of its line, sliding: the body looks into the bend by 0.1 rad.
  const Track track = circle();
  RacingLine line;
  line.length = track.length();
  const double around = (kCornerRadius + 1.0) * kTwoPi;
  constexpr int kPoints = 200;
  for (int i = 0; i <= kPoints; ++i) {
    const double share = static_cast<double>(i) / kPoints;
    line.points.push_back({.s = share * line.length,
                           .time = share * around / 20.0,
                           .offset = -1.0,
                           .heading = 0.1,
                           .vx = 20.0 * std::cos(0.1),
                           .vy = -20.0 * std::sin(0.1)});
  }
  const std::vector<LinePoint> points = line_points(track, line);
  ASSERT_EQ(points.size(), line.points.size());
  for (const LinePoint& p : points) {
    EXPECT_NEAR(p.position.norm(), kCornerRadius + 1.0, 0.01);
    EXPECT_NEAR(p.sideslip, -0.1, 1e-12);
    EXPECT_NEAR(angle_difference(p.heading, std::atan2(p.position.y(), p.position.x())), kPi / 2.0, 1e-3);
    EXPECT_NEAR(p.curvature, 1.0 / (kCornerRadius + 1.0), 1e-3 / kCornerRadius);
    EXPECT_NEAR(p.speed, 20.0, 1e-9);
    EXPECT_NEAR(p.left, 6.0, 0.01);
    EXPECT_NEAR(p.right, 2.0, 0.01);
  }
  EXPECT_NEAR(points.back().heading - points.front().heading, kTwoPi, 1e-9);
  EXPECT_TRUE(line_points(track, {}).empty());
}

TEST(RacingLine, InterpolatesEveryValueRoundTheLap) {
  RacingLine line;
  line.length = 100.0;
  line.points = {{.s = 0.0, .time = 0.0, .offset = 1.0, .vx = 20.0, .throttle = 1.0},
                 {.s = 40.0, .time = 2.0, .offset = 3.0, .vx = 10.0, .throttle = -1.0},
                 {.s = 100.0, .time = 5.0, .offset = 1.0, .vx = 20.0, .throttle = 1.0}};
  const RacingLinePoint p = line.at(10.0);
  EXPECT_DOUBLE_EQ(p.s, 10.0);
  EXPECT_DOUBLE_EQ(p.time, 0.5);
  EXPECT_DOUBLE_EQ(p.offset, 1.5);
  EXPECT_DOUBLE_EQ(p.vx, 17.5);
  EXPECT_DOUBLE_EQ(p.throttle, 0.5);
  EXPECT_DOUBLE_EQ(line.at(110.0).offset, 1.5);
  EXPECT_DOUBLE_EQ(line.at(-60.0).offset, 3.0);
  EXPECT_DOUBLE_EQ(line.at(100.0).time, 0.0);
  EXPECT_DOUBLE_EQ(line.lap_time(), 5.0);
}

TEST(RacingLine, AnEmptyOneAnswersZeros) {
  EXPECT_TRUE(RacingLine{}.is_empty());
  EXPECT_EQ(RacingLine{}.at(3.0).vx, 0.0);
  EXPECT_EQ(RacingLine{}.lap_time(), 0.0);
}
}  // namespace
}  // namespace chicane::road
