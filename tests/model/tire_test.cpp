// SPDX-License-Identifier: MIT
#include "chicane/model/wheel_forces.hpp"

#include "chicane/base/jet.hpp"
#include "chicane/base/math.hpp"
#include "support/chicane_test.hpp"

namespace chicane::model {
namespace {

constexpr double kRounding = 1e-12;  // of a handful of operations near 1

TEST(FrictionCurve, PassesThroughItsTwoPointsAndStaysAtTheAsymptote) {
  const FrictionCurve curve{0.4, 1.0, 0.8, 0.5};
  EXPECT_NEAR(curve(0.4), 1.0, kRounding);
  EXPECT_NEAR(curve(0.8), 0.5, kRounding);
  EXPECT_NEAR(curve(7.0), 0.5, kRounding);
  EXPECT_NEAR(curve(-0.4), -1.0, kRounding);
  EXPECT_EQ(curve(0.0), 0.0);
}

TEST(FrictionCurve, StartsWithTheSlopeOfItsExtremumAndIsFlatThere) {
  const FrictionCurve curve{0.2, 1.0, 0.5, 0.75};
  EXPECT_NEAR(curve(FullJet<1>::variable(0.0, 0)).slopes[0], 5.0, kRounding);
  EXPECT_NEAR(curve(FullJet<1>::variable(0.2 - 1e-9, 0)).slopes[0], 0.0,
              1e-7);  // slope changes by 20 per unit of slip
  EXPECT_NEAR(curve(FullJet<1>::variable(0.2 + 1e-9, 0)).slopes[0], 0.0, 1e-7);
  EXPECT_NEAR(curve(FullJet<1>::variable(0.5 - 1e-9, 0)).slopes[0], 0.0, 1e-7);
}

TEST(FrictionCurve, NeverExceedsItsExtremum) {
  const FrictionCurve curve{0.2, 1.0, 0.5, 0.75};
  for (double slip = -1.0; slip <= 1.0; slip += 1e-3)
    EXPECT_LE(std::fabs(curve(slip)), 1.0 + kRounding) << slip;
}

TEST(MagicFormula, HasSlopeBcdAtZeroAndPeakD) {
  const MagicFormula tire{.stiffness = 10.0, .shape = 1.5, .peak = 1.2};
  EXPECT_NEAR(tire(FullJet<1>::variable(0.0, 0)).slopes[0], 18.0, kRounding);
  EXPECT_NEAR(tire(std::tan(kPi / 3.0) / 10.0), 1.2, kRounding);  // sin = 1 where C atan(B x) = π/2
  EXPECT_LT(tire(1.0), 1.2);
}

TEST(MagicFormula, HasItsSecantWithoutAnAngle) {
  for (const double shape : {1.3, 1.5, 1.6}) {
    const MagicFormula curve{.stiffness = 1.0 / shape, .shape = shape};
    for (double slip = 1e-4; slip < 20.0; slip *= 1.3)
      EXPECT_NEAR(magic_secant(shape, slip * slip), curve(slip) / slip, 1e-15) << shape << ' ' << slip;
  }
  // Its derivatives equal the jets' of sin(C atan(x/C)) over x.
  for (double square = 1e-4; square < 400.0; square *= 1.7) {
    const auto x2 = FullJet<1, 2>::variable(square, 0);
    const auto by_rules = sin(1.5 * atan(sqrt(x2) / 1.5)) / sqrt(x2);
    const auto secant = magic_secant(1.5, x2);
    EXPECT_NEAR(secant.slopes[0], by_rules.slopes[0], 1e-11) << square;
    EXPECT_NEAR(secant.curvatures[0] / by_rules.curvatures[0], 1.0, 1e-5) << square;
  }
}

TEST(TireCurves, AreOddAndJetsGiveTheirSlope) {
  const FrictionCurve curve;
  const MagicFormula magic{.stiffness = 9.0, .shape = 1.4, .peak = 1.1, .curvature = -0.5};
  const auto check = [](const auto& f) {
    constexpr double kStep = 1e-6;
    for (double x : {-2.0, -0.7, -0.31, -0.05, 0.013, 0.12, 0.33, 0.49, 1.3}) {
      EXPECT_NEAR(f(-x), -f(x), kRounding) << x;
      const double difference = (f(x + kStep) - f(x - kStep)) / (2.0 * kStep);
      EXPECT_NEAR(f(FullJet<1>::variable(x, 0)).slopes[0], difference, 1e-7)
          << x;  // kStep² · third derivative
    }
  };
  check([&](const auto& x) { return curve(x); });
  check([&](const auto& x) { return magic(x); });
}

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
