// SPDX-License-Identifier: MIT
#include "chicane/ros/car_topics.hpp"

#include "chicane/ros/nodes.hpp"
#include "support/chicane_test.hpp"

namespace chicane::ros {
namespace {

const model::VehicleParams kCar = model::road_car_params();

TEST(DriveCommand, ComesBackAsThePedalThatWasMeant) {
  for (const bool by_speed : {true, false}) {
    const DriveOptions options{.is_by_speed = by_speed};
    for (const double throttle : {-0.5, -0.1, 0.0, 0.3, 0.9}) {
      const auto message = to_message(kCar, {.steer = 0.1, .throttle = throttle}, 15.0, options);
      const double wanted = by_speed ? message.speed : message.acceleration;
      EXPECT_NEAR(throttle_of(kCar, wanted, 15.0, options), throttle, 0.01) << throttle << ' ' << by_speed;
      EXPECT_EQ(message.steer, 0.1);
    }
  }
}

TEST(DriveCommand, NeverAsksForASpeedBelowZero) {
  EXPECT_EQ(to_message(kCar, {.throttle = -1.0}, 0.2, {}).speed, 0.0);
}

TEST(DriveCommand, ASpeedOfZeroBringsTheCarToRestAndDoesNotRollItBack) {
  double speed = 1.0;
  for (int i = 0; i < 400; ++i)
    speed += 0.005 * model::longitudinal_acceleration(kCar, throttle_of(kCar, 0.0, speed, {}), speed);
  EXPECT_NEAR(speed, 0.0, 0.1);
  EXPECT_LE(throttle_of(kCar, 0.0, 0.0, {}), 0.0);
}

TEST(NodeOptions, HaveTheNamesOfF1tenthGymRos) {
  const NodeOptions node;
  EXPECT_EQ(node.topics.odom, "/ego_racecar/odom");
  EXPECT_EQ(node.topics.drive, "/drive");
  EXPECT_EQ(node.frames.base, "ego_racecar/base_link");
}

}  // namespace
}  // namespace chicane::ros
