// SPDX-License-Identifier: MIT
#include "chicane/model/actuator.hpp"
#include "support/chicane_test.hpp"

namespace chicane::model {
namespace {

TEST(HelperGap, IsPassedOnceEitherWay) {
  constexpr double kNorth = 0.5 * kPi;
  EXPECT_NEAR(helper_gap_within(kNorth - 0.01, kNorth + 0.03), 0.25, 1e-12);
  EXPECT_NEAR(helper_gap_within(kNorth + 0.01, kNorth - 0.01), 0.5, 1e-12);
  EXPECT_NEAR(helper_gap_within(kNorth + 2.0 * kTwoPi - 0.01, kNorth + 2.0 * kTwoPi + 0.01), 0.5, 1e-9);
  EXPECT_EQ(helper_gap_within(0.1, 0.2), 0.0);
  EXPECT_EQ(helper_gap_within(-kNorth - 0.1, -kNorth + 0.1), 0.0) << "the other way round";
}

TEST(HelperGap, LeavesOutAsMuchWhenItIsSpread) {
  const VehicleParams car = udacity_params();
  constexpr double kRate = 1.5;  // [rad/s]
  constexpr double kStep = 1e-3;
  double turned = 0.0;
  for (double heading = -1.5; heading < 1.5; heading += kStep * kRate)
    turned += kStep * kRate * car.steer_helper * helper_left_out(car.helper_gap, 0.5 * kPi, heading, kRate);
  EXPECT_NEAR(turned, helper_gap_turn(car, kRate), 0.01 * turned);
  EXPECT_EQ(helper_gap_turn(road_car_params(), kRate), 0.0);
}

}  // namespace
}  // namespace chicane::model
