// SPDX-License-Identifier: MIT
#include "chicane/tracking/way_back.hpp"
#include "support/chicane_test.hpp"

namespace chicane::tracking {
namespace {

/// Along x, from 0 to 100 m.
road::ReferenceLine straight() {
  road::ReferenceLine line(101);
  EXPECT_TRUE(line.shape(100.0, 100, false));
  for (std::size_t i = 0; i < line.samples().size(); ++i)
    line.samples()[i].curve = {.position = {static_cast<double>(i), 0.0}};
  return line;
}

model::Command back_from(double d, double yaw, double speed) {
  const road::ReferenceLine line = straight();
  const model::State car{.x = 50.0, .y = d, .psi = yaw, .vx = speed};
  return way_back(line, line.project({car.x, car.y}), car, model::udacity_params());
}

TEST(WayBackLaw, TurnsTowardsTheLineFromBothSidesAndFromAnyDirection) {
  const double full = model::udacity_params().steer_limit;
  for (const double d : {2.0, 10.0, 40.0}) {
    EXPECT_LT(back_from(d, 0.0, 2.0).steer, 0.0) << d;
    EXPECT_GT(back_from(-d, 0.0, 2.0).steer, 0.0) << d;
    EXPECT_DOUBLE_EQ(back_from(d, 0.3, 2.0).steer, -back_from(-d, -0.3, 2.0).steer) << "the same in a mirror";
    EXPECT_EQ(back_from(d, 1.5, 2.0).steer, -full) << "the short way round";
    EXPECT_EQ(back_from(d, -2.5, 2.0).steer, full);
  }
  EXPECT_NEAR(back_from(8.0, -0.25 * kPi, 2.0).steer, 0.0, 1e-9) << "it is on its course";
  EXPECT_NEAR(back_from(0.0, 0.0, 2.0).steer, 0.0, 1e-9);
}

/// A car on its line in a bend stays on it; one across the bend does not turn with it.
TEST(WayBackLaw, HasTheAngleOfTheBend) {
  const model::VehicleParams vehicle = model::udacity_params();
  for (const double curvature : {-0.05, 0.05}) {
    road::ReferenceLine line = straight();
    const auto steer = [&](double yaw) {
      return way_back(line, {.s = 50.0}, {.x = 50.0, .psi = yaw, .vx = 2.0}, vehicle).steer;
    };
    const double across = 0.1;
    const double straight_on = steer(across);
    for (road::ReferenceLine::Sample& each : line.samples()) each.curve.curvature = curvature;
    EXPECT_NEAR(std::tan(steer(0.0)), vehicle.wheelbase() * curvature, 1e-12);
    EXPECT_NEAR(std::tan(steer(across) - straight_on), vehicle.wheelbase() * curvature * std::cos(across),
                1e-12);
  }
}

TEST(WayBackLaw, GoesAtWalkingPace) {
  EXPECT_GT(back_from(5.0, 0.0, 0.0).throttle, 0.0);
  EXPECT_LT(back_from(5.0, 0.0, 6.0).throttle, 0.0);
}

/// A car whose wheels turn at 0.4 rad/s is 3 m farther by the time that they are where they shall be.
TEST(WayBackLaw, WaitsForWheelsThatTurnSlowly) {
  const road::ReferenceLine line = straight();
  const model::VehicleParams vehicle = model::udacity_params();
  model::State car{.x = 50.0, .y = 5.0, .psi = 1.5, .vx = 1.0};
  const auto pedal = [&](double steer) {
    car.steer = steer;
    return way_back(line, line.project({car.x, car.y}), car, vehicle).throttle;
  };
  EXPECT_LT(pedal(0.2), 0.0) << "it brakes, the wheel is turned the wrong way";
  EXPECT_GT(pedal(-vehicle.steer_limit), 0.0);
  car.vx = 0.0;
  EXPECT_EQ(pedal(0.2), 0.0) << "it stands, and does not roll back";
}

}  // namespace
}  // namespace chicane::tracking
