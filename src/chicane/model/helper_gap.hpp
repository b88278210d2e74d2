// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/base/angle.hpp"
#include "chicane/base/math.hpp"
#include "chicane/model/vehicle.hpp"

/// What a steer helper leaves out: the original simulator's does nothing for one step of physics when the
/// heading passes +y, where its yaw angle wraps (docs/limit.md, eq. 11 and 12).
namespace chicane::model {

inline constexpr double kHelperGapHeading = 0.5 * kPi;  ///< in W [rad]

/// Share of the way from heading `from` to heading `to` [rad] at which the gap is passed, (0, 1]; 0: it is
/// not.
[[nodiscard]] inline double helper_gap_within(double from, double to) noexcept {
  const double before = angle_difference(from, kHelperGapHeading);
  const double after = before + (to - from);
  const bool passes = (before < 0.0 && after >= 0.0) || (before > 0.0 && after <= 0.0);
  return passes ? before / (before - after) : 0.0;
}

/// Angle by which the velocity is not turned along with the body in a gap passed at a yaw rate [rad/s].
[[nodiscard]] inline double helper_gap_turn(const VehicleParams& car, double yaw_rate) noexcept {
  return car.steer_helper * car.helper_gap * yaw_rate;
}

/// Share of the helper that is left out at a heading, spread smoothly over some tenths of a radian: as much
/// in all as in the gap. `heading` against the direction `line` of the road [rad]. T holds derivatives.
template <class T>
[[nodiscard]] T helper_left_out(const VehicleParams& car, double line, const T& heading, const T& yaw_rate) {
  constexpr double kWidth = 0.12;      // [rad]
  constexpr double kLeastRate = 0.05;  // [rad/s]
  const double now = value_of(heading);
  const T x = (1.0 / kWidth) * (angle_difference(line + now, kHelperGapHeading) - now + heading);
  const T bell = 1.0 / (1.0 + x * x);
  return (car.helper_gap * 2.0 / (kPi * kWidth)) * sqrt(yaw_rate * yaw_rate + kLeastRate * kLeastRate) *
         bell * bell;
}

}  // namespace chicane::model
