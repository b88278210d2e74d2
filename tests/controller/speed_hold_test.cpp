// SPDX-License-Identifier: MIT
#include "chicane/controller/speed_hold.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "chicane/base/angle.hpp"

namespace chicane::controller {
namespace {

constexpr double kBendRadius = 30.0;

/// 200 m straight on along x, then half a circle to the left.
road::Path road() {
  std::vector<Vec2> points;
  for (int i = 0; i < 40; ++i) points.emplace_back(5.0 * i, 0.0);
  for (int i = 0; i <= 40; ++i) {
    const double angle = kPi * i / 40.0;
    points.emplace_back(200.0 + kBendRadius * std::sin(angle), kBendRadius * (1.0 - std::cos(angle)));
  }
  return road::Path::create(points, false).value();
}

const SpeedHold kHold{{.speed_reference = 25.0, .speed_gain = 0.3, .lateral_acceleration_limit = 6.0},
                      model::udacity_params()};

TEST(SpeedHold, AsksForTheReferenceUntilABendHasToBeBrakedFor) {
  const road::Path path = road();
  EXPECT_EQ(kHold.reference(path, 0.0).speed, 25.0);
  EXPECT_EQ(kHold.reference(path, 0.0).limiter, SpeedLimiter::kAsked);
  const SpeedHold::Wanted before = kHold.reference(path, 180.0);
  EXPECT_EQ(before.limiter, SpeedLimiter::kBraking);
  EXPECT_LT(before.speed, 20.0);
  const SpeedHold::Wanted within = kHold.reference(path, 240.0);
  EXPECT_LE(within.speed, before.speed);
  // v² κ = 6 m/s² where the spline has the circle's curvature within 2 %.
  EXPECT_NEAR(within.speed, std::sqrt(6.0 * kBendRadius), 0.02 * std::sqrt(6.0 * kBendRadius));
}

TEST(SpeedHold, HoldsASpeedAgainstDragAndActsAgainstAnError) {
  const model::VehicleParams car = model::udacity_params();
  const double holding = kHold.throttle(20.0, 20.0);
  EXPECT_NEAR(model::longitudinal_acceleration(car, holding, 20.0), 0.0, 1e-9);
  EXPECT_NEAR(kHold.throttle(21.0, 20.0), holding + 0.3, 1e-9);
  EXPECT_EQ(kHold.throttle(60.0, 20.0), 1.0);
  EXPECT_EQ(kHold.throttle(0.0, 20.0), -car.brake_throttle_limit);
}

}  // namespace
}  // namespace chicane::controller
