// SPDX-License-Identifier: MIT
#include "chicane/safety/arrival_watch.hpp"

#include <gtest/gtest.h>

namespace chicane::safety {
namespace {

TEST(ArrivalWatch, LetsCommandsThroughWhileTheyCome) {
  ArrivalWatch watch(0.04);
  watch.arrived(0.1);
  const model::Command command = watch.guard({0.2, 0.7}, 0.34, 30.0, 0.5);
  EXPECT_EQ(command.steer, 0.2);
  EXPECT_EQ(command.throttle, 0.7);
}

TEST(ArrivalWatch, BrakesWithTheWheelWhereItIsAfterAQuarterOfASecond) {
  ArrivalWatch watch(0.04);
  watch.arrived(0.1);
  const model::Command command = watch.guard({0.2, 0.7}, 0.36, 30.0, 0.5);
  EXPECT_EQ(command.steer, 0.2);
  EXPECT_EQ(command.throttle, -0.5);
  EXPECT_EQ(watch.guard({0.2, 0.7}, 0.36, 0.0, 0.5).throttle, 0.0) << "a car that stands does not back up";
  watch.arrived(0.5);
  EXPECT_EQ(watch.guard({0.2, 0.7}, 0.51, 30.0, 0.5).throttle, 0.7);
}

TEST(ArrivalWatch, WaitsThreePeriodsWhereTheyAreLong) {
  ArrivalWatch watch(0.2);
  watch.arrived(1.0);
  EXPECT_FALSE(watch.is_silent(1.55));
  EXPECT_TRUE(watch.is_silent(1.65));
}

}  // namespace
}  // namespace chicane::safety
