// SPDX-License-Identifier: MIT
#include "chicane/controller/absence.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace chicane::controller {
namespace {

TEST(Absence, IsLongAfterWhatIsBorneOfWhatWasThere) {
  Absence absence{0.3};
  absence.note(false, 10.0);
  EXPECT_FALSE(absence.is_long) << "it was never there";
  absence.note(true, 10.0);
  absence.note(false, 10.29);
  EXPECT_FALSE(absence.is_long);
  absence.note(false, std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(absence.is_long);
  absence.note(false, 10.31);
  EXPECT_TRUE(absence.is_long);
  absence.note(true, 10.4);
  EXPECT_FALSE(absence.is_long);
  absence.note(false, 11.0);
  absence.reset();
  absence.note(false, 12.0);
  EXPECT_FALSE(absence.is_long);
  EXPECT_EQ(absence.longest, 0.3);
}

}  // namespace
}  // namespace chicane::controller
