// SPDX-License-Identifier: MIT
#include "chicane/road/line_planner.hpp"

#include "road/sample_loop.hpp"
#include "support/chicane_test.hpp"

namespace chicane::road {
namespace {

constexpr int kKnots = 300;

/// The stadium's waypoints, and on into the second lap.
struct Source {
  Source() {
    const std::vector<Vec2> points = stadium();
    WaypointMap map;
    for (int i = 0; i < 60; ++i) (void)map.add(seeing(points, i));
    EXPECT_TRUE(map.is_closed());
    line.clear();
    for (int newest = 11; newest < 80; ++newest) EXPECT_TRUE(line.extend(map, newest));
  }
  WaypointLine line;
};

struct Planned {
  ReferenceLine line{LinePlanner::samples_for(kKnots)};
  int cycles = 0;
};

Planned plan(const Source& source, double from, double to, bool is_lap, double width, int share = 1'000'000) {
  LinePlanner planner(kKnots);
  planner.configure({.smoothing_width = width}, model::road_car_params());
  Planned planned;
  EXPECT_TRUE(planner.begin(from, to, is_lap));
  while (!planner.advance(share, source.line, planned.line)) ++planned.cycles;
  return planned;
}

TEST(LinePlanner, KeepsToAStretchOfTheWaypointLineWithoutRoomToSmooth) {
  const Source source;
  const Planned planned = plan(source, 30.0, 230.0, false, 0.0);
  const ReferenceLine& line = planned.line;
  EXPECT_FALSE(line.is_closed());
  EXPECT_NEAR(line.length(), 200.0, 0.1);
  EXPECT_LE(line.spacing(), LinePlanner::kSampleSpacing);
  EXPECT_LT((line.at(0.0).position - source.line.at(30.0).position).norm(), 1e-9);
  EXPECT_LT((line.at(line.length()).position - source.line.at(230.0).position).norm(), 0.02);
  for (const ReferenceLine::Sample& sample : line.samples()) {
    EXPECT_EQ(sample.offset, 0.0);
    EXPECT_GE(sample.speed, 2.0);
  }
}

TEST(LinePlanner, ClosesALap) {
  const Source source;
  const Planned planned = plan(source, source.line.along(8), source.line.along(68), true, 1.5);
  const auto samples = planned.line.samples();
  ASSERT_TRUE(planned.line.is_closed());
  EXPECT_LT((samples.front().curve.position - samples.back().curve.position).norm(), 1e-9);
  EXPECT_EQ(samples.front().speed, samples.back().speed);
  // A turn more to one side makes the lap longer or shorter by 2π times the offset.
  EXPECT_NEAR(planned.line.length(), source.line.along(68) - source.line.along(8), kTwoPi * 1.3 * 1.5);
}

TEST(LinePlanner, PlansTheSameLineInInstalments) {
  const Source source;
  const Planned whole = plan(source, 30.0, 330.0, false, 1.5);
  const Planned in_parts = plan(source, 30.0, 330.0, false, 1.5, 200);
  EXPECT_LE(whole.cycles, 1);
  EXPECT_GT(in_parts.cycles, 10);
  ASSERT_EQ(whole.line.samples().size(), in_parts.line.samples().size());
  for (std::size_t i = 0; i < whole.line.samples().size(); ++i) {
    ASSERT_EQ(whole.line.samples()[i].curve.position, in_parts.line.samples()[i].curve.position) << i;
    ASSERT_EQ(whole.line.samples()[i].speed, in_parts.line.samples()[i].speed) << i;
  }
}

TEST(LinePlanner, TakesAboutTheWorkItSays) {
  const Source source;
  const Planned planned = plan(source, 30.0, 630.0, false, 1.5, 20);
  EXPECT_NEAR(planned.cycles, 600, 200) << "20 units for each metre";
}

TEST(LinePlanner, RefusesAStretchWithoutLengthOrWithTooManyKnots) {
  const Source source;
  LinePlanner planner(50);
  planner.configure({}, model::road_car_params());
  EXPECT_FALSE(planner.begin(30.0, 30.0, false));
  EXPECT_FALSE(planner.begin(60.0, 30.0, false));
  EXPECT_FALSE(planner.begin(0.0, std::nan(""), false));
  EXPECT_FALSE(planner.begin(0.0, 50 * WaypointLine::kSpacing, false));
  EXPECT_TRUE(planner.begin(0.0, 49 * WaypointLine::kSpacing, false));
}

}  // namespace
}  // namespace chicane::road
