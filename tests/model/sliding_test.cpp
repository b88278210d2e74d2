// SPDX-License-Identifier: MIT
#include "chicane/model/stability.hpp"

#include "chicane/base/jet.hpp"
#include "chicane/model/prediction.hpp"
#include "support/chicane_test.hpp"

namespace chicane::model {
namespace {

VehicleParams without_helper() {
  VehicleParams car = udacity_params();
  car.steer_helper = 0.0;
  return car;
}

/// The right-most pole of the prediction model where its axles have these slips, by differences.
double pole_of_model(const VehicleParams& car, double v, double front_slip, double rear_slip) {
  const PredictionModel model(car);
  const double speed = std::hypot(v, PredictionModel::kSpeedFloor);
  const double vy = -rear_slip * car.friction / car.cornering_rear * speed;  // turns left, tail out
  const double steer = front_slip * car.friction / car.cornering_front + vy / speed;
  constexpr double kStep = 1e-5;
  const auto slope = [&](double dvy, double dr) {
    const auto up = model.change(BodyMotion<double>{v, vy + dvy, dr, steer, 0.0});
    const auto down = model.change(BodyMotion<double>{v, vy - dvy, -dr, steer, 0.0});
    return std::pair{(up.vy - down.vy) / (2.0 * kStep), (up.r - down.r) / (2.0 * kStep)};
  };
  const auto [a11, a21] = slope(kStep, 0.0);
  const auto [a12, a22] = slope(0.0, kStep);
  const double half = 0.5 * (a11 + a22);
  return half + std::sqrt(std::max(half * half - (a11 * a22 - a12 * a21), 0.0));
}

TEST(SlidingBound, HasThePolesOfThePredictionModel) {
  for (const VehicleParams& car : {udacity_params(), without_helper()}) {
    const SlidingBound bound(car);
    for (const double v : {10.0, 20.0, 40.0})
      for (const double front : {0.0, 0.4, 0.8})
        for (const double rear : {1.1, 1.5, 1.75, 2.2})
          // The model's slips count with sqrt(v² + 1).
          EXPECT_NEAR(bound.pole(v, front, rear), pole_of_model(car, v, front, rear), 0.03)
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

}  // namespace
}  // namespace chicane::model
