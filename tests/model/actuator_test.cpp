// SPDX-License-Identifier: MIT
#include "chicane/model/actuator.hpp"
#include "support/chicane_test.hpp"

namespace chicane::model {
namespace {

TEST(Actuator, LagsExactlyAndKeepsRangeAndRate) {
  const Actuator lagging{.low = -1.0, .high = 1.0, .lag = 0.1};
  double value = 0.0;
  for (int i = 0; i < 100; ++i) value = lagging.next(value, 0.5, 0.001);
  EXPECT_NEAR(value, 0.5 * (1.0 - std::exp(-1.0)), 1e-12);  // composition of exact steps
  EXPECT_EQ(Actuator{}.next(0.0, 9.0, 0.001), 1.0);
  const Actuator slow{.low = -1.0, .high = 1.0, .lag = 0.0, .rate = 2.0};
  EXPECT_NEAR(slow.next(0.0, 1.0, 0.1), 0.2, 1e-15);
  EXPECT_NEAR(slow.next(0.0, -1.0, 0.1), -0.2, 1e-15);
}

TEST(Actuator, NeverLeavesItsRangeNorMovesWithoutTime) {
  const Actuator actuator{.low = -0.2, .high = 0.7, .lag = 0.05, .rate = 3.0};
  EXPECT_EQ(actuator.next(0.4, -5.0, 0.0), 0.4);
  double value = 0.0;
  for (int i = 0; i < 1000; ++i) {
    value = actuator.next(value, i % 200 < 100 ? 9.0 : -9.0, 0.01);
    EXPECT_LE(value, 0.7);
    EXPECT_GE(value, -0.2);
  }
}

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
