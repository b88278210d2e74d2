// SPDX-License-Identifier: MIT
#include "chicane/model/vehicle.hpp"
#include "support/chicane_test.hpp"

namespace chicane::model {
namespace {

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
