// SPDX-License-Identifier: MIT
#include "chicane/road/track.hpp"

#include "chicane/base/math.hpp"
#include "support/chicane_test.hpp"
#include "support/roads.hpp"
#include "support/stadium.hpp"

namespace chicane::road {
namespace {

/// Straights of `straight` and half circles of `radius` [m], counter-clockwise; the first point is the middle
/// of the lower straight.
std::vector<TrackPoint> oval(double straight, double radius, double width, bool is_mirrored = false) {
  const int count = static_cast<int>((2.0 * straight + kTwoPi * radius) / (0.4 * width));
  std::vector<Vec2> line = test::even_stadium(count, radius, straight, 0.5 * straight);
  for (Vec2& point : line) point.y() *= is_mirrored ? -1.0 : 1.0;
  return test::with_widths(line, 0.5 * width, 0.5 * width);
}
Track track(const std::vector<TrackPoint>& points, const TrackOptions& options = {}, bool is_closed = true) {
  return *Track::create("test", points, is_closed, options);
}

TEST(Corners, AreTheBendsOfAnOval) {
  for (const bool is_mirrored : {false, true}) {
    const Track road = track(oval(200.0, 50.0, 10.0, is_mirrored));
    const std::vector<Corner> corners = corners_of(road);
    ASSERT_EQ(corners.size(), 2U);
    for (int i = 0; i < 2; ++i) {
      const Corner& corner = corners[static_cast<std::size_t>(i)];
      const double begin = 100.0 + i * (200.0 + kPi * 50.0);
      EXPECT_NEAR(corner.begin, begin, 8.0);
      EXPECT_NEAR(corner.end, begin + kPi * 50.0, 8.0);
      EXPECT_NEAR(corner.turn, is_mirrored ? -kPi : kPi, 0.05);
    }
    const std::vector<double> ends = corner_sectors(road, corners);
    ASSERT_EQ(ends.size(), 2U);
    EXPECT_NEAR(ends[0], 0.5 * road.length(), 2.0) << "half-way along the straight";
    EXPECT_EQ(ends[1], road.lap_length());
  }
}

TEST(Corners, AreNumberedFromTheStartLine) {
  const double arc = kPi * 50.0;
  const Track road = track(oval(200.0, 50.0, 10.0), {.start_s = 100.0 + arc + 100.0});
  const std::vector<Corner> corners = corners_of(road);
  ASSERT_EQ(corners.size(), 2U);
  EXPECT_NEAR(corners[0].begin, 100.0 + arc + 200.0, 8.0);
  EXPECT_NEAR(corners[1].begin, 100.0, 8.0);
  const std::vector<double> ends = corner_sectors(road, corners);
  EXPECT_NEAR(ends[0], 0.5 * road.length(), 2.0);
}

TEST(Corners, OfAStartLineWithinACornerBelongToTheApexesAheadOfIt) {
  const Track road = track(oval(200.0, 50.0, 10.0), {.start_s = 130.0});
  const std::vector<Corner> corners = corners_of(road);
  ASSERT_EQ(corners.size(), 2U);
  const std::vector<double> ends = corner_sectors(road, corners);
  EXPECT_GT(ends[0], 0.0);
  EXPECT_LT(ends[0], ends[1]);
}

TEST(Corners, ScaleWithTheRoad) {
  const std::vector<Corner> corners =
      corners_of(track(oval(20.0, 5.0, 1.0), {.spacing = 0.2, .smoothing_sigma = 0.01}));
  ASSERT_EQ(corners.size(), 2U);
  EXPECT_NEAR(corners[0].turn, kPi, 0.05);
}

TEST(Corners, AreNotThereOnACircleOrAStraight) {
  EXPECT_TRUE(corners_of(track(oval(1.0, 400.0, 10.0))).empty());
  EXPECT_TRUE(corners_of(track(oval(0.0, 60.0, 10.0))).empty()) << "one bend without beginning or end";
  const Track road = test::straight_road(19, 4.0, 4.0, {});
  EXPECT_TRUE(corners_of(road).empty());
  EXPECT_TRUE(corner_sectors(road, {}).empty());
}

TEST(Corners, OfAnOpenRoadEndWithIt) {
  std::vector<TrackPoint> points = oval(200.0, 50.0, 10.0);
  points.resize(points.size() * 2 / 5);
  const Track road = track(points, {}, false);
  const std::vector<Corner> corners = corners_of(road);
  ASSERT_EQ(corners.size(), 1U);
  EXPECT_LT(corners[0].begin, corners[0].end);
  EXPECT_EQ(corner_sectors(road, corners), std::vector<double>{road.lap_length()});
}

}  // namespace
}  // namespace chicane::road
