// SPDX-License-Identifier: MIT
#include "chicane/road/track.hpp"

#include "chicane/base/math.hpp"
#include "support/chicane_test.hpp"
#include "support/roads.hpp"

namespace chicane::road {
namespace {

/// A circle of 50 m whose points are `off` [m] inside and outside in turns.
Track rough_circle(double off, double sigma) {
  bool is_inside = false;
  const auto points = test::points_round(120, [&](double) {
    is_inside = !is_inside;
    return is_inside ? 50.0 + off : 50.0 - off;
  });
  return *Track::create("circle", test::with_widths(points, 4.0, 4.0), true, {.smoothing_sigma = sigma});
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
