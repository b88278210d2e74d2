// SPDX-License-Identifier: MIT
#include "chicane/lap_time/detail/limit_car.hpp"

#include <gtest/gtest.h>

namespace chicane::lap_time {
namespace {

TEST(LimitCar, HasTheGripAndDragOfTheParameters) {
  const model::VehicleParams udacity = model::udacity_params();
  const LimitCar car(udacity);
  EXPECT_NEAR(car.grip(40.0), udacity.friction * (12.22 + 0.0923 * 40.0), 1e-9);
  EXPECT_NEAR(car.drag(40.0), -model::longitudinal_acceleration(udacity, 0.0, 40.0), 1e-12);
  EXPECT_NEAR(car.stay, 1.0 - udacity.steer_helper, 1e-12);
}

TEST(LimitCar, SlipDragIsTheForcesOfBothAxlesTimesTheirSlips) {
  const model::VehicleParams p = model::road_car_params();
  const LimitCar car(p);
  const double lateral = 5.0;  // [m/s²]
  double power = 0.0;          // over mass and speed
  for (const auto& [share, stiffness] : {std::pair{p.rear_axle / p.wheelbase(), p.cornering_front},
                                         std::pair{p.front_axle / p.wheelbase(), p.cornering_rear}}) {
    const double force = share * lateral;
    power += force * force / (stiffness * share * 9.81);
  }
  EXPECT_NEAR(car.slip_drag * lateral * lateral / car.load(20.0), power, 1e-12);
}

}  // namespace
}  // namespace chicane::lap_time
