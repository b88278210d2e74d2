// SPDX-License-Identifier: MIT
#include "chicane/safety/stop_player.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace chicane::safety {
namespace {

constexpr double kCycle = 0.04;

/// From 20 m/s at 8 m/s², turning the wheel as it goes.
StopPlan sample_stop(double begins, double side = 1.0) {
  StopPlan stop;
  for (int i = 0; i <= 25; ++i) {
    const double t = 0.1 * i;
    stop.points[static_cast<std::size_t>(stop.size++)] = {.time = begins + t,
                                                          .distance = 20.0 * t - 4.0 * t * t,
                                                          .speed = 20.0 - 8.0 * t,
                                                          .command = {side * 0.01 * i, -0.8}};
  }
  return stop;
}

model::VehicleParams car() { return model::road_car_params(); }

TEST(StopPlayer, LetsCommandsThroughWhileTheyCome) {
  StopPlayer player(car(), kCycle, Receiver::kStopPlan);
  for (int i = 0; i < 100; ++i) {
    const double time = kCycle * i;
    player.arrived(time, sample_stop(time + 0.1));
    const model::Command command = player.guard({0.2, 0.7}, time + 0.03, 30.0);
    EXPECT_EQ(command.steer, 0.2);
    EXPECT_EQ(command.throttle, 0.7);
    EXPECT_FALSE(player.is_stopping());
  }
}

TEST(StopPlayer, DrivesTheStopByTheDistanceWhenNothingComes) {
  for (const double side : {1.0, -1.0}) {
    StopPlayer player(car(), kCycle, Receiver::kStopPlan);
    player.arrived(1.0, sample_stop(1.1, side));
    EXPECT_EQ(player.guard({0.0, 0.5}, 1.1, 20.0).throttle, 0.5) << "not before the stop begins";
    double speed = 20.0;
    double distance = 0.0;
    model::Command command;
    for (double time = 1.105; speed > 0.05 && time < 10.0; time += 0.005) {
      command = player.guard({0.0, 0.5}, time, speed);
      EXPECT_TRUE(player.is_stopping());
      EXPECT_LE(command.throttle, 0.0);
      speed += 0.005 * longitudinal_acceleration(car(), command.throttle, speed);
      distance += 0.005 * speed;
    }
    EXPECT_LT(speed, 0.06);
    EXPECT_NEAR(distance, 25.0, 1.5);
    EXPECT_NEAR(command.steer, side * 0.2, 0.06);
  }
}

/// As planned, the wheel is held from one place to the next: a receiver that turned it earlier would leave
/// the planned course by half a degree.
TEST(StopPlayer, HoldsTheWheelFromOnePlaceToTheNext) {
  const StopPlan stop = sample_stop(0.0);
  const auto steer = [&](double distance) { return played(stop, distance, 15.0, car()).steer; };
  const StopPoint& fifth = stop.points[5];
  EXPECT_EQ(steer(fifth.distance), fifth.command.steer);
  EXPECT_EQ(steer(stop.points[6].distance - 0.01), fifth.command.steer);
}

/// Between two looks at the clock the car has driven on: what was driven since the stop began counts.
TEST(StopPlayer, CountsTheWayFromWhereTheStopBegan) {
  StopPlayer player(car(), kCycle, Receiver::kStopPlan);
  player.arrived(1.0, sample_stop(1.1));
  static_cast<void>(player.guard({0.0, 0.5}, 1.09, 20.0));
  const StopPlan stop = sample_stop(1.1);
  const StopPoint& third = stop.points[3];
  EXPECT_EQ(player.guard({0.0, 0.5}, 1.1 + third.distance / 20.0 + 1e-6, 20.0).steer, third.command.steer);
}

TEST(StopPlayer, KeepsTheStopsThatWaitForTheirCommands) {
  StopPlayer player(car(), kCycle, Receiver::kStopPlan);
  for (int i = 0; i < 5; ++i) player.arrived(1.0 + kCycle * i, sample_stop(1.1 + kCycle * i));  // in flight
  EXPECT_EQ(player.guard({0.1, 0.5}, 1.15, 20.0).throttle, 0.5) << "a later command acts already";
  static_cast<void>(player.guard({0.1, 0.5}, 1.27, 20.0));
  EXPECT_TRUE(player.is_stopping());
  player.arrived(1.4, sample_stop(1.5));
  EXPECT_EQ(player.guard({0.1, 0.5}, 1.41, 20.0).throttle, 0.5) << "commands come again";
}

TEST(StopPlayer, BrakesWithTheLastSteeringWithoutAStop) {
  for (const Receiver receiver : {Receiver::kStopPlan, Receiver::kBrake}) {
    StopPlayer player(car(), kCycle, receiver);
    player.arrived(1.0, {});
    EXPECT_EQ(player.guard({0.2, 0.5}, 1.2, 20.0).throttle, 0.5);
    const model::Command command = player.guard({0.2, 0.5}, 1.3, 20.0);
    EXPECT_EQ(command.steer, 0.2);
    EXPECT_NEAR(command.throttle, -1.0, 1e-9);
    EXPECT_EQ(player.guard({0.2, 0.5}, 9.0, 0.0).throttle, 0.0) << "a car that stands does not back up";
  }
}

TEST(StopPlayer, WaitsThreePeriodsWhereTheyAreLong) {
  StopPlayer player(car(), 0.2, Receiver::kBrake);
  player.arrived(1.0, {});
  EXPECT_EQ(player.guard({0.0, 0.5}, 1.55, 20.0).throttle, 0.5);
  EXPECT_LT(player.guard({0.0, 0.5}, 1.65, 20.0).throttle, 0.0);
}

TEST(StopPlayer, HoldsTheLastCommandForEverAsTheOriginal) {
  StopPlayer player(car(), kCycle, Receiver::kHold);
  player.arrived(1.0, sample_stop(1.1));
  EXPECT_EQ(player.guard({0.2, 0.5}, 100.0, 20.0).throttle, 0.5);
}

TEST(StopPlayer, BrakesWhenNoCommandEverCame) {
  StopPlayer player(car(), kCycle, Receiver::kStopPlan);
  EXPECT_EQ(player.guard({}, 0.1, 10.0).throttle, 0.0);
  EXPECT_LT(player.guard({}, 0.3, 10.0).throttle, 0.0);
}

}  // namespace
}  // namespace chicane::safety
