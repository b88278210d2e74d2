// SPDX-License-Identifier: MIT
#include "chicane/sim/road_car.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "chicane/base/angle.hpp"
#include "sim/plant_experiment.hpp"

namespace chicane::sim {
namespace {

TEST(RoadCar, CornersAtAboutOneGAndNoMore) {
  RoadCar car;
  const double peak = experiment::peak_cornering(car, 20.0).lateral_acceleration / 9.81;
  EXPECT_GT(peak, 0.98);
  EXPECT_LT(peak, 1.20);  // the tyre's 1.2, less load transfer
}

TEST(RoadCar, AcceleratesLikeTwoHundredKilowatts) {
  RoadCar car;
  const auto run = experiment::drive_straight(car, 1.0, 60.0);
  EXPECT_NEAR(experiment::time_to(run, 100.0 / 3.6), 5.5, 0.4);
  for (const auto& [v, a] : experiment::accelerations(run, 1.0)) {
    EXPECT_LE(a * v, 200.0e3 / 1300.0) << v;
  }
  EXPECT_GT(run.back().speed, 65.0);
}

TEST(RoadCar, BrakesInProportionWithoutLocking) {
  RoadCar car;
  const double full = experiment::braking_at(car, -1.0, 20.0);
  const double half = experiment::braking_at(car, -0.5, 20.0);
  EXPECT_LT(full, -8.5);
  EXPECT_GT(full, -10.5);
  const double drag = experiment::braking_at(car, 0.0, 20.0);
  EXPECT_NEAR(half - drag, 0.5 * (full - drag), 0.15);
}

TEST(RoadCar, StopsAndStaysStopped) {
  RoadCar car;
  car.reset({}, 10.0);
  experiment::drive_straight(car, -1.0, 4.0);
  EXPECT_LT(car.output().speed, 1e-3);
  const double x = car.state().x;
  experiment::drive_straight(car, -1.0, 5.0);
  EXPECT_NEAR(car.state().x, x, 1e-3);
}

TEST(RoadCar, SteersNoFasterThanNinetyDegreesASecond) {
  RoadCar car;
  car.reset({}, 10.0);
  double before = 0.0;
  for (int i = 0; i < 500; ++i) {
    car.advance({.steer = i < 250 ? 0.43 : -0.43, .throttle = 0.0});
    EXPECT_LE(std::fabs(car.state().steer - before), degrees_to_radians(90.0) * 0.001 + 1e-12);
    before = car.state().steer;
  }
}

TEST(RoadCar, SteeringLagsByFiftyMilliseconds) {
  RoadCar car;
  for (int i = 0; i < 50; ++i) car.advance({.steer = 0.02, .throttle = 0.0});
  EXPECT_NEAR(car.state().steer, 0.02 * (1.0 - std::exp(-1.0)), 1e-9);
}

TEST(RoadCar, Understeers) {
  RoadCar car;
  const double slow = experiment::steady_circle(car, 0.02, 5.0).curvature;
  const double fast = experiment::steady_circle(car, 0.02, 25.0).curvature;
  EXPECT_LT(fast, 0.95 * slow);
  EXPECT_NEAR(slow, 0.02 / 2.70, 0.02 * 0.02 / 2.70);
}

TEST(RoadCar, BrakingInATurnTakesGripFromCornering) {
  RoadCar turning;
  turning.reset({}, 25.0);
  RoadCar braking;
  braking.reset({}, 25.0);
  double most_turning = 0.0;
  double most_braking = 0.0;
  for (int i = 0; i < 1200; ++i) {
    turning.advance({.steer = 0.12, .throttle = 0.3});
    braking.advance({.steer = 0.12, .throttle = -1.0});
    most_turning = std::max(most_turning, turning.output().ay);
    if (i > 400) most_braking = std::max(most_braking, braking.output().ay);
  }
  EXPECT_GT(most_turning, 9.0);
  EXPECT_LT(most_braking, 0.9 * most_turning);
}

}  // namespace
}  // namespace chicane::sim
