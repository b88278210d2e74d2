// SPDX-License-Identifier: MIT
#include "chicane/lap_time/limit.hpp"

#include "chicane/base/math.hpp"
#include "support/chicane_test.hpp"
#include "support/roads.hpp"

namespace chicane::lap_time {
namespace {

constexpr double kRadius = 50.0, kInside = 2.0, kSpeed = 20.0;

road::Track ring(double start_s) { return test::circle_road(kRadius, 90, 5.0, 5.0, {.start_s = start_s}); }

/// A lap at a constant distance inside of the ring's centre line, at one speed.
PlantLimit inner_lap(const road::Track& track) {
  PlantLimit limit;
  limit.line.length = track.length();
  const double lap_time = kTwoPi * (kRadius - kInside) / kSpeed;
  for (int i = 0; i <= 100; ++i)
    limit.line.points.push_back(
        {.s = track.length() * i / 100, .time = lap_time * i / 100, .offset = kInside, .vx = kSpeed});
  limit.bound = {.lap = lap_time, .sectors = {lap_time / 3, lap_time / 3, lap_time / 3}};
  return limit;
}

TEST(Limit, BeginsAtTheStartLineAndEndsThereALapLater) {
  const road::Track track = ring(100.0);
  const PlantLimit found = inner_lap(track);
  const Limit limit = bound_from_start(track, found);
  EXPECT_EQ(limit.times.lap, found.bound.lap);
  ASSERT_GE(limit.line.size(), 101U);
  const road::LinePoint &first = limit.line.front(), &last = limit.line.back();
  EXPECT_NEAR(first.s, 100.0, 1e-9);
  EXPECT_NEAR(last.s, 100.0, 1e-9);
  EXPECT_EQ(first.time, 0.0);
  EXPECT_DOUBLE_EQ(last.time, found.bound.lap);
  EXPECT_EQ(last.position, first.position);
  EXPECT_NEAR(last.heading - first.heading, kTwoPi, 1e-6) << "continuous along the lap";
  for (std::size_t i = 1; i < limit.line.size(); ++i) {
    const road::LinePoint &before = limit.line[i - 1], &now = limit.line[i];
    EXPECT_GT(now.time, before.time) << i;
    EXPECT_LT(std::fabs(now.heading - before.heading), 0.1) << i;
    EXPECT_NEAR(now.curvature, 1.0 / (kRadius - kInside), 2e-4) << i;  // from differences of headings
    // The way that the time between two points says, along a chord: 1.5 m of 48 m of radius.
    EXPECT_NEAR((now.position - before.position).norm(), kSpeed * (now.time - before.time), 0.01) << i;
  }
}

TEST(Limit, OfARoadThatBeginsAtItsStartLineKeepsItsPoints) {
  const road::Track track = ring(0.0);
  const PlantLimit found = inner_lap(track);
  const Limit limit = bound_from_start(track, found);
  ASSERT_EQ(limit.line.size(), found.line.points.size());
  for (std::size_t i = 0; i + 1 < limit.line.size(); ++i) {
    EXPECT_DOUBLE_EQ(limit.line[i].s, found.line.points[i].s) << i;
    EXPECT_DOUBLE_EQ(limit.line[i].time, found.line.points[i].time) << i;
  }
}

TEST(CornerTimes, AreThoseBetweenTheEndsOfTheCorners) {
  // A road of two half circles of 50 m and straights of 300 m, 5 m behind whose beginning is the start line.
  std::vector<road::TrackPoint> points;
  const double half = kTwoPi / 2.0 * 50.0, side = 300.0 + half;
  for (int i = 0; i < 200; ++i) {
    const double s = 2.0 * side * i / 200.0, t = std::fmod(s, side), sign = s < side ? 1.0 : -1.0;
    const double angle = t < 300.0 ? 0.0 : (t - 300.0) / 50.0, x = t < 300.0 ? t - 150.0 : 150.0;
    points.push_back({{sign * (x + 50.0 * std::sin(angle)), -sign * 50.0 * std::cos(angle)}, 5.0, 5.0});
  }
  const road::Track track = *road::Track::create("stadium", points, true, {.start_s = 5.0});
  road::RacingLine line{.length = track.length()};
  constexpr int kCount = 50;
  for (int i = 0; i <= kCount; ++i) {  // twice as fast in the first half of the road
    const double s = track.length() * i / kCount, middle = 0.5 * track.length();
    line.points.push_back({.s = s, .time = s < middle ? s / 40.0 : middle / 40.0 + (s - middle) / 20.0});
  }
  const std::vector<double> times = corner_times(track, line);
  ASSERT_EQ(times.size(), 2U);
  // From the line to the middle of the second straight, the quarter of the road beyond which is slow.
  const double first = side + 150.0 - 5.0, slow = 150.0;
  EXPECT_NEAR(times[0], (first - slow) / 40.0 + slow / 20.0, 0.1);
  EXPECT_NEAR(times[0] + times[1], line.lap_time(), 1e-9);
  EXPECT_TRUE(corner_times(track, road::RacingLine{}).empty());
}

TEST(Limit, WithoutALineHasTimesAlone) {
  PlantLimit found;
  found.bound.lap = 20.0;
  const Limit limit = bound_from_start(ring(0.0), found);
  EXPECT_EQ(limit.times.lap, 20.0);
  EXPECT_TRUE(limit.line.empty());
}

}  // namespace
}  // namespace chicane::lap_time
