// SPDX-License-Identifier: MIT
#include "chicane/controller/roll_forward.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "chicane/base/angle.hpp"

namespace chicane::controller {
namespace {

constexpr double kLength = 2.67;

/// Heading along W's y at 20 m/s, wheel 0.1 rad to the left, half throttle.
model::Measurement moving() {
  model::Measurement now;
  now.x = 3.0;
  now.y = 4.0;
  now.psi = 0.5 * kPi;
  now.speed = 20.0;
  now.steer = 0.1;
  now.throttle = 0.5;
  now.delay = 0.14;
  return now;
}

Motion predict(LatencyHandling handling, const model::Measurement& now) {
  RollForward roll{handling, 0.1, kLength};
  return roll.predict(now);
}

TEST(RollForward, LeavesTheMeasurementAloneWithoutCompensationAndInsideTheModel) {
  for (const auto handling : {LatencyHandling::kNone, LatencyHandling::kInsideModel}) {
    RollForward roll{handling, 0.1, kLength};
    const Motion start = roll.predict(moving());
    EXPECT_EQ(start.pose.x, 3.0);
    EXPECT_EQ(start.pose.y, 4.0);
    EXPECT_EQ(start.pose.psi, 0.5 * kPi);
    EXPECT_EQ(start.speed, 20.0);
    EXPECT_EQ(roll.compensated(), 0.0);
  }
}

TEST(RollForward, MovesOnlyThePositionWhenAskedTo) {
  const Motion start = predict(LatencyHandling::kPositionOnly, moving());
  EXPECT_NEAR(start.pose.x, 3.0, 1e-12);
  EXPECT_NEAR(start.pose.y, 6.0, 1e-12);
  EXPECT_EQ(start.pose.psi, 0.5 * kPi);
  EXPECT_EQ(start.speed, 20.0);
}

TEST(RollForward, MovesTheWholeKinematicState) {
  const Motion start = predict(LatencyHandling::kRollForward, moving());
  EXPECT_NEAR(start.pose.y, 6.0, 1e-12);
  EXPECT_NEAR(start.pose.psi, 0.5 * kPi + 20.0 * 0.1 / kLength * 0.1, 1e-12);
  EXPECT_NEAR(start.speed, 20.05, 1e-12);
}

TEST(RollForward, AveragesTheMeasuredLatencyWithTheValueBefore) {
  RollForward roll{LatencyHandling::kMeasured, 0.1, kLength};
  const Motion start = roll.predict(moving());
  const double latency = 0.5 * (0.1 + 0.14);
  EXPECT_DOUBLE_EQ(roll.compensated(), latency);
  const double curvature = std::tan(0.1) / kLength;
  EXPECT_NEAR(start.pose.y, 4.0 + 20.0 * latency, 1e-12);
  EXPECT_NEAR(start.pose.psi,
              0.5 * kPi + 20.0 * curvature * latency + 0.5 * 0.5 * curvature * latency * latency, 1e-12);
  EXPECT_NEAR(start.speed, 20.0 + 0.5 * latency, 1e-12);
  (void)roll.predict(moving());
  EXPECT_DOUBLE_EQ(roll.compensated(), 0.5 * (latency + 0.14));
  roll.reset();
  EXPECT_DOUBLE_EQ(roll.compensated(), 0.1);
}

TEST(RollForward, LeavesOutTheTermOfTheAccelerationWhenAskedTo) {
  RollForward with{LatencyHandling::kMeasured, 0.1, kLength};
  RollForward without{LatencyHandling::kMeasured, 0.1, kLength, 1.0, false};
  const double latency = 0.5 * (0.1 + 0.14);
  const double term = 0.5 * 0.5 * std::tan(0.1) / kLength * latency * latency;
  EXPECT_NEAR(with.predict(moving()).pose.psi - without.predict(moving()).pose.psi, term, 1e-14);
  EXPECT_GT(term, 1e-4);
}

TEST(RollForward, BelievesNoImpossibleLatency) {
  RollForward roll{LatencyHandling::kMeasured, 0.1, kLength};
  model::Measurement now = moving();
  for (const double delay :
       {std::numeric_limits<double>::quiet_NaN(), 1e9, -1e9, std::numeric_limits<double>::infinity()}) {
    now.delay = delay;
    (void)roll.predict(now);
    EXPECT_GE(roll.compensated(), 0.0);
    EXPECT_LE(roll.compensated(), 0.5);
  }
}

TEST(RollForward, MirrorsWithTheWheel) {
  model::Measurement left = moving();
  left.psi = 0.0;
  model::Measurement right = left;
  right.steer = -left.steer;
  for (const auto handling : {LatencyHandling::kRollForward, LatencyHandling::kMeasured}) {
    EXPECT_EQ(predict(handling, left).pose.psi, -predict(handling, right).pose.psi);
  }
}

TEST(RollForward, MilesPerHourTakeTheCarAsMuchFarther) {
  model::Measurement now;
  now.speed = 10.0;
  now.psi = 0.3;
  now.steer = 0.05;
  RollForward literal(LatencyHandling::kPositionOnly, 0.1, 2.67, 2.25);
  RollForward longer(LatencyHandling::kPositionOnly, 0.225, 2.67);
  const Motion a = literal.predict(now);
  const Motion b = longer.predict(now);
  EXPECT_NEAR(a.pose.x, b.pose.x, 1e-12);
  EXPECT_NEAR(a.pose.y, b.pose.y, 1e-12);
  EXPECT_NEAR(a.speed, 10.0, 1e-12);  // told in m/s again
  RollForward inside(LatencyHandling::kInsideModel, 0.1, 2.67, 2.25);
  EXPECT_EQ(inside.predict(now).speed, 10.0);
}

}  // namespace
}  // namespace chicane::controller
