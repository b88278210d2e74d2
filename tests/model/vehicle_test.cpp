// SPDX-License-Identifier: MIT
#include "chicane/model/vehicle.hpp"

#include "chicane/base/random.hpp"
#include "support/chicane_test.hpp"

namespace chicane::model {
namespace {

TEST(Vehicle, ShippedCarsAreValidAndNamed) {
  EXPECT_EQ(udacity_params().name, "udacity");
  EXPECT_EQ(road_car_params().name, "road-car");
  EXPECT_TRUE(validate(udacity_params()));
  EXPECT_TRUE(validate(road_car_params()));
}

/// A model car comes to rest as the car in full size does, in its own time.
TEST(Vehicle, BringsModelCarsToRestAsThoseInFullSize) {
  VehicleParams model_car = road_car_params();
  model_car.scale = 0.1;
  const VehicleParams full = Similarity(model_car).full_size(model_car);
  const double faster = std::sqrt(10.0);
  for (const double v : {0.05, 0.3, 0.8, 1.2, 3.0})
    for (const double a : {-1.0, -4.0, -9.0})
      EXPECT_NEAR(throttle_to_rest(model_car, a, v), throttle_to_rest(full, a, faster * v), 1e-9)
          << v << ", " << a;
}

TEST(Vehicle, RefusesEachUnphysicalFieldByName) {
  using Limits = std::numeric_limits<double>;
  const auto expect_refused = [](const char* field, double VehicleParams::*member, double value) {
    VehicleParams car;
    car.*member = value;
    const Result<void> result = validate(car);
    ASSERT_FALSE(result) << field;
    EXPECT_EQ(result.error().code, ErrorCode::kInvalidArgument);
    EXPECT_THAT(result.error().message, HasSubstr(field));
  };
  expect_refused("mass", &VehicleParams::mass, 0.0);
  expect_refused("yaw_inertia", &VehicleParams::yaw_inertia, -1.0);
  expect_refused("kinematic_length", &VehicleParams::kinematic_length, Limits::quiet_NaN());
  expect_refused("front_axle", &VehicleParams::front_axle, Limits::infinity());
  expect_refused("steer_limit", &VehicleParams::steer_limit, 1.6);
  expect_refused("steer_helper", &VehicleParams::steer_helper, 1.0);
  expect_refused("steer_lag", &VehicleParams::steer_lag, -0.1);
  expect_refused("brake_throttle_limit", &VehicleParams::brake_throttle_limit, 1.5);
  expect_refused("drive_power_per_mass", &VehicleParams::drive_power_per_mass, 0.0);
}

TEST(LongitudinalLaw, IsTheDocumentedOne) {
  VehicleParams car = udacity_params();
  EXPECT_NEAR(longitudinal_acceleration(car, 1.0, 20.0), car.drive_acceleration - car.drag_linear * 20.0,
              1e-12);
  EXPECT_NEAR(longitudinal_acceleration(car, -0.02, 10.0),
              -0.02 * car.brake_acceleration - car.drag_linear * 10.0, 1e-12);
  EXPECT_EQ(longitudinal_acceleration(car, -1.0, 10.0),
            longitudinal_acceleration(car, -car.brake_throttle_limit, 10.0))
      << "locked wheels brake no harder";
  EXPECT_NEAR(longitudinal_acceleration(car, -0.5, 0.0), -0.5 * car.reverse_acceleration, 1e-12)
      << "the reverse gear";
  EXPECT_EQ(lowest_throttle(car, 1.0), -1.0);
  EXPECT_EQ(lowest_throttle(car, 10.0), -car.brake_throttle_limit);
  EXPECT_EQ(longitudinal_acceleration(car, 7.0, 5.0), longitudinal_acceleration(car, 1.0, 5.0));
  car.drive_power_per_mass = 40.0;
  EXPECT_NEAR(longitudinal_acceleration(car, 1.0, 20.0), 2.0 - car.drag_linear * 20.0, 1e-12);
}

TEST(LongitudinalLaw, ThrottleForIsItsInverse) {
  Random random{7};
  for (const VehicleParams& car : {udacity_params(), road_car_params()}) {
    for (int i = 0; i < 2000; ++i) {
      const double v = random.uniform(0.0, 60.0);
      const double throttle = random.uniform(-car.brake_throttle_limit, 1.0);
      const double acceleration = longitudinal_acceleration(car, throttle, v);
      const double back = throttle_for(car, acceleration, v);
      // Above the power cap many throttles give the same acceleration: that it does, is what counts. 1e-12 is
      // rounding.
      EXPECT_NEAR(longitudinal_acceleration(car, back, v), acceleration, 1e-12) << car.name << " v " << v;
      if (std::isinf(car.drive_power_per_mass)) {
        EXPECT_NEAR(back, throttle, 1e-12);
      }
    }
  }
}

TEST(LongitudinalLaw, ThrottleForClampsToTheUsefulRange) {
  const VehicleParams car = udacity_params();
  EXPECT_EQ(throttle_for(car, 100.0, 10.0), 1.0);
  EXPECT_EQ(throttle_for(car, -100.0, 10.0), -car.brake_throttle_limit);
  EXPECT_EQ(throttle_for(car, std::numeric_limits<double>::quiet_NaN(), 10.0), 0.0);
}

VehicleParams model_car() {
  VehicleParams car = road_car_params();
  car.scale = 0.1;
  for (double* length : {&car.front_axle, &car.rear_axle, &car.track_width, &car.tire_width, &car.length,
                         &car.width, &car.kinematic_length, &car.height})
    *length *= 0.1;
  car.mass *= 1e-3;
  car.yaw_inertia *= 1e-5;
  car.steer_rate_limit *= std::sqrt(10.0);
  car.steer_lag /= std::sqrt(10.0);
  car.drive_lag /= std::sqrt(10.0);
  car.drive_power_per_mass /= std::sqrt(10.0);
  car.drag_quadratic *= 10.0;
  return car;
}

TEST(Similarity, OfACarInFullSizeChangesNoBit) {
  const Similarity same(road_car_params());
  EXPECT_TRUE(same.is_identity());
  EXPECT_EQ(same.full_size(road_car_params()), road_car_params());
  EXPECT_EQ(same.full_size(udacity_params()), udacity_params());
}

TEST(Similarity, AModelCarInFullSizeIsTheCarItIsAModelOf) {
  const VehicleParams car = Similarity(model_car()).full_size(model_car());
  const VehicleParams original = road_car_params();
  for (const Option& option : vehicle_options()) {
    if (option.kind != OptionKind::kNumber) continue;
    const double a = std::get<double>(option.read(&car));
    const double b = std::get<double>(option.read(&original));
    if (a == b) continue;  // infinite
    EXPECT_NEAR(a, b, 1e-12 * std::fabs(b)) << option.name;
  }
  VehicleParams limited = model_car();
  limited.valid_speed = 10.0;
  EXPECT_NEAR(Similarity(limited).full_size(limited).valid_speed, 10.0 * std::sqrt(10.0), 1e-9);
}

TEST(Similarity, WhatIsMeasuredGrowsWithTheCar) {
  Measurement small{.time = 2.0, .x = 1.5, .y = -0.5, .psi = 0.7, .speed = 3.0, .steer = 0.1, .delay = 0.02};
  small.waypoint_count = 1;
  small.waypoints[0] = {2.0, 1.0};
  const Measurement large = Similarity(0.25).full_size(small);
  EXPECT_EQ(large.time, 4.0);
  EXPECT_EQ(large.x, 6.0);
  EXPECT_EQ(large.y, -2.0);
  EXPECT_EQ(large.psi, 0.7);
  EXPECT_EQ(large.speed, 6.0);
  EXPECT_EQ(large.steer, 0.1);
  EXPECT_EQ(large.delay, 0.04);
  EXPECT_EQ(large.waypoints[0], (Vec2{8.0, 4.0}));
}

}  // namespace
}  // namespace chicane::model
