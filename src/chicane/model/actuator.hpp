// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <limits>

#include "chicane/base/math.hpp"
#include "chicane/model/vehicle.hpp"

namespace chicane::model {

/// Time constant above which steering counts as slow [s of a car in full size]: the demand then runs far
/// ahead of the wheel, and controller and gate limit the rate of the wheel. Below, they limit the rate of the
/// demand, for which weights and limits of cars in full size were chosen
/// (docs/decisions/0039-rates-of-slow-steering.md).
inline constexpr double kSlowSteering = 0.3;

/// Actuator from demand to wheel: range, first-order lag, rate limit, in this order (docs/model.md, eq. 13).
/// Exact for a demand that is held over the step while the rate does not bind. Plain data and one function,
/// no allocation.
struct Actuator {
  double low = -1.0;  ///< range of the value
  double high = 1.0;
  double lag = 0.0;                                       ///< time constant [s], 0 = none
  double rate = std::numeric_limits<double>::infinity();  ///< largest change per second, > 0

  /// The value dt [s] later. Pre: dt >= 0, all finite.
  [[nodiscard]] double next(double value, double asked, double dt) const noexcept {
    const double target = std::clamp(asked, low, high);
    const double share = lag > 0.0 ? 1.0 - exp(-dt / lag) : 1.0;
    const double change = std::clamp((target - value) * share, -rate * dt, rate * dt);
    return std::clamp(value + change, low, high);
  }
};

// Gap in the effect of a steer helper: the original simulator's does nothing for one step of physics when the
// heading passes +y, where its yaw angle wraps (docs/limit.md, eq. 11 and 12).

inline constexpr double kHelperGapHeading = 0.5 * kPi;  ///< heading in W [rad]

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
