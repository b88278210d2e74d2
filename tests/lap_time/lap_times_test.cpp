// SPDX-License-Identifier: MIT
#include "chicane/lap_time/limit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace chicane::lap_time {
namespace {

TEST(LapTimes, TheGapIsRelativeToTheLimit) {
  EXPECT_NEAR(gap(26.25, 25.0), 0.05, 1e-12);
  EXPECT_EQ(gap(25.0, 25.0), 0.0);
}

TEST(LapTimes, WhatWasNotMeasuredHasNoGap) {
  EXPECT_TRUE(std::isnan(gap(std::numeric_limits<double>::quiet_NaN(), 25.0)));
}

}  // namespace
}  // namespace chicane::lap_time
