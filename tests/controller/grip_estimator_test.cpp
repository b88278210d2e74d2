// SPDX-License-Identifier: MIT
#include "chicane/controller/grip_estimator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "chicane/base/random.hpp"

namespace chicane::controller {
namespace {

/// Corners to both sides with a share of the believed grip, and noise in what is missing.
void drive(GripEstimator& grip, double share, double noise, double seconds) {
  Random random(7);
  for (double time = 0.0; time < seconds; time += 0.04) {
    const double lateral = 9.0 * std::sin(time);
    grip.add(lateral, (share - 1.0) * lateral + noise * random.normal(), 0.04);
  }
}

TEST(GripEstimator, FindsTheShareOfTheForces) {
  for (const double share : {0.5, 0.8, 1.0, 1.2}) {
    GripEstimator grip;
    drive(grip, share, 0.0, 20.0);
    EXPECT_NEAR(grip.share(), share, 1e-12);
    EXPECT_NEAR(grip.deviation(), 0.0, 1e-6);
    GripEstimator noisy;
    drive(noisy, share, 0.5, 20.0);
    EXPECT_NEAR(noisy.share(), share, 0.03);
    EXPECT_NEAR(noisy.deviation(), 0.5 / 7.0, 0.02) << "noise over the lateral acceleration";
  }
}

TEST(GripEstimator, KnowsNothingBeforeACorner) {
  GripEstimator grip;
  for (int i = 0; i < 1000; ++i) grip.add(2.9, -2.0, 0.04);
  EXPECT_FALSE(grip.is_known());
  EXPECT_EQ(grip.share(), 1.0);
  for (int i = 0; i < 24; ++i) grip.add(-5.0, 1.0, 0.04);
  EXPECT_FALSE(grip.is_known());
  for (int i = 0; i < 3; ++i) grip.add(-5.0, 1.0, 0.04);
  EXPECT_TRUE(grip.is_known());
  EXPECT_NEAR(grip.share(), 0.8, 1e-12);
  grip.reset();
  EXPECT_FALSE(grip.is_known());
}

TEST(GripEstimator, ForgetsAnotherSurface) {
  GripEstimator grip;
  drive(grip, 1.0, 0.0, 60.0);
  drive(grip, 0.7, 0.0, 60.0);
  EXPECT_NEAR(grip.share(), 0.7, 0.02);
}

TEST(GripEstimator, StaysInItsRangeWhateverComes) {
  GripEstimator grip;
  drive(grip, 5.0, 0.0, 10.0);
  EXPECT_EQ(grip.share(), GripEstimator::kHigh);
  grip.reset();
  drive(grip, -1.0, 0.0, 10.0);
  EXPECT_EQ(grip.share(), GripEstimator::kLow);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double odd : {nan, std::numeric_limits<double>::infinity(), -0.04, 0.0}) {
    grip.add(9.0, odd == -0.04 || odd == 0.0 ? 1.0 : odd, odd);
    grip.add(odd, 1.0, 0.04);
  }
  EXPECT_EQ(grip.share(), GripEstimator::kLow);
}

}  // namespace
}  // namespace chicane::controller
