// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "chicane/base/math.hpp"
#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/road/reference_line.hpp"

namespace chicane::tracking {

/// What leads a slow car back to a line, from anywhere beside it and in any direction: walking pace, on a
/// course that is at 45° to the line kApproach beside it, and along it on it. The wheels have the angle of
/// the bend, and more by the error of the course. A car whose wheels turn slowly waits for them. `place`: the
/// car's projection on the line.
[[nodiscard]] inline model::Command way_back(const road::ReferenceLine& line,
                                             const road::ReferenceLine::Projection& place,
                                             const model::State& car,
                                             const model::VehicleParams& vehicle) noexcept {
  constexpr double kApproach = 8.0;      // [m]
  constexpr double kWalkingPace = 3.0;   // [m/s]
  constexpr double kMostBraking = -2.0;  // [m/s²]
  constexpr double kMostDrive = 1.0;     // [m/s²]
  constexpr double kFullLock = 0.5;      // [rad] off its course the wheel is turned as far as it goes
  constexpr double kWheelOff = 0.5;      // [rad] the wheel is from its command, and the car stands
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
