// SPDX-License-Identifier: MIT
#include "chicane/base/compiler.hpp"

#include <gtest/gtest.h>

namespace chicane {
namespace {

TEST(Assert, StopsATestWithPlaceAndCondition) {
  const int one = 1;
  EXPECT_DEATH(CHICANE_ASSERT(one == 2), "assert_test.cpp:[0-9]+: assertion failed: one == 2");
}

TEST(Assert, IsOneStatementAndLooksOnce) {
  int looks = 0;
  if (looks == 0)
    CHICANE_ASSERT(++looks == 1);
  else
    looks = 100;
  EXPECT_EQ(looks, 1);
}

}  // namespace
}  // namespace chicane
