// SPDX-License-Identifier: MIT
#include "chicane/road/track.hpp"

#include <gtest/gtest.h>

#include "chicane/base/math.hpp"

namespace chicane::road {
namespace {

/// A circle of 50 m whose points are `off` [m] inside and outside in turns.
Track rough_circle(double off, double sigma) {
  std::vector<TrackPoint> points;
  constexpr int kCount = 120;
  for (int i = 0; i < kCount; ++i) {
    const double radius = 50.0 + (i % 2 == 0 ? off : -off);
    const double angle = 2.0 * kPi * i / kCount;
    points.push_back({{radius * std::cos(angle), radius * std::sin(angle)}, 4.0, 4.0});
  }
  return *Track::create("circle", points, true, {.smoothing_sigma = sigma});
}

TEST(PointFit, IsTheNoiseThatSmoothingTookAway) {
  const PointFit fit = point_fit(rough_circle(0.2, 0.2));
  EXPECT_NEAR(fit.rms, 0.2, 0.03);  // the smooth line follows the noise a little
  EXPECT_GE(fit.most, fit.rms);
}

TEST(PointFit, IsNothingForALineThroughItsPoints) {
  EXPECT_LT(point_fit(rough_circle(0.0, 0.0)).most, 0.01);  // resampled every 2 m: chords of the spline
}

}  // namespace
}  // namespace chicane::road
