// SPDX-License-Identifier: MIT
#include "chicane/run/manual_drive.hpp"

#include <gtest/gtest.h>

namespace chicane::run {
namespace {

telemetry::Change say(const char* name, const char* value) { return {.name = name, .value = value}; }

model::Measurement at(double time, double speed) {
  model::Measurement now;
  now.time = time;
  now.speed = speed;
  return now;
}

TEST(ManualDrive, TakesItsThreeSettingsAndNoOther) {
  ManualDrive drive;
  EXPECT_FALSE(drive.is_on());
  EXPECT_TRUE(drive.apply(say("manual.is_on", "true")));
  EXPECT_TRUE(drive.is_on());
  EXPECT_FALSE(drive.apply(say("run.pace", "2")));
  EXPECT_TRUE(drive.is_on());
}

TEST(ManualDrive, SteersByAShareOfTheLock) {
  const model::VehicleParams car = model::road_car_params();
  ManualDrive drive;
  (void)drive.apply(say("manual.steer", "0.5"));
  EXPECT_DOUBLE_EQ(drive.wish(at(1.0, 10.0), car).steer, 0.5 * car.steer_limit);
  (void)drive.apply(say("manual.steer", "-7"));
  EXPECT_DOUBLE_EQ(drive.wish(at(1.1, 10.0), car).steer, -car.steer_limit);
  (void)drive.apply(say("manual.steer", "nonsense"));
  EXPECT_EQ(drive.wish(at(1.2, 10.0), car).steer, 0.0);
}

TEST(ManualDrive, BrakesGentlyWhenThePersonIsSilent) {
  const model::VehicleParams car = model::udacity_params();
  ManualDrive drive;
  (void)drive.apply(say("manual.throttle", "0.8"));
  EXPECT_EQ(drive.wish(at(5.0, 20.0), car).throttle, 0.8);
  EXPECT_EQ(drive.wish(at(5.9, 20.0), car).throttle, 0.8);
  const double silent = drive.wish(at(6.1, 20.0), car).throttle;
  EXPECT_LT(silent, 0.0);
  EXPECT_GT(silent, -car.brake_throttle_limit);
  EXPECT_EQ(drive.wish(at(6.2, 0.0), car).throttle, 0.0) << "at a standstill nothing is left to brake";
  (void)drive.apply(say("manual.throttle", "0.3"));
  EXPECT_EQ(drive.wish(at(6.3, 20.0), car).throttle, 0.3);
}

TEST(ManualDrive, PassesANegativePedalOnNearStandstillOnly) {
  const model::VehicleParams car = model::udacity_params();
  ManualDrive drive;
  (void)drive.apply(say("manual.throttle", "-1"));
  EXPECT_DOUBLE_EQ(drive.wish(at(1.0, 20.0), car).throttle, -car.brake_throttle_limit);
  EXPECT_EQ(drive.wish(at(1.1, 0.5), car).throttle, -1.0) << "the reverse gear";
}

TEST(ManualDrive, KeepsTheWheelInANewRunAndCountsItsTimeAnew) {
  const model::VehicleParams car = model::udacity_params();
  ManualDrive drive;
  (void)drive.apply(say("manual.is_on", "true"));
  (void)drive.apply(say("manual.throttle", "0.4"));
  (void)drive.wish(at(50.0, 10.0), car);
  drive.restart();
  EXPECT_TRUE(drive.is_on());
  EXPECT_EQ(drive.wish(at(0.5, 10.0), car).throttle, 0.4);
  EXPECT_LT(drive.wish(at(1.5, 10.0), car).throttle, 0.0);
}

}  // namespace
}  // namespace chicane::run
