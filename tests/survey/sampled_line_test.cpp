// SPDX-License-Identifier: MIT
#include "chicane/survey/sampled_line.hpp"
#include "chicane/base/math.hpp"
#include "support/chicane_test.hpp"

namespace chicane::survey {
namespace {

const std::vector<Vec2> kSquare{{0.0, 0.0}, {4.0, 0.0}, {4.0, 4.0}, {0.0, 4.0}};

TEST(SampledLine, MeasuresOpenAndClosedLines) {
  EXPECT_DOUBLE_EQ(length_of(kSquare, false), 12.0);
  EXPECT_DOUBLE_EQ(length_of(kSquare, true), 16.0);
}

TEST(SampledLine, HasEqualDistancesAndBeginsWhereTheLineDoes) {
  const std::vector<Vec2> closed = sampled(kSquare, true, 1.0);
  ASSERT_EQ(closed.size(), 16U);
  EXPECT_EQ(closed[0].x(), 0.0);
  for (std::size_t i = 0; i < closed.size(); ++i)
    EXPECT_NEAR((closed[(i + 1) % closed.size()] - closed[i]).norm(), 1.0, 1e-9) << i;
  const std::vector<Vec2> open = sampled(kSquare, false, 0.9);
  EXPECT_NEAR((open.back() - kSquare.back()).norm(), 0.0, 1e-9);
}

TEST(SampledLine, KnowsItsDirection) {
  const std::vector<Vec2> clockwise(kSquare.rbegin(), kSquare.rend());
  EXPECT_DOUBLE_EQ(signed_area(kSquare), 16.0);
  EXPECT_DOUBLE_EQ(signed_area(clockwise), -16.0);
}

// Lengths of a degree of WGS 84 at 48 N after the series of the US National Geospatial-Intelligence Agency's
// table: 111.1999 km of latitude, 74.6256 km of longitude.
TEST(Geodesy, MeasuresTheEllipsoid) {
  const std::vector<Geographic> north{{47.99, 11.0}, {48.01, 11.0}};
  const std::vector<Vec2> a = to_plane(north);
  EXPECT_NEAR((a[1] - a[0]).norm(), 0.02 * 111'199.0, 1.0);
  const std::vector<Geographic> east{{48.0, 10.99}, {48.0, 11.01}};
  const std::vector<Vec2> b = to_plane(east);
  EXPECT_NEAR((b[1] - b[0]).norm(), 0.02 * 74'626.0, 1.0);
  EXPECT_GT(b[1].x(), b[0].x()) << "x is east";
  EXPECT_GT(a[1].y(), a[0].y()) << "y is north";
}

TEST(Geodesy, CrossesTheDateLine) {
  const std::vector<Geographic> places{{-17.0, 179.995}, {-17.0, -179.995}};
  const std::vector<Vec2> points = to_plane(places);
  EXPECT_NEAR(points[1].x() - points[0].x(), 1065.0, 2.0);
}

/// Cones of a ring of radius 20 m, 4 m wide, driven counter-clockwise: the blue ones are inside.
Cones ring() {
  Cones cones;
  for (int i = 0; i < 30; ++i) {
    const double a = kTwoPi * i / 30.0, b = kTwoPi * (i + 0.5) / 30.0;
    cones.left.push_back({18.0 * std::cos(a), 18.0 * std::sin(a)});
    cones.right.push_back({22.0 * std::cos(b), 22.0 * std::sin(b)});
  }
  return cones;
}

TEST(ConeLine, IsBetweenTheTwoSidesWithBlueOnTheLeft) {
  const auto road = test::good(line_between(ring()));
  EXPECT_TRUE(road->is_closed);
  EXPECT_TRUE(road->gaps.empty());
  EXPECT_NEAR(road->median_width, 4.0, 0.2);
  for (std::size_t i = 0; i < road->points.size(); ++i) {
    // Fences are chords: up to 12 cm inside of the circle.
    EXPECT_NEAR(road->points[i].position.norm(), 20.0, 0.2);
    const Vec2 along = road->points[(i + 1) % road->points.size()].position - road->points[i].position;
    EXPECT_GT(road->points[i].position.x() * along.y() - road->points[i].position.y() * along.x(), 0.0);
  }
}

TEST(ConeLine, OtherColoursGoTheOtherWayRound) {
  Cones cones = ring();
  std::swap(cones.left, cones.right);
  const auto road = test::good(line_between(cones));
  const Vec2 along = road->points[1].position - road->points[0].position;
  EXPECT_LT(road->points[0].position.x() * along.y() - road->points[0].position.y() * along.x(), 0.0);
}

// Two circles side by side, 3 m wide, whose ways cross in the middle.
TEST(ConeLine, RefusesASkidpad) {
  Cones cones;
  for (const double side : {-1.0, 1.0}) {
    for (int i = 0; i < 16; ++i) {
      const double angle = kTwoPi * i / 16.0;
      const Vec2 direction{std::cos(angle), std::sin(angle)};
      const Vec2 middle{9.125 * side, 0.0}, outer = middle + 10.625 * direction;
      (side < 0.0 ? cones.left : cones.right).push_back(middle + 7.625 * direction);
      if (outer.x() * side > 1.5) (side < 0.0 ? cones.right : cones.left).push_back(outer);
    }
    for (const double y : {-17.0, -14.0, -11.0, 11.0, 14.0, 17.0}) cones.either.push_back({1.5 * side, y});
  }
  EXPECT_THAT(line_between(cones).error().message,
              HasSubstr("expected one that does not cross itself, as a skidpad does"));
}

TEST(ConeLine, MissingConesAreNamedAndBridged) {
  Cones cones = ring();
  cones.left.erase(cones.left.begin() + 7, cones.left.begin() + 9);
  const auto road = test::good(line_between(cones));
  ASSERT_EQ(road->gaps.size(), 1U);
  EXPECT_TRUE(road->gaps[0].is_left);
  EXPECT_NEAR(road->gaps[0].length, 2.0 * 18.0 * std::sin(0.5 * kTwoPi / 10.0), 1e-9);
  for (const road::TrackPoint& point : road->points) EXPECT_NEAR(point.position.norm(), 20.0, 0.8);
}

TEST(ConeLine, OrangeConesBelongToTheNearerSide) {
  Cones cones = ring();
  cones.either = {cones.left[3], cones.right[3]};
  cones.left.erase(cones.left.begin() + 3);
  cones.right.erase(cones.right.begin() + 3);
  const auto road = test::good(line_between(cones));
  EXPECT_TRUE(road->gaps.empty());
}

TEST(ConeLine, AStraightCourseIsOpen) {
  Cones cones;
  for (int i = 0; i < 16; ++i) {
    cones.left.push_back({5.0 * i, 1.5});
    cones.right.push_back({5.0 * i, -1.5});
  }
  const auto road = test::good(line_between(cones));
  EXPECT_FALSE(road->is_closed);
  EXPECT_NEAR(road->points.front().position.y(), 0.0, 0.1);
  EXPECT_LT(road->points.front().position.x(), road->points.back().position.x()) << "blue is left";
  EXPECT_NEAR(road->points.back().position.x() - road->points.front().position.x(), 75.0, 8.0);
}

TEST(ConeLine, RefusesTooFew) {
  EXPECT_THAT(
      line_between({.left = {{0, 0}}, .right = ring().right}).error().message,
      HasSubstr("cones: got 1 of the left side and 30 of the right one, expected at least 3 of each"));
}

}  // namespace
}  // namespace chicane::survey
