// SPDX-License-Identifier: MIT
#include "chicane/identify/detail/car_motion.hpp"

#include "chicane/base/math.hpp"
#include "chicane/model/prediction.hpp"
#include "chicane/sim/double_track.hpp"
#include "support/chicane_test.hpp"

namespace chicane::identify {
namespace {

constexpr double kStep = 0.01;

Wheels wheels_of(const sim::DoubleTrackParams& p) {
  return {.relaxation = p.relaxation_across,
          .load_lag = p.load_lag,
          .rotating = 1.0 + 4.0 * p.wheel_inertia / (p.wheel_radius * p.wheel_radius * p.mass),
          .brakes = {p.abs_slip_start, p.abs_slip_end},
          .drive = {p.traction_slip_start, p.traction_slip_end}};
}

/// A manoeuvre: what is asked of the plant at a moment.
struct Manoeuvre {
  double speed;               ///< at its begin [m/s]
  double (*steer)(double t);  ///< [rad]
  double (*pedal)(double t);
};

struct Difference {
  double r = 0.0, vy = 0.0, vx = 0.0;  ///< largest
  double most_r = 0.0;                 ///< of the plant
};

/// The plant and the fitted model beside it, with the same wheel angle and pedal, for two seconds.
Difference difference(const sim::DoubleTrackParams& params, const Manoeuvre& drive) {
  sim::DoubleTrack plant(params);
  plant.reset({}, drive.speed);
  const model::VehicleParams vehicle = sim::model_of(params, model::road_car_params());
  const FourWheels wheels(vehicle, wheels_of(params), kStep);
  FourWheels::Motion motion = wheels.steady(drive.speed, 0.0, 0.0, 0.0, 0.0);
  Difference found;
  double pedal = 0.0;
  for (int i = 0; i < 200; ++i) {
    const double t = kStep * i;
    const double before = plant.state().steer;
    for (int k = 0; k < 10; ++k) plant.advance(model::Command{drive.steer(t), drive.pedal(t)});
    const double asked = drive.pedal(t);
    const double next = asked + (pedal - asked) * exp(-kStep / params.drive_lag);
    const double drag = -model::longitudinal_acceleration(vehicle, 0.0, motion.vx);
    const double force = model::longitudinal_acceleration(vehicle, 0.5 * (pedal + next), motion.vx) + drag;
    wheels.advance(motion, before, 0.5 * (before + plant.state().steer), force, drag);
    pedal = next;
    const model::State& state = plant.state();
    found.r = std::max(found.r, std::fabs(state.r - motion.r));
    found.vy = std::max(found.vy, std::fabs(state.vy - motion.vy));
    found.vx = std::max(found.vx, std::fabs(state.vx - motion.vx));
    found.most_r = std::max(found.most_r, std::fabs(state.r));
  }
  return found;
}

double gentle(double t) { return 0.02 * sin(2.0 * kPi * t); }
double hard(double t) { return 0.1 * sin(2.0 * kPi * t / 1.5); }
double into_a_bend(double t) { return 0.07 * std::min(1.0, 2.0 * t); }
double rolling(double) { return 0.05; }
double pulling(double) { return 0.6; }
double braking_late(double t) { return t > 0.5 ? -0.4 : 0.05; }

// Where the controllers' model is 2 to 20 % off, and a fit of it finds that in stiffness and inertia.
TEST(FourWheels, MoveAsThePlantDoes) {
  const sim::DoubleTrackParams params;
  for (const double speed : {8.0, 15.0, 30.0}) {
    const Difference swerve = difference(params, {speed, gentle, rolling});
    EXPECT_LT(swerve.r, 0.01 * swerve.most_r) << speed;
  }
  const Difference driven = difference(params, {15.0, hard, pulling});
  EXPECT_LT(driven.r, 0.015 * driven.most_r);
  EXPECT_LT(driven.vx, 0.05);
}

TEST(FourWheels, BrakeIntoABendAsThePlantDoes) {
  // 98 % of the tyres are used, and the rear begins to slide: any error grows. By the controllers' model the
  // car has spun by then.
  const Difference braked = difference({}, {22.0, into_a_bend, braking_late});
  EXPECT_GT(braked.most_r, 0.7);
  EXPECT_LT(braked.r, 0.03 * braked.most_r);
  EXPECT_LT(braked.vx, 0.1);
}

TEST(FourWheels, WheelsThatTurnHoldBackTheYaw) {
  // Those outside have to turn faster: with the car's inertia alone the yaw would follow 1.6 % too quickly.
  sim::DoubleTrackParams heavy;
  heavy.wheel_inertia *= 4.0;
  const Difference found = difference(heavy, {15.0, gentle, rolling});
  EXPECT_LT(found.r, 0.015 * found.most_r);
}

TEST(FourWheels, StayFiniteBeyondTheTyres) {
  model::VehicleParams vehicle = model::road_car_params();
  for (const double friction : {0.05, 1.2, 3.0}) {
    vehicle.friction = friction;
    const FourWheels wheels(
        vehicle, {.relaxation = 0.0, .load_lag = 0.0, .rotating = 1.0, .brakes = {}, .drive = {}}, kStep);
    FourWheels::Motion motion = wheels.steady(40.0, 3.0, 1.0, 0.4, 5.0);
    for (int i = 0; i < 500; ++i) wheels.advance(motion, 0.4, 0.4, i % 100 < 50 ? 30.0 : -30.0, 0.1);
    EXPECT_TRUE(std::isfinite(motion.vx + motion.vy + motion.r)) << friction;
  }
}

TEST(FourWheels, StandForCarsWithMagicTyresAlone) {
  EXPECT_TRUE(has_four_wheels(model::road_car_params()));
  EXPECT_FALSE(has_four_wheels(model::udacity_params()));
}

}  // namespace
}  // namespace chicane::identify
