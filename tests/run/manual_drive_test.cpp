// SPDX-License-Identifier: MIT
#include "chicane/run/manual_drive.hpp"

#include <gtest/gtest.h>

namespace chicane::run {
namespace {

using What = ManualSetting::What;

model::Measurement at(double time, double speed) {
  model::Measurement now;
  now.time = time;
  now.speed = speed;
  return now;
}

TEST(ManualDrive, IsOffUntilItIsSwitchedOn) {
  ManualDrive drive;
  EXPECT_FALSE(drive.is_on());
  drive.set({What::kThrottle, 0.5});
  EXPECT_FALSE(drive.is_on());
  drive.set({What::kIsOn, 1.0});
  EXPECT_TRUE(drive.is_on());
  drive.set({What::kIsOn, 0.0});
  EXPECT_FALSE(drive.is_on());
}

TEST(ManualDrive, SteersByAShareOfTheLock) {
  const model::VehicleParams car = model::road_car_params();
  ManualDrive drive;
  drive.set({What::kSteer, 0.5});
  EXPECT_DOUBLE_EQ(drive.command(at(1.0, 10.0), car).steer, 0.5 * car.steer_limit);
  drive.set({What::kSteer, -1.0});
  EXPECT_DOUBLE_EQ(drive.command(at(1.1, 10.0), car).steer, -car.steer_limit);
}

TEST(ManualDrive, BrakesGentlyWhenThePersonIsSilent) {
  const model::VehicleParams car = model::udacity_params();
  ManualDrive drive;
  drive.set({What::kThrottle, 0.8});
  EXPECT_EQ(drive.command(at(5.0, 20.0), car).throttle, 0.8);
  EXPECT_EQ(drive.command(at(5.9, 20.0), car).throttle, 0.8);
  const double silent = drive.command(at(6.1, 20.0), car).throttle;
  EXPECT_LT(silent, 0.0);
  EXPECT_GT(silent, -car.brake_throttle_limit);
  EXPECT_EQ(drive.command(at(6.2, 0.0), car).throttle, 0.0) << "at a standstill nothing is left to brake";
  drive.set({What::kThrottle, 0.3});
  EXPECT_EQ(drive.command(at(6.3, 20.0), car).throttle, 0.3);
}

TEST(ManualDrive, PassesANegativePedalOnNearStandstillOnly) {
  const model::VehicleParams car = model::udacity_params();
  ManualDrive drive;
  drive.set({What::kThrottle, -1.0});
  EXPECT_DOUBLE_EQ(drive.command(at(1.0, 20.0), car).throttle, -car.brake_throttle_limit);
  EXPECT_EQ(drive.command(at(1.1, 0.5), car).throttle, -1.0) << "the reverse gear";
}

TEST(ManualDrive, KeepsTheWheelInANewRunAndCountsItsTimeAnew) {
  const model::VehicleParams car = model::udacity_params();
  ManualDrive drive;
  drive.set({What::kIsOn, 1.0});
  drive.set({What::kThrottle, 0.4});
  (void)drive.command(at(50.0, 10.0), car);
  drive.restart();
  EXPECT_TRUE(drive.is_on());
  EXPECT_EQ(drive.command(at(0.5, 10.0), car).throttle, 0.4);
  EXPECT_LT(drive.command(at(1.5, 10.0), car).throttle, 0.0);
}

}  // namespace
}  // namespace chicane::run
