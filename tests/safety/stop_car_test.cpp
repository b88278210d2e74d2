// SPDX-License-Identifier: MIT
#include "chicane/safety/stop_car.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "chicane/sim/double_track.hpp"
#include "support/alloc_guard.hpp"

namespace chicane::safety {
namespace {

model::VehicleParams plain_car() { return model::road_car_params(); }

/// The plant after two seconds in a bend at about `speed`, a little drive on, and the same as a StopMotion.
struct InABend {
  InABend(double speed, double steer, const sim::DoubleTrackParams& params = {}) : plant{params} {
    plant.reset({}, speed);
    for (int i = 0; i < 2000; ++i) drive({steer, 0.03 * (speed - plant.state().vx) + 0.25});
    const model::State s = plant.state();
    motion = {.body = {s.vx, s.vy, s.r, s.steer, plant.output().ax},
              .load_along = plant.output().ax,
              .load_across = plant.output().ay};
  }
  void drive(const model::Command& command) { plant.advance(command); }
  sim::DoubleTrack plant;
  StopMotion motion;
};

/// Stiff tyres whose wheels lock, downforce that presses the rear more than the weight does, and a motor
/// whose friction brakes the driven wheels alone.
TEST(StopCar, KnowsLockingWheelsTheBalanceOfDownforceAndMotors) {
  sim::DoubleTrackParams stiff, pressed, motored;
  stiff.friction = 0.63;
  stiff.stiffness_front = 7.0;
  stiff.stiffness_rear = 19.5;
  pressed.downforce_front = 0.4;
  pressed.downforce_rear = 1.6;
  motored.drive_friction = 2.0 * motored.mass;
  for (const auto& [params, throttle] :
       {std::pair{stiff, -0.55}, std::pair{pressed, -0.1}, std::pair{motored, 0.0}}) {
    InABend bend(params.downforce_rear > 0.0 ? 45.0 : 25.0, 0.025, params);
    const StopCar car(sim::model_of(params));
    StopMotion at = bend.motion;
    for (int i = 0; i < 20; ++i) {
      at = car.advance(at, 0.025, longitudinal_acceleration(car.vehicle(), throttle, at.body.vx),
                       car.step(0.05));
      for (int k = 0; k < 50; ++k) bend.drive({0.025, throttle});
    }
    const model::State& plant = bend.plant.state();
    EXPECT_NEAR(at.body.vx, plant.vx, 0.2);
    EXPECT_NEAR(at.body.r, plant.r, 0.003);
    EXPECT_NEAR(at.body.vy, plant.vy, 0.05);
  }
}

/// What nobody corrects has to be right: braked in a bend by the same commands, the car turns as the plant.
/// The controllers' model is a third further off at 35 m/s.
TEST(StopCar, TurnsAsThePlantWhereItBrakesInABend) {
  const model::VehicleParams params = plain_car();
  const StopCar car(params);
  const model::PredictionModel model(params);
  for (const double side : {1.0, -1.0}) {
    for (const double speed : {25.0, 35.0}) {
      InABend bend(speed, side * (speed > 30.0 ? 0.03 : 0.045));
      StopMotion at = bend.motion;
      model::BodyMotion<double> simple = at.body;
      double heading = 0.0, heading_of_simple = 0.0, heading_of_plant = 0.0;
      const model::Command command{0.6 * bend.motion.body.steer, -0.12};
      constexpr double kStep = 0.05;
      for (int i = 0; i < 30; ++i) {
        const auto asked = [&](double v) { return longitudinal_acceleration(params, command.throttle, v); };
        heading += 0.5 * kStep * at.body.r;
        at = car.advance(at, command.steer, asked(at.body.vx), car.step(kStep));
        heading += 0.5 * kStep * at.body.r;
        heading_of_simple += 0.5 * kStep * simple.r;
        simple = model.advance(simple, command.steer, asked(simple.vx), kStep, model.lags(kStep));
        heading_of_simple += 0.5 * kStep * simple.r;
        for (int k = 0; k < 50; ++k) {
          bend.drive(command);
          heading_of_plant += 0.001 * bend.plant.state().r;
        }
      }
      EXPECT_NEAR(at.body.vx, bend.plant.state().vx, 0.3);
      EXPECT_NEAR(heading, heading_of_plant, 0.012) << speed;
      EXPECT_GT(std::fabs(heading_of_simple - heading_of_plant), 1.2 * std::fabs(heading - heading_of_plant))
          << speed;
    }
  }
}

TEST(StopCar, IsTheSameInAMirror) {
  const StopCar car(plain_car());
  StopMotion left{.body = {30.0, -0.8, 0.2, 0.03, -1.0}, .load_along = 0.5, .load_across = 5.0};
  StopMotion right{.body = {30.0, 0.8, -0.2, -0.03, -1.0}, .load_along = 0.5, .load_across = -5.0};
  for (int i = 0; i < 40; ++i) {
    left = car.advance(left, 0.02, -5.0, car.step(0.05));
    right = car.advance(right, -0.02, -5.0, car.step(0.05));
    EXPECT_NEAR(left.body.vx, right.body.vx, 1e-12);
    EXPECT_NEAR(left.body.vy, -right.body.vy, 1e-12);
    EXPECT_NEAR(left.body.r, -right.body.r, 1e-12);
    EXPECT_NEAR(left.load_across, -right.load_across, 1e-12);
  }
}

/// A step of 50 ms and two of 25 ms end at the same place; those of first order differ by ten times as much.
TEST(StopCar, IsOfSecondOrderInTheStep) {
  const StopCar car(plain_car());
  const auto yaw_rate = [&](int steps) {
    StopMotion at{.body = {35.0, -1.9, 0.24, 0.034, 0.6}, .load_along = 0.6, .load_across = 8.4};
    for (int i = 0; i < steps; ++i) at = car.advance(at, 0.016, -1.4, car.step(0.4 / steps));
    return at.body.r;
  };
  const double exact = yaw_rate(400);
  EXPECT_LT(std::fabs(yaw_rate(8) - exact), 2e-3);
  EXPECT_LT(std::fabs(yaw_rate(16) - exact), 0.35 * std::fabs(yaw_rate(8) - exact));
}

/// The loads follow the accelerations with a lag: a car that lets go of its drive turns in by and by.
TEST(StopCar, MovesItsLoadsWithALag) {
  const StopCar car(plain_car());
  const StopMotion from{.body = {35.0, -1.9, 0.24, 0.034, 0.6}, .load_along = 0.6, .load_across = 8.4};
  const StopMotion to = car.advance(from, 0.034, -6.0, car.step(0.05));
  EXPECT_LT(to.body.acceleration, -1.5);
  EXPECT_GT(to.load_along, to.body.acceleration + 0.5);
  EXPECT_LT(to.load_along, 0.6);
}

/// Cars without shared forces, and slow ones, move as the controllers' model says.
TEST(StopCar, IsThePredictionModelWhereThatIsEnough) {
  for (const model::VehicleParams& params : {model::udacity_params(), plain_car()}) {
    const StopCar car(params);
    const model::PredictionModel model(params);
    const model::BodyMotion<double> body{params.friction_coupling > 0.0 ? 8.0 : 30.0, 0.1, 0.1, 0.02, -1.0};
    const StopMotion to = car.advance({.body = body}, 0.03, -3.0, car.step(0.05));
    const model::BodyMotion<double> expected = model.advance(body, 0.03, -3.0, 0.05, model.lags(0.05));
    EXPECT_EQ(to.body.vx, expected.vx);
    EXPECT_EQ(to.body.vy, expected.vy);
    EXPECT_EQ(to.body.r, expected.r);
    EXPECT_EQ(to.load_along, expected.acceleration);
  }
}

TEST(StopCar, StaysFiniteHoweverItSlides) {
  const StopCar car(plain_car());
  for (const double vy : {-30.0, 0.0, 30.0})
    for (const double r : {-3.0, 0.0, 3.0})
      for (const double asked : {-30.0, 0.0, 10.0}) {
        StopMotion at{.body = {40.0, vy, r, 0.0, 0.0}};
        for (int i = 0; i < 100; ++i) {
          at = car.advance(at, 0.4, asked, car.step(0.05));
          at.body.vx = std::max(at.body.vx, 0.0);  // as its user does
        }
        EXPECT_TRUE(std::isfinite(at.body.vx + at.body.vy + at.body.r + at.load_along + at.load_across));
      }
}

TEST(StopCar, AllocatesNothing) {
  const StopCar car(plain_car());
  const test::AllocationGuard guard;
  static_cast<void>(car.advance({.body = {30.0, 0.0, 0.1, 0.0, 0.0}}, 0.01, -3.0, car.step(0.05)));
  EXPECT_EQ(guard.count(), 0);
}

}  // namespace
}  // namespace chicane::safety
