// SPDX-License-Identifier: MIT
#include "chicane/sim/double_track.hpp"

#include "chicane/base/math.hpp"
#include "chicane/model/prediction.hpp"
#include "sim/plant_experiment.hpp"
#include "support/chicane_test.hpp"

namespace chicane::sim {
namespace {

TEST(RoadCar, CornersAtAboutOneGAndNoMore) {
  DoubleTrack car;
  const double peak = experiment::peak_cornering(car, 20.0).lateral_acceleration / 9.81;
  EXPECT_GT(peak, 0.98);
  EXPECT_LT(peak, 1.20);  // the tyre's 1.2, less load transfer
}

TEST(RoadCar, AcceleratesLikeTwoHundredKilowatts) {
  DoubleTrack car;
  const auto run = experiment::drive_straight(car, 1.0, 60.0);
  EXPECT_NEAR(experiment::time_to(run, 100.0 / 3.6), 5.5, 0.4);
  for (const auto& [v, a] : experiment::accelerations(run, 1.0)) {
    EXPECT_LE(a * v, 200.0e3 / 1300.0) << v;
  }
  EXPECT_GT(run.back().speed, 65.0);
}

TEST(RoadCar, BrakesInProportionWithoutLocking) {
  DoubleTrack car;
  const double full = experiment::braking_at(car, -1.0, 20.0);
  const double half = experiment::braking_at(car, -0.5, 20.0);
  EXPECT_LT(full, -8.5);
  EXPECT_GT(full, -10.5);
  const double drag = experiment::braking_at(car, 0.0, 20.0);
  EXPECT_NEAR(half - drag, 0.5 * (full - drag), 0.15);
}

TEST(RoadCar, StopsAndStaysStopped) {
  DoubleTrack car;
  car.reset({}, 10.0);
  experiment::drive_straight(car, -1.0, 4.0);
  EXPECT_LT(car.output().speed, 1e-3);
  const double x = car.state().x;
  experiment::drive_straight(car, -1.0, 5.0);
  EXPECT_NEAR(car.state().x, x, 1e-3);
}

TEST(RoadCar, SteersNoFasterThanNinetyDegreesASecond) {
  DoubleTrack car;
  car.reset({}, 10.0);
  double before = 0.0;
  for (int i = 0; i < 500; ++i) {
    car.advance({.steer = i < 250 ? 0.43 : -0.43, .throttle = 0.0});
    EXPECT_LE(std::fabs(car.state().steer - before), degrees_to_radians(90.0) * 0.001 + 1e-12);
    before = car.state().steer;
  }
}

TEST(RoadCar, SteeringLagsByFiftyMilliseconds) {
  DoubleTrack car;
  for (int i = 0; i < 50; ++i) car.advance({.steer = 0.02, .throttle = 0.0});
  EXPECT_NEAR(car.state().steer, 0.02 * (1.0 - std::exp(-1.0)), 1e-9);
}

TEST(RoadCar, Understeers) {
  DoubleTrack car;
  const double slow = experiment::steady_circle(car, 0.02, 5.0).curvature;
  const double fast = experiment::steady_circle(car, 0.02, 25.0).curvature;
  EXPECT_LT(fast, 0.95 * slow);
  EXPECT_NEAR(slow, 0.02 / 2.70, 0.02 * 0.02 / 2.70);
}

TEST(RoadCar, BrakingInATurnTakesGripFromCornering) {
  DoubleTrack turning;
  turning.reset({}, 25.0);
  DoubleTrack braking;
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

/// Both have the same numbers, but for `except`.
void expect_alike(const model::VehicleParams& one, const model::VehicleParams& other, double tolerance,
                  const std::set<std::string_view>& except = {}) {
  for (const Option& option : model::vehicle_options()) {
    if (option.kind != OptionKind::kNumber || except.contains(option.name)) continue;
    const double a = std::get<double>(option.read(&one));
    const double b = std::get<double>(option.read(&other));
    if (a == b) continue;  // infinite
    EXPECT_NEAR(a, b, tolerance * std::fabs(a)) << option.name;
  }
}

// The values that were fitted to it (model/vehicle.cpp) are those that follow from what it is built of.
TEST(DoubleTrack, TheModelThatFollowsFromTheRoadCarIsTheOneThatWasFitted) {
  const model::VehicleParams fitted = model::road_car_params();
  expect_alike(fitted, model_of({}, fitted), 0.015);  // of the drive: what slip takes at full throttle
}

TEST(DoubleTrack, ThePlantOfAModelHasThatModel) {
  DoubleTrackParams plant;
  plant.downforce_front = 0.6;
  plant.downforce_rear = 0.9;
  plant.drive_friction = 40.0;
  model::VehicleParams found = model_of(plant);
  found.friction *= 0.8;
  found.cornering_front *= 1.3;
  found.cornering_rear *= 0.9;
  found.front_axle *= 1.1;
  found.yaw_inertia *= 0.9;
  found.drive_acceleration *= 1.2;
  found.brake_acceleration *= 0.7;
  found.steer_lag = 0.08;
  found.drag_constant *= 1.4;
  found.drag_driven *= 0.9;
  found.drag_quadratic *= 1.5;
  const DoubleTrackParams made = plant_of(found, plant);
  expect_alike(found, model_of(made, found), 1e-12, {"kinematic_length", "brake_throttle_limit"});
  EXPECT_EQ(made.wheel_inertia, plant.wheel_inertia);
  EXPECT_NEAR(found.load_balance, 0.4 - plant.rear_axle / plant.wheelbase(), 1e-12);
}

TEST(DoubleTrack, DownforceLetsItCornerFaster) {
  DoubleTrackParams params;
  DoubleTrack without(params);
  params.downforce_front = 1.2;
  params.downforce_rear = 1.4;
  DoubleTrack with(params);
  const double v = 40.0;
  const double more = experiment::peak_cornering(with, v).lateral_acceleration /
                      experiment::peak_cornering(without, v).lateral_acceleration;
  // Of the load at rest, and less friction at more load; the axles reach their peaks one after the other.
  const double load = 2.6 * v * v / (params.mass * DoubleTrackParams::kGravity);
  EXPECT_NEAR(more, 1.0 + (1.0 - params.load_sensitivity) * load, 0.07);
}

/// The load moves to the outer wheels: with the same torque, the inner ones slip more.
TEST(DoubleTrack, SlipsMoreWithItsInnerWheels) {
  for (const double side : {1.0, -1.0}) {
    for (const double pedal : {0.6, -0.4}) {
      DoubleTrack car;
      car.reset({}, 20.0);
      for (int i = 0; i < 1000; ++i) car.advance({.steer = 0.05 * side, .throttle = i < 400 ? 0.2 : pedal});
      const std::array<double, 4>& slip = car.output().slip_ratio;
      for (const std::size_t front : {0U, 2U}) {
        const double inner = std::fabs(slip[side > 0.0 ? front : front + 1]);
        const double outer = std::fabs(slip[side > 0.0 ? front + 1 : front]);
        EXPECT_GT(inner, 1.2 * outer) << side << ' ' << pedal << ' ' << front;
      }
    }
  }
}

TEST(DoubleTrack, TractionControlKeepsTheDrivenWheelsFromSpinning) {
  DoubleTrackParams params;
  params.drive_force = 14000.0;
  params.drive_share_front = 0.0;
  DoubleTrack spinning(params);
  params.traction_slip_start = 0.1;
  params.traction_slip_end = 0.18;
  DoubleTrack controlled(params);
  experiment::drive_straight(spinning, 1.0, 1.0);
  experiment::drive_straight(controlled, 1.0, 1.0);
  EXPECT_GT(spinning.output().slip_ratio[2], 0.5);
  EXPECT_LT(controlled.output().slip_ratio[2], 0.18);
  EXPECT_GT(controlled.output().speed, spinning.output().speed);
}

// model/vehicle.hpp: a quarter of the length, half of the time, the same acceleration.
TEST(DoubleTrack, AModelCarMovesAsTheCarItIsAModelOf) {
  constexpr double kScale = 0.25;
  DoubleTrackParams p;
  for (double* length : {&p.front_axle, &p.rear_axle, &p.track_width, &p.tire_width, &p.height,
                         &p.wheel_radius, &p.relaxation_along, &p.relaxation_across})
    *length *= kScale;
  const double force = kScale * kScale * kScale, time = std::sqrt(kScale);
  for (double* each : {&p.mass, &p.drive_force, &p.brake_force}) *each *= force;
  p.yaw_inertia *= force * kScale * kScale;
  p.wheel_inertia *= force * kScale * kScale;
  p.drag *= force / kScale;
  p.drive_power *= force * time;
  for (double* each : {&p.load_lag, &p.steer_lag, &p.drive_lag, &p.creep_speed, &p.abs_speed}) *each *= time;
  p.creep_damping /= time;
  p.steer_rate_limit /= time;
  DoubleTrack small(p);
  DoubleTrack large;
  small.reset({}, 20.0 * time);
  large.reset({}, 20.0);
  for (int i = 0; i < 3000; ++i) {
    const double t = 0.001 * i;  // of the large one
    const model::Command command{0.06 * std::sin(2.0 * t), t < 1.5 ? 0.5 : -0.4};
    large.advance(command);
    if (i % 2 == 0) small.advance(command);
  }
  // Steps of the small one are twice as long for it.
  EXPECT_NEAR(small.state().x, kScale * large.state().x, 0.005 * kScale * large.state().x);
  EXPECT_NEAR(small.state().y, kScale * large.state().y, 0.01 * kScale * std::fabs(large.state().y) + 0.01);
  EXPECT_NEAR(small.output().speed, time * large.output().speed, 0.005 * large.output().speed);
}

// Its wheels are an oscillator of some 700 rad/s, which steps of 1 ms as a whole would shake apart.
TEST(DoubleTrack, ASmallCarWithLightWheelsRollsCalmly) {
  DoubleTrackParams params;
  static_cast<model::CarBody&>(params) = {.front_axle = 0.03,
                                          .rear_axle = 0.03,
                                          .track_width = 0.03,
                                          .tire_width = 0.005,
                                          .mass = 0.04,
                                          .yaw_inertia = 3e-5,
                                          .height = 0.01};
  params.load_lag = 0.01;
  params.wheel_radius = 0.013;
  params.wheel_inertia = 1e-7;
  params.drag = 0.0;
  params.relaxation_along = 0.005;
  params.relaxation_across = 0.01;
  params.creep_speed = 0.2;
  params.creep_damping = 1.0;
  params.drive_force = 0.2;
  params.drive_power = 0.5;
  params.brake_force = 0.3;
  params.abs_speed = 0.1;
  DoubleTrack car(params);
  const auto run = experiment::drive_straight(car, 0.5, 2.0);
  for (std::size_t i = 100; i < run.size(); ++i) ASSERT_NEAR(run[i].ax, run[i - 1].ax, 0.02) << run[i].time;
  EXPECT_NEAR(run.back().ax, longitudinal_acceleration(model_of(params), 0.5, run.back().speed), 0.05);
}

// docs/controller.md, eq. 4g, and the force against the air.
TEST(DoubleTrack, ResistanceTurnsModelAndCarAlike) {
  constexpr double kSpeed = 30.0, kSteer = 0.005;
  const auto yaw_rates = [](double rolling, double drag) {
    DoubleTrackParams params;
    params.rolling_resistance = rolling;
    params.drag = drag;
    params.drive_share_front = 0.0;
    DoubleTrack car(params);
    const model::PredictionModel model(model_of(params));
    model::BodyMotion<double> body{kSpeed, 0.0, 0.0, kSteer, 0.0};
    for (int i = 0; i < 1000; ++i) {
      body = model.advance(body, kSteer, 0.0, 0.01, model.lags(0.01));
      body.vx = kSpeed;
    }
    return std::pair{experiment::steady_circle(car, kSteer, kSpeed).yaw_rate, body.r};
  };
  const auto [free_car, free_model] = yaw_rates(0.0, 0.0);
  const auto [rolling_car, rolling_model] = yaw_rates(0.1, 0.0);
  EXPECT_LT(rolling_car / free_car, 0.9);
  EXPECT_NEAR(rolling_model / free_model, rolling_car / free_car, 0.01);
  const auto [blown_car, blown_model] = yaw_rates(0.0, 3.0);
  EXPECT_GT(blown_car / free_car, 1.05);
  EXPECT_NEAR(blown_model / free_model, blown_car / free_car, 0.01);
}

}  // namespace
}  // namespace chicane::sim
