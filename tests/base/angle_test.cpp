// SPDX-License-Identifier: MIT
#include "chicane/base/math.hpp"

#include "chicane/base/random.hpp"
#include "support/chicane_test.hpp"

namespace chicane {
namespace {

TEST(Angle, WrapKeepsWhatIsAlreadyInRange) {
  for (double angle : {0.0, 1.0, -1.0, kPi, -3.14159, 3.14159}) EXPECT_EQ(wrap_angle(angle), angle);
}

TEST(Angle, WrapPutsHalfATurnOnThePositiveSide) {
  EXPECT_EQ(wrap_angle(-kPi), kPi);
  EXPECT_NEAR(wrap_angle(3.0 * kPi), kPi, 1e-15);
  EXPECT_GT(wrap_angle(-3.0 * kPi), 0.0);
}

TEST(Angle, WrapIsInRangeAndPointsTheSameWay) {
  Random random(1);
  for (int i = 0; i < 10000; ++i) {
    const double angle = random.uniform(-1000.0, 1000.0);
    const double wrapped = wrap_angle(angle);
    EXPECT_GT(wrapped, -kPi);
    EXPECT_LE(wrapped, kPi);
    // 1000 rad has an ulp of 1.1e-13, and up to 160 turns of rounding are taken off.
    EXPECT_NEAR(cos(wrapped), cos(angle), 1e-12);
    EXPECT_NEAR(sin(wrapped), sin(angle), 1e-12);
  }
}

TEST(Angle, DifferenceTakesTheShortWayAcrossTheCut) {
  EXPECT_NEAR(angle_difference(-3.0, 3.0), kTwoPi - 6.0, 1e-15);
  EXPECT_NEAR(angle_difference(3.0, -3.0), 6.0 - kTwoPi, 1e-15);
  EXPECT_NEAR(angle_difference(0.5, 0.2), 0.3, 1e-15);
  EXPECT_NEAR(angle_difference(0.2 + 4.0 * kTwoPi, 0.5), -0.3, 1e-13);
}

TEST(Angle, UnitsOfTheRimConvertBackAndForth) {
  EXPECT_EQ(degrees_to_radians(180.0), kPi);
  EXPECT_NEAR(radians_to_degrees(degrees_to_radians(25.0)), 25.0, 1e-14);
  EXPECT_EQ(mph_to_mps(100.0), 44.704);
  EXPECT_NEAR(mps_to_mph(mph_to_mps(60.0)), 60.0, 1e-14);
}

}  // namespace
}  // namespace chicane
