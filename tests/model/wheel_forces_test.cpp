// SPDX-License-Identifier: MIT
#include "chicane/model/wheel_forces.hpp"
#include "support/chicane_test.hpp"

namespace chicane::model {
namespace {

constexpr double kExactly = 1e-12;

/// Tyres that push against their velocity, the more the further the wheel is to the front.
WheelForces<double> damped(const VehicleParams& car, double vy, double yaw_rate, double steer) {
  const double c = std::cos(steer), s = std::sin(steer);
  return wheel_forces<double>(car.axles(), {20.0, vy}, yaw_rate, c, s, {},
                              [&](std::size_t i, const Axle&, const Planar<double>& v) {
                                const Planar<double> rolling = i < 2 ? in_turned_axes(v, c, s) : v;
                                return Planar<double>{-0.1 * rolling.x, (i < 2 ? -3.0 : -2.0) * rolling.y};
                              });
}

TEST(WheelForces, AddUpWithTheirMomentAboutTheCentreOfMass) {
  const VehicleParams car = road_car_params();
  const auto sum =
      wheel_forces<double>(car.axles(), {20.0, 1.0}, 0.5, 0.0, 1.0, {5.0, 0.0, 0.0},
                           [&](std::size_t i, const Axle& axle, const Planar<double>& v) {
                             EXPECT_NEAR(v.x, 20.0 - (i % 2 == 0 ? 0.25 : -0.25) * car.track_width, kExactly);
                             EXPECT_NEAR(v.y, 1.0 + 0.5 * axle.x, kExactly);
                             return Planar<double>{i == 1 ? 2.0 : 0.0, 0.0};
                           });
  EXPECT_NEAR(sum.x, 5.0, kExactly) << "the wheel is turned by 90 degrees";
  EXPECT_NEAR(sum.y, 2.0, kExactly);
  EXPECT_NEAR(sum.moment, 2.0 * car.front_axle, kExactly);
}

TEST(WheelForces, MirrorWhenSignsFlip) {
  const VehicleParams car = road_car_params();
  const auto left = damped(car, 0.7, 0.3, 0.1);
  const auto right = damped(car, -0.7, -0.3, -0.1);
  EXPECT_NEAR(left.x, right.x, kExactly);
  EXPECT_NEAR(left.y, -right.y, kExactly);
  EXPECT_NEAR(left.moment, -right.moment, 10.0 * kExactly);
  EXPECT_NE(left.moment, 0.0);
}

TEST(WheelForces, TorqueIsTakenAwayBetweenTwoSlips) {
  EXPECT_EQ(torque_share<Sharp>(0.05, 0.1, 0.2), 1.0);
  EXPECT_NEAR(torque_share<Sharp>(0.15, 0.1, 0.2), 0.5, kExactly);
  EXPECT_EQ(torque_share<Sharp>(0.3, 0.1, 0.2), 0.0);
  for (double slip = -0.1; slip < 0.4; slip += 0.01)
    EXPECT_NEAR(torque_share<Rounded>(slip, 0.1, 0.2), torque_share<Sharp>(slip, 0.1, 0.2), 0.011) << slip;
}

}  // namespace
}  // namespace chicane::model
