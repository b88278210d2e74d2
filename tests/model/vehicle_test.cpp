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
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto expect_refused = [](const char* field, const std::function<void(VehicleParams&)>& change) {
    VehicleParams car;
    change(car);
    const Result<void> result = validate(car);
    ASSERT_FALSE(result) << field;
    EXPECT_EQ(result.error().code, ErrorCode::kInvalidArgument);
    EXPECT_THAT(result.error().message, HasSubstr(field));
  };
  expect_refused("mass", [](VehicleParams& p) { p.mass = 0.0; });
  expect_refused("yaw_inertia", [](VehicleParams& p) { p.yaw_inertia = -1.0; });
  expect_refused("kinematic_length", [&](VehicleParams& p) { p.kinematic_length = nan; });
  expect_refused("front_axle",
                 [](VehicleParams& p) { p.front_axle = std::numeric_limits<double>::infinity(); });
  expect_refused("steer_limit", [](VehicleParams& p) { p.steer_limit = 1.6; });
  expect_refused("steer_helper", [](VehicleParams& p) { p.steer_helper = 1.0; });
  expect_refused("steer_lag", [](VehicleParams& p) { p.steer_lag = -0.1; });
  expect_refused("brake_throttle_limit", [](VehicleParams& p) { p.brake_throttle_limit = 1.5; });
  expect_refused("drive_power_per_mass", [](VehicleParams& p) { p.drive_power_per_mass = 0.0; });
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

}  // namespace
}  // namespace chicane::model
