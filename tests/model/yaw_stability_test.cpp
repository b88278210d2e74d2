// SPDX-License-Identifier: MIT
#include "chicane/model/stability.hpp"
#include "support/chicane_test.hpp"

namespace chicane::model {
namespace {

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
