// SPDX-License-Identifier: MIT
#include "chicane/road/reference_line.hpp"

#include "road/sample_loop.hpp"
#include "support/chicane_test.hpp"

namespace chicane::road {
namespace {

constexpr double kRadius = 50.0;

/// A quarter of a circle to the left from the origin, along x; or the whole of it.
ReferenceLine circle(bool is_closed) {
  const int intervals = is_closed ? 240 : 60;
  ReferenceLine line(241);
  EXPECT_TRUE(line.shape(kRadius * kTwoPi * intervals / 240, intervals, is_closed));
  for (std::size_t i = 0; i < line.samples().size(); ++i) {
    const double angle = kTwoPi * static_cast<double>(i) / 240.0;
    ReferenceLine::Sample& at = line.samples()[i];
    at.curve = {.position = {kRadius * std::sin(angle), kRadius * (1.0 - std::cos(angle))},
                .tangent = {std::cos(angle), std::sin(angle)},
                .heading = angle,
                .curvature = 1.0 / kRadius};
    at.speed = 20.0 + static_cast<double>(i);
  }
  return line;
}

TEST(ReferenceLine, RefusesAShapeWithoutLengthOrBeyondItsCapacity) {
  ReferenceLine line(11);
  EXPECT_TRUE(line.shape(10.0, 10, false));
  EXPECT_FALSE(line.is_empty());
  EXPECT_FALSE(line.shape(10.0, 11, false));
  EXPECT_TRUE(line.is_empty());
  EXPECT_FALSE(line.shape(0.0, 5, false));
  EXPECT_FALSE(line.shape(std::numeric_limits<double>::quiet_NaN(), 5, false));
  EXPECT_FALSE(line.shape(10.0, 0, false));
}

TEST(ReferenceLine, IsFourthOrderBetweenItsSamples) {
  const ReferenceLine line = circle(false);
  for (double s = 0.0; s < line.length(); s += 0.37) {
    // 1.3 m of a circle of 50 m: length⁴ / (384 R³) = 6e-8 m.
    EXPECT_NEAR((line.at(s).position - Vec2{0.0, kRadius}).norm(), kRadius, 1e-7) << s;
    EXPECT_NEAR(line.at(s).heading, s / kRadius, 1e-9) << s;
    EXPECT_NEAR(line.at(s).curvature, 1.0 / kRadius, 1e-12) << s;
  }
}

TEST(ReferenceLine, GoesStraightOnBeyondAnOpenEnd) {
  const ReferenceLine line = circle(false);
  const CurvePoint end = line.at(line.length());
  const CurvePoint beyond = line.at(line.length() + 7.0);
  EXPECT_NEAR((beyond.position - end.position - 7.0 * end.tangent).norm(), 0.0, 1e-12);
  EXPECT_EQ(beyond.curvature, 0.0);
  const ReferenceLine::Demand demand = line.demand(line.length() + 7.0);
  EXPECT_EQ(demand.curvature, 0.0);
  EXPECT_EQ(demand.speed, 80.0);
  EXPECT_EQ(demand.speed_slope, 0.0);
  const ReferenceLine::Projection near = line.project(beyond.position + Vec2{-1.0, 0.0});
  EXPECT_NEAR(near.s, line.length(), 1e-9);
  EXPECT_NEAR(near.d, 1.0, 1e-9);  // the line ends along y: −x is its left
  EXPECT_NEAR(near.distance, std::hypot(7.0, 1.0), 1e-9);
}

TEST(ReferenceLine, TurnsOnBeyondTheFirstLap) {
  const ReferenceLine line = circle(true);
  for (const double s : {1.0, 123.4, 300.0}) {
    EXPECT_NEAR((line.at(s + 2.0 * line.length()).position - line.at(s).position).norm(), 0.0, 1e-9);
    EXPECT_NEAR(line.at(s + 2.0 * line.length()).heading, line.at(s).heading + 2.0 * kTwoPi, 1e-9);
    EXPECT_NEAR(line.at(s - line.length()).heading, line.at(s).heading - kTwoPi, 1e-9);
  }
}

/// The line's own figures agree with each other: tangent, heading and curvature are those of its positions.
void expect_a_curve(const ReferenceLine& line) {
  constexpr double kStep = 0.5;  // [m]
  for (double s = 2.0; s < line.length() - 2.0; s += 0.7) {
    const CurvePoint at = line.at(s);
    const Vec2 before = line.at(s - kStep).position;
    const Vec2 after = line.at(s + kStep).position;
    EXPECT_NEAR((after - before).norm(), 2.0 * kStep, 2e-3) << s;
    EXPECT_NEAR(angle_difference(atan2(at.tangent.y(), at.tangent.x()), at.heading), 0.0, 2e-3) << s;
    const Vec2 bend = (after - 2.0 * at.position + before) / (kStep * kStep);
    const double curvature = at.tangent.x() * bend.y() - at.tangent.y() * bend.x();
    EXPECT_NEAR(curvature, at.curvature, 4e-3) << s;  // a cubic between samples against a line through them
  }
}

TEST(ReferenceLine, IsOneCurveInPositionHeadingAndCurvature) {
  Road road({.smoothing_width = 1.0}, model::udacity_params());
  const std::vector<Vec2> points = stadium();
  for (int i = 0; i < 20; ++i) road.add(seeing(points, i));
  ASSERT_FALSE(road.line().is_empty());
  expect_a_curve(road.line());
  learn(road, points, 20);
  expect_a_curve(road.line());
}

TEST(ReferenceLine, ProjectsOntoTheNearestPlace) {
  Road road({}, model::udacity_params());
  learn(road, stadium());
  const ReferenceLine& line = road.line();
  for (double s = 0.0; s < line.length(); s += 3.3) {
    for (const double d : {-3.0, 0.0, 2.0}) {
      const CurvePoint at = line.at(s);
      const Vec2 point = at.position + d * Vec2{-at.tangent.y(), at.tangent.x()};
      const auto near = line.project(point, s + 10.0, 30.0);
      EXPECT_NEAR(std::remainder(near.s - s, line.length()), 0.0,
                  1e-4);  // the foot of a cubic between samples
      EXPECT_NEAR(near.d, d, 1e-6);
      EXPECT_NEAR(near.distance, std::fabs(d), 1e-6);
      EXPECT_NEAR(std::remainder(line.project(point).s - near.s, line.length()), 0.0, 1e-9);
    }
  }
}

}  // namespace
}  // namespace chicane::road
