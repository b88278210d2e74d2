// SPDX-License-Identifier: MIT
#include "chicane/lap_time/limit.hpp"

#include "chicane/base/math.hpp"
#include "support/chicane_test.hpp"
#include "support/roads.hpp"
#include "support/stadium.hpp"

namespace chicane::lap_time {
namespace {

/// A closed road with corners to both sides, one side wider than the other; `side` −1 mirrors it at the y
/// axis, along which the original's helper has its gap.
road::Track bean(double side = 1.0, double size = 1.0) { return test::bean_road(side, size, 4.0, 5.0); }

const PlantLimitOptions kCoarse{.time_step = 0.1};

const PlantLimit& limit_of(const std::string& car) {
  static const PlantLimit udacity = *find_plant_limit(bean(), "udacity", {}, kCoarse);
  static const PlantLimit road_car = *find_plant_limit(bean(), "road-car", {}, kCoarse);
  return car == "udacity" ? udacity : road_car;
}

class PlantLimitOf : public testing::TestWithParam<const char*> {};

TEST_P(PlantLimitOf, IsBracketedByALapThatWasDriven) {
  const PlantLimit& limit = limit_of(GetParam());
  ASSERT_TRUE(limit.witness);
  EXPECT_GE(limit.witness->laps, 3);
  EXPECT_GE(limit.witness->least_edge, 0.0);
  EXPECT_GE(limit.bracket(), 0.0);
  EXPECT_LE(limit.bracket(), 0.01);
}

/// Steps that go past the bounds would be halved, and cost time.
TEST_P(PlantLimitOf, IsFoundInFewSteps) {
  const bool is_udacity = GetParam() == std::string("udacity");
  EXPECT_GT(limit_of(GetParam()).of_optimum.iterations, 20);
  EXPECT_LE(limit_of(GetParam()).of_optimum.iterations, is_udacity ? 110 : 250);
}

TEST_P(PlantLimitOf, AMirroredRoadHasTheMirroredLine) {
  const PlantLimit& limit = limit_of(GetParam());
  const auto mirrored =
      test::good(find_plant_limit(bean(-1.0), GetParam(), {}, {.time_step = 0.1, .wants_witness = false}));
  EXPECT_NEAR(mirrored->bound.lap / limit.bound.lap, 1.0, 5e-4);  // nodes lie elsewhere
  for (double s = 0.0; s < limit.line.length; s += 10.0)
    EXPECT_NEAR(mirrored->line.at(s).offset, -limit.line.at(s).offset, 0.25) << s;
}

TEST_P(PlantLimitOf, FinerNodesChangeLittle) {
  const auto finer =
      test::good(find_plant_limit(bean(), GetParam(), {}, {.time_step = 0.05, .wants_witness = false}));
  EXPECT_NEAR(finer->bound.lap / limit_of(GetParam()).bound.lap, 1.0, 1e-3);  // second order in the spacing
}

TEST_P(PlantLimitOf, TheLineTellsTheMotionOfALap) {
  const PlantLimit& limit = limit_of(GetParam());
  EXPECT_EQ(limit.line.car, GetParam());
  EXPECT_EQ(limit.line.points.front().s, 0.0);
  EXPECT_EQ(limit.line.points.back().s, limit.line.length);
  EXPECT_NEAR(limit.line.lap_time(), limit.bound.lap, 1e-9);
  EXPECT_NEAR(limit.bound.sectors[0] + limit.bound.sectors[1] + limit.bound.sectors[2], limit.bound.lap,
              1e-9);
  for (std::size_t i = 1; i < limit.line.points.size(); ++i) {
    const road::RacingLinePoint& a = limit.line.points[i - 1];
    const road::RacingLinePoint& b = limit.line.points[i];
    ASSERT_NEAR(b.vx - a.vx, 0.5 * (a.acceleration + b.acceleration) * (b.time - a.time), 0.02)
        << a.s;  // the gap of the helper is not in `acceleration`
  }
}

TEST_P(PlantLimitOf, MoreGripIsFaster) {
  const auto better = test::good(find_plant_limit(bean(), GetParam(), {.friction_scale = 1.1},
                                                  {.time_step = 0.1, .wants_witness = false}));
  EXPECT_LT(better->bound.lap, limit_of(GetParam()).bound.lap);
}

INSTANTIATE_TEST_SUITE_P(Plants, PlantLimitOf, testing::Values("udacity", "road-car"), [](const auto& param) {
  return std::string(param.param) == "udacity" ? "Udacity" : "RoadCar";
});

TEST(PlantLimit, ARoadShorterThanTheCarsTightestCircleIsRefused) {
  // A ring of 4 m, 1.3 m to each side.
  const road::Track track = test::circle_road(4.0, 60, 1.3, 1.3, {.spacing = 0.3, .smoothing_sigma = 0.0});
  const Result<PlantLimit> limit = find_plant_limit(track, "road-car");
  ASSERT_FALSE(limit);
  EXPECT_EQ(limit.error().code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(limit.error().message,
              HasSubstr("the loop is 25.1 m long, expected more than the car's circle at full lock"));
}

TEST(PlantLimit, ARoadNarrowerThanTheCarIsNamedWithItsPlace) {
  EXPECT_THAT(test::refusal_of(find_plant_limit(test::circle_road(60.0, 60, 0.8, 0.8, {}), "udacity")),
              HasSubstr("the road is 1.6"));
}

TEST(PlantLimit, RefusesWhatItCannotAnswer) {
  EXPECT_FALSE(find_plant_limit(test::straight_road(19, 4.0, 4.0, {}), "udacity"));
  EXPECT_FALSE(find_plant_limit(bean(), "boat"));
  EXPECT_FALSE(find_plant_limit(bean(), "udacity", {}, {.time_step = 1.0}));
}

TEST(PlantLimit, CanBeStopped) {
  EXPECT_THAT(test::refusal_of(find_plant_limit(
                  bean(), "udacity", {}, {.go_on = [](std::string_view, int i, double) { return i < 3; }})),
              HasSubstr("stopped"));
}

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
  const double side = 300.0 + kPi * 50.0;
  const auto points = test::with_widths(test::even_stadium(200, 50.0, 300.0), 5.0, 5.0);
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
