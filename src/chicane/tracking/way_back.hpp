// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "chicane/base/math.hpp"
#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/road/reference_line.hpp"

/// Control law that leads a slow car from beside the road back to it.

namespace chicane::tracking {

/// Command that leads a slow car to a line at walking pace, from anywhere beside it and with any heading. The
/// course meets the line at 45° from a distance of kApproach, and at a smaller angle the nearer it is. The
/// wheels have the angle of the bend, plus a part in proportion to the error of the course. The car waits for
/// wheels that turn slowly. `place`: the car's projection on the line.
[[nodiscard]] inline model::Command way_back(const road::ReferenceLine& line,
                                             const road::ReferenceLine::Projection& place,
                                             const model::State& car,
                                             const model::VehicleParams& vehicle) noexcept {
  // Chosen.
  constexpr double kApproach = 8.0;      // [m] offset at which the course is at 45° to the line
  constexpr double kWalkingPace = 3.0;   // [m/s] speed of the way back
  constexpr double kMostBraking = -2.0;  // [m/s²] least acceleration
  constexpr double kMostDrive = 1.0;     // [m/s²] largest acceleration
  constexpr double kFullLock = 0.5;      // [rad] error of the course at which the wheels are at full lock
  constexpr double kWheelOff = 0.5;      // [rad] error of the wheel angle at which the car waits
  const road::CurvePoint at = line.at(place.s);
  const double course = at.heading - atan(place.d / kApproach);
  const double turn = std::clamp(angle_difference(course, car.psi) / kFullLock, -1.0, 1.0);
  const double bend = atan(vehicle.wheelbase() * at.curvature * cos(angle_difference(car.psi, at.heading)));
  const double lock = vehicle.steer_limit;
  const double steer = std::clamp(turn * lock + bend, -lock, lock);
  const double pace = kWalkingPace * std::max(1.0 - std::fabs(steer - car.steer) / kWheelOff, 0.0);
  const double acceleration = std::clamp(pace - car.vx, kMostBraking, kMostDrive);
  if (!(acceleration > 0.0)) return {steer, throttle_to_rest(vehicle, acceleration, car.vx)};
  return {steer, throttle_for(vehicle, acceleration, car.vx)};
}

}  // namespace chicane::tracking
