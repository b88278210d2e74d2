// SPDX-License-Identifier: MIT
#include "chicane/model/vehicle.hpp"

#include "chicane/model/prediction.hpp"
#include "support/chicane_test.hpp"

namespace chicane::model {
namespace {

TEST(WithGrip, GivesThatShareOfTheTyresForcesAtTheSameSlip) {
  const VehicleParams car = road_car_params();
  EXPECT_EQ(with_grip(car, 1.0), car);
  const PredictionModel told(car);
  const PredictionModel slippery(with_grip(car, 0.7));
  for (const double steer : {-0.08, 0.01, 0.05}) {
    const BodyMotion<double> rolling{25.0, 0.0, 0.0, steer, 0.0};
    const double force = told.change(rolling).vy;
    EXPECT_NEAR(slippery.change(rolling).vy / force, 0.7, 0.01) << steer;
  }
}

}  // namespace
}  // namespace chicane::model
