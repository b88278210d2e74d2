// SPDX-License-Identifier: MIT
#include "chicane/road/smooth_line.hpp"

#include "chicane/base/math.hpp"
#include "chicane/base/random.hpp"
#include "support/chicane_test.hpp"
#include "support/roads.hpp"
#include "support/stadium.hpp"

namespace chicane::road {
namespace {

std::vector<Vec2> circle(int count, double sigma) {
  Random random{3};
  return test::points_round(count, [&](double /*angle*/) { return 50.0 + sigma * random.normal(); });
}

TEST(SmoothLine, KeepsAStraightLineExactlyAndSpacesItEvenly) {
  std::vector<Vec2> points;
  for (const double x : {0.0, 3.0, 11.0, 20.0, 44.0, 60.0}) points.emplace_back(x, 0.5 * x);
  const Result<SmoothLine> line = test::good(smooth_line(points, false, 2.0, 0.1));
  EXPECT_NEAR(line->length, 60.0 * std::hypot(1.0, 0.5), 1e-6);
  EXPECT_LE(line->spacing, 2.0);
  for (std::size_t i = 0; i < line->knots.size(); ++i) {
    EXPECT_NEAR(line->knots[i].y(), 0.5 * line->knots[i].x(), 1e-6);
    if (i > 0) {
      EXPECT_NEAR((line->knots[i] - line->knots[i - 1]).norm(), line->spacing, 1e-6);
    }
  }
  EXPECT_LT(line->max_deviation, 1e-6);
}

TEST(SmoothLine, TakesNoiseOffAClosedLineAndSaysHowMuch) {
  const Result<SmoothLine> line = test::good(smooth_line(circle(300, 0.1), true, 2.0, 0.1));
  EXPECT_NEAR(line->length, kTwoPi * 50.0, 1.0);
  double worst = 0.0;
  for (const Vec2& knot : line->knots) worst = std::max(worst, std::fabs(knot.norm() - 50.0));
  EXPECT_LT(worst, 0.15) << "the noise has peaks of 0.3 m";
  EXPECT_NEAR(line->rms_deviation, 0.1, 0.02);
  EXPECT_GE(line->max_deviation, line->rms_deviation);
}

TEST(SmoothLine, SaysWhereEachGivenPointIsAlongIt) {
  const Result<SmoothLine> line = test::good(smooth_line(circle(100, 0.0), true, 1.0, 0.0));
  ASSERT_EQ(line->parameter.size(), 100u);
  for (std::size_t i = 1; i < 100; ++i)
    EXPECT_NEAR(line->parameter[i] - line->parameter[i - 1], kTwoPi * 50.0 / 100.0, 0.02) << i;
}

/// Distance of a place from the stadium of test::stadium(radius, …, straight) [m].
double from_stadium(const Vec2& place, double radius, double straight) {
  const double beyond = place.x() - std::clamp(place.x(), 0.0, straight);
  return std::fabs(std::hypot(beyond, place.y()) - radius);
}

// The straights bowed by up to 40 m: the third derivative says nothing of a gap 20 times the usual one.
TEST(SmoothLine, KeepsStraightsAndArcsOfUnevenPoints) {
  for (const double sigma : {0.1, 1.0}) {
    const std::vector<Vec2> points = test::stadium(40.0, 9, 300.0);
    const Result<SmoothLine> line = test::good(smooth_line(points, true, 2.0, sigma));
    EXPECT_NEAR(line->length, 600.0 + kTwoPi * 40.0, 3.0);
    EXPECT_LE(line->max_deviation, 2.0 * sigma + 0.01);
    double worst = 0.0;
    for (const Vec2& knot : line->knots) worst = std::max(worst, from_stadium(knot, 40.0, 300.0));
    EXPECT_LT(worst, 0.8 + 2.0 * sigma);
  }
}

TEST(SmoothLine, FindsTheNoiseOfThePoints) {
  for (const double noise : {0.05, 0.3})
    EXPECT_NEAR(estimate_noise(circle(300, noise), true, 2.0), noise, 0.2 * noise);
  EXPECT_LT(estimate_noise(circle(100, 0.0), true, 2.0), 0.01);
}

// Files of 300 and of six points took 12 GB and a minute.
TEST(SmoothLine, RefusesPointsBetweenWhichThereAreTooManyKnots) {
  for (const int count : {6, 60, 300}) {
    int i = 0;
    const auto points = test::points_round(
        count, [&](double) { return 1500.0 + (count == 6 ? 300.0 * std::sin(2.1 * i++) : 0.0); });
    constexpr double kFinest = 0.05;    // spacing [m]
    constexpr double kMostNoise = 1.0;  // sigma [m]
    const Result<SmoothLine> line = smooth_line(points, true, kFinest, kMostNoise);
    if (line) {
      EXPECT_LT(line->knots.size(), 400'000U) << count;
    } else {
      EXPECT_THAT(line.error().message, HasSubstr("points: got points that no smooth line follows"));
    }
  }
}

}  // namespace
}  // namespace chicane::road
