// SPDX-License-Identifier: MIT
#include "chicane/base/option.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace chicane {
namespace {

TEST(Within, TakesTheRoundingOfFloatsForTheBorder) {
  EXPECT_EQ(within(-1e-7, 0.0, 1000.0), 0.0);
  EXPECT_EQ(within(1.0000001, -1.0, 1.0), 1.0);
  EXPECT_EQ(within(static_cast<double>(1000.00006F), 0.0, 1000.0), 1000.0) << "the next float";
  EXPECT_EQ(within(0.3, -1.0, 1.0), 0.3);
}

TEST(Within, RefusesWhatIsOutside) {
  EXPECT_FALSE(within(-0.01, 0.0, 1000.0)) << "a real negative speed";
  EXPECT_FALSE(within(1.00001, -1.0, 1.0));
  EXPECT_FALSE(within(std::numeric_limits<double>::quiet_NaN(), -1.0, 1.0));
  EXPECT_FALSE(within(std::numeric_limits<double>::infinity(), -1.0, 1.0));
}

}  // namespace
}  // namespace chicane
