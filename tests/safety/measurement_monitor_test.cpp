// SPDX-License-Identifier: MIT
#include "chicane/safety/measurement_monitor.hpp"

#include <gtest/gtest.h>

namespace chicane::safety {
namespace {

/// Straight on along x at 20 m/s, measured each 40 ms.
model::Measurement at(int cycle) {
  model::Measurement now;
  now.time = 0.04 * cycle;
  now.x = 20.0 * now.time;
  now.speed = 20.0;
  now.waypoint_count = 6;
  return now;
}

bool is_accepted(MeasurementMonitor& monitor, const model::Measurement& now) {
  const model::Measurement& checked = monitor.check(now);
  EXPECT_EQ(checked.time, now.time);
  EXPECT_EQ(checked.waypoint_count, now.waypoint_count);
  return std::isfinite(checked.x) && std::isfinite(checked.speed);
}

TEST(MeasurementMonitor, AcceptsACarThatDrivesBrakesAndTurns) {
  MeasurementMonitor monitor;
  for (int i = 0; i < 100; ++i) {
    model::Measurement now = at(i);
    now.y = 0.5 * 9.0 * now.time * now.time;  // 0.9 g sideways
    now.speed = std::max(0.0, 20.0 - 9.0 * now.time);
    EXPECT_EQ(is_accepted(monitor, now), true) << i;
    if (now.time > 1.0) break;
  }
}

TEST(MeasurementMonitor, AcceptsACarThatStands) {
  MeasurementMonitor monitor;
  model::Measurement standing;
  for (int i = 0; i < 100; ++i) {
    standing.time = 0.04 * i;
    EXPECT_TRUE(is_accepted(monitor, standing));
  }
}

TEST(MeasurementMonitor, FindsAFrozenSensorInACarThatMoves) {
  MeasurementMonitor monitor;
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(is_accepted(monitor, at(i)));
  model::Measurement frozen = at(9);
  frozen.time = 0.04 * 10;
  EXPECT_FALSE(is_accepted(monitor, frozen)) << "0.8 m should have been driven";
  frozen.time = 0.04 * 20;
  EXPECT_FALSE(is_accepted(monitor, frozen));
  EXPECT_TRUE(is_accepted(monitor, at(21))) << "the jump from the frozen place is no jump of the car";
}

TEST(MeasurementMonitor, DisbelievesAJumpUntilItJumpsBackOrLasts) {
  MeasurementMonitor monitor;
  const auto jumped = [](int cycle) {
    model::Measurement now = at(cycle);
    now.y += 5.0;
    return now;
  };
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(is_accepted(monitor, at(i)));
  for (int i = 10; i < 20; ++i) EXPECT_FALSE(is_accepted(monitor, jumped(i))) << i;
  for (int i = 20; i < 30; ++i) EXPECT_TRUE(is_accepted(monitor, at(i))) << i;
  int believed_after = 0;
  for (int i = 30; i < 90 && believed_after == 0; ++i) {
    if (is_accepted(monitor, jumped(i))) believed_after = i - 30;
  }
  EXPECT_NEAR(0.04 * believed_after, MeasurementMonitor::kPatience, 0.1);
}

TEST(MeasurementMonitor, DisbelievesASpeedThatNoBrakingExplains) {
  MeasurementMonitor monitor;
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(is_accepted(monitor, at(i)));
  for (int i = 10; i < 20; ++i) {
    model::Measurement zero = at(i);
    zero.speed = 0.0;
    // The place cannot tell: where a car of no speed is expected, ours is 0.8 m further, less than a jump.
    EXPECT_FALSE(is_accepted(monitor, zero)) << i;
  }
  EXPECT_TRUE(is_accepted(monitor, at(20)));
}

}  // namespace
}  // namespace chicane::safety
