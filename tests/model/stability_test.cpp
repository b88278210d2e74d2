// SPDX-License-Identifier: MIT
#include "chicane/model/stability.hpp"

#include "chicane/base/jet.hpp"
#include "chicane/model/prediction.hpp"
#include "support/chicane_test.hpp"

namespace chicane::model {
namespace {

/// A tall car whose brakes and centre of mass ask much of the rear axle: as data/cars/vw-vanagon.yaml.
VehicleParams van() {
  VehicleParams car = road_car_params();
  car.mass = 1479.0;
  car.yaw_inertia = 2473.0;
  car.front_axle = 1.15;
  car.rear_axle = 1.32;
  car.height = 0.75;
  car.brake_share_front = 0.64;
  car.friction = 1.05;
  car.tire_shape = 1.35;
  car.load_sensitivity = 0.05;
  car.cornering_front = 18.9;
  car.cornering_rear = 20.9;
  return car;
}

/// The right-most pole of the model that controllers predict with about a motion, by differences.
double pole_of_model(const VehicleParams& car, const BodyMotion<double>& at) {
  const PredictionModel model(car);
  const auto change = [&](double vy, double r) {
    return model.change(BodyMotion<double>{at.vx, at.vy + vy, at.r + r, at.steer, at.acceleration});
  };
  constexpr double kStep = 1e-5;
  const auto slope = [&](double vy, double r) {
    const auto up = change(vy, r);
    const auto down = change(-vy, -r);
    return std::pair{(up.vy - down.vy) / (2.0 * kStep), (up.r - down.r) / (2.0 * kStep)};
  };
  const auto [a11, a21] = slope(kStep, 0.0);
  const auto [a12, a22] = slope(0.0, kStep);
  const double half = 0.5 * (a11 + a22);
  return half + std::sqrt(std::max(half * half - (a11 * a22 - a12 * a21), 0.0));
}

TEST(BrakingStability, HasThePolesOfThePredictionModelOnAStraight) {
  for (VehicleParams car : {road_car_params(), van()}) {
    car.drag_quadratic = 0.0;  // the bound does not count the load that the air's force moves
    const BrakingStability stability(car);
    for (const double v : {15.0, 30.0, 50.0}) {
      for (const double force : {0.0, 2.0, 4.0, 6.0}) {
        const double expected = pole_of_model(car, {.vx = v, .acceleration = -force});
        // The model's wheels share an axle's load, and the friction here is the cornering car's, 3 % less:
        // near the rear axle's peak, 6 m/s² for the van, slopes are small differences.
        EXPECT_NEAR(stability.pole(v, 0.0, force), expected, std::max(0.2 * std::fabs(expected), 0.25))
            << car.mass << " kg, " << v << " m/s, " << force << " m/s²";
      }
    }
  }
}

TEST(BrakingStability, AllowsTheForceAtWhichThePoleIsWhatIsLeftToTheController) {
  const VehicleParams car = van();
  const BrakingStability stability(car);
  for (const double v : {32.0, 40.0, 56.0}) {  // rows of the table
    for (const double use : {0.0, 0.25, 0.5, 0.75}) {
      const double most = stability.most_braking(v, use);
      EXPECT_LE(stability.pole(v, use, most), BrakingStability::kMostPole) << v << ' ' << use;
      // A bisection of 10 m/s² in eight turns leaves 0.04.
      EXPECT_GT(stability.pole(v, use, most + 0.05), BrakingStability::kMostPole) << v << ' ' << use;
    }
  }
}

TEST(BrakingStability, BrakesLessTheFasterTheCarIsAndTheMoreItTurns) {
  const BrakingStability stability(van());
  for (double v = 24.0; v < 60.0; v += 4.0)
    for (double use = 0.0; use < 0.95; use += 0.05) {
      EXPECT_LE(stability.most_braking(v + 4.0, use), stability.most_braking(v, use) + 0.05)
          << v << ' ' << use;
      EXPECT_LE(stability.most_braking(v, use + 0.05), stability.most_braking(v, use) + 0.05)
          << v << ' ' << use;
    }
  EXPECT_LT(stability.most_braking(50.0, 0.9), 0.5);
  EXPECT_GT(stability.most_braking(15.0, 0.0), 6.0);
}

TEST(BrakingStability, DoesNotBrakeWhereTheRearAxleIsUsedUp) {
  const BrakingStability stability(van());
  for (const double v : {10.0, 30.0, 60.0}) {
    EXPECT_TRUE(std::isinf(stability.pole(v, 1.0, 1.0))) << v;
    EXPECT_TRUE(std::isinf(stability.pole(v, 0.5, 9.0))) << v;
    EXPECT_EQ(stability.most_braking(v, 1.0), 0.0) << v;
  }
}

TEST(BrakingStability, LeavesTyresAloneThatDoNotShareForce) {
  EXPECT_EQ(BrakingStability(udacity_params()).most_braking(40.0, 0.9),
            std::numeric_limits<double>::infinity());
}

TEST(BrakingStability, AllowsMoreForceWhereMoreIsLeftToTheController) {
  const BrakingStability careful(van());
  const BrakingStability bold(van(), 4.0);
  EXPECT_GT(bold.most_braking(40.0, 0.5), careful.most_braking(40.0, 0.5) + 0.1);
}

TEST(BrakingStability, HasASmoothFormThroughTheSameValues) {
  const BrakingStability stability(van());
  for (const double v : {8.0, 24.0, 48.0, 80.0, 96.0})
    for (const double use : {0.0, 0.25, 0.5, 0.75, 1.0})
      EXPECT_NEAR(stability.smooth_most_braking(v, use), stability.most_braking(v, use), 1e-9)
          << v << ' ' << use;
  constexpr double kStep = 1e-6;
  const auto slope = [&](double v, double use) {
    return (stability.smooth_most_braking(v + kStep, use) - stability.smooth_most_braking(v - kStep, use)) /
           (2.0 * kStep);
  };
  for (const double v : {16.0, 32.0, 56.0})
    EXPECT_NEAR(slope(v - 1e-4, 0.3), slope(v + 1e-4, 0.3), 1e-3) << v;
}

VehicleParams without_helper() {
  VehicleParams car = udacity_params();
  car.steer_helper = 0.0;
  return car;
}

/// The same where the axles have these slips.
double pole_of_slips(const VehicleParams& car, double v, double front_slip, double rear_slip) {
  const double speed = std::hypot(v, PredictionModel::kSpeedFloor);
  const double vy = -rear_slip * car.friction / car.cornering_rear * speed;  // turns left, tail out
  const double steer = front_slip * car.friction / car.cornering_front + vy / speed;
  return pole_of_model(car, {.vx = v, .vy = vy, .steer = steer});
}
TEST(SlidingBound, HasThePolesOfThePredictionModel) {
  for (const VehicleParams& car : {udacity_params(), without_helper()}) {
    const SlidingBound bound(car);
    for (const double v : {10.0, 20.0, 40.0})
      for (const double front : {0.0, 0.4, 0.8})
        for (const double rear : {1.1, 1.5, 1.75, 2.2})
          // The model's slips count with sqrt(v² + 1).
          EXPECT_NEAR(bound.pole(v, front, rear), pole_of_slips(car, v, front, rear), 0.03)
              << car.steer_helper << ' ' << v << ' ' << front << ' ' << rear;
  }
}

TEST(SlidingBound, LetsTheRearSlideWhereErrorsGrowLittleWithinTheDelay) {
  const SlidingBound bound(udacity_params());
  ASSERT_TRUE(bound.permits());
  const double most = std::log(SlidingBound::kMostGrowth) / SlidingBound::kAssumedDelay;
  for (const double v : {5.0, 10.0, 30.0, 55.0}) {
    const double slip = bound.rear(v);
    EXPECT_GE(slip, 1.0);
    EXPECT_LE(slip, SlidingBound::kMostSlip + 0.01);
    for (double front = 0.0; front <= bound.front(); front += 0.1)
      EXPECT_LE(bound.pole(v, front, slip), most + 1e-9) << v << " m/s";
  }
  EXPECT_NEAR(bound.rear(25.0), SlidingBound::kMostSlip, 0.01);
  EXPECT_LT(bound.rear(5.0), 1.5) << "slow, a loss of rear force turns the car faster";
  EXPECT_EQ(bound.most_rear(), bound.rear(25.0));
}

TEST(SlidingBound, KeepsHalfTheSlopeOfTheFrontTyres) {
  // 1 + 2 z - 3 z² = 1/2
  EXPECT_NEAR(SlidingBound(udacity_params()).front(), (2.0 + std::sqrt(10.0)) / 6.0, 0.01);
}

TEST(SlidingBound, PermitsNothingWithoutAHelperWithCoupledTyresOrALongDelay) {
  EXPECT_FALSE(SlidingBound(without_helper()).permits());
  EXPECT_FALSE(SlidingBound(road_car_params()).permits());
  EXPECT_FALSE(SlidingBound(udacity_params(), 0.3).permits());
  EXPECT_LT(SlidingBound(udacity_params(), 0.16).rear(40.0), SlidingBound(udacity_params()).rear(40.0));
}

TEST(SlidingBound, KnowsTheLongestDelayThatPermitsASlide) {
  const double longest = SlidingBound::longest_delay(udacity_params());
  EXPECT_GT(longest, SlidingBound::kAssumedDelay);
  EXPECT_TRUE(SlidingBound(udacity_params(), longest - 1e-4).permits());
  EXPECT_FALSE(SlidingBound(udacity_params(), longest + 1e-4).permits());
  EXPECT_EQ(SlidingBound::longest_delay(road_car_params()), 0.0);
}

TEST(SlidingBound, HasContinuousSlopes) {
  const SlidingBound bound(udacity_params());
  for (double v = 2.5; v < 70.0; v += 2.5) {
    const auto at = bound.rear(FullJet<1>::variable(v, 0));
    const double step = 1e-5;
    EXPECT_NEAR(at.slopes[0], (bound.rear(v + step) - bound.rear(v - step)) / (2.0 * step), 0.02) << v;
  }
}

TEST(SlidingBound, CountsForSlowBendsAlone) {
  EXPECT_EQ(SlidingBound::share(20.0), 1.0);
  EXPECT_EQ(SlidingBound::share(42.0), 1.0);
  EXPECT_DOUBLE_EQ(SlidingBound::share(44.5), 0.5);
  EXPECT_EQ(SlidingBound::share(47.0), 0.0);
  EXPECT_EQ(SlidingBound::share(52.0), 0.0);
}

/// Slopes with which the front axle has `share` of the car's stiffness times its distance to the other.
AxleSlopes slopes(const VehicleParams& car, double share) {
  return {160.0 * share / car.front_axle, 160.0 * (1.0 - share) / car.rear_axle};
}

TEST(YawStability, FallsWithSpeedAndWithAWeakRearAxle) {
  const VehicleParams car = road_car_params();
  EXPECT_LT(static_instability(car, 30.0, slopes(car, 0.4)), 0.0) << "it understeers";
  EXPECT_GT(static_instability(car, 40.0, slopes(car, 0.6)), static_instability(car, 20.0, slopes(car, 0.6)));
  EXPECT_EQ(static_instability(car, 20.0, {50.0, 0.0}), std::numeric_limits<double>::infinity());
  EXPECT_EQ(static_instability(car, 20.0, {0.0, 50.0}), -1.0);
}

TEST(YawStability, ThePoleIsPositiveWhereTheCarIsStaticallyUnstable) {
  const VehicleParams car = road_car_params();
  for (const double v : {10.0, 20.0, 30.0, 45.0})
    for (double share = 0.3; share < 0.95; share += 0.05)
      EXPECT_EQ(yaw_pole(car, v, slopes(car, share)) > 0.0,
                static_instability(car, v, slopes(car, share)) > 1.0)
          << v << ' ' << share;
}

}  // namespace
}  // namespace chicane::model
