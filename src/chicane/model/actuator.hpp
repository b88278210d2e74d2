// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <limits>

#include "chicane/base/math.hpp"
#include "chicane/model/vehicle.hpp"

/// Actuators of a car: lag, rate and range of steering and pedal, and the gap of a steer helper.

namespace chicane::model {

/// Share of a difference that a first-order lag of time constant `lag` [s], 0: none, leaves after dt > 0 [s].
[[nodiscard]] inline double left_by_lag(double lag, double dt) noexcept {
  return lag > 0.0 ? exp(-dt / lag) : 0.0;
}

/// Actuator from demand to value: range, first-order lag, rate limit, in this order (docs/model.md, eq. 13).
/// Exact for a demand that is held over the step while the rate does not bind.
struct Actuator {
  double low = -1.0;                                      ///< least value
  double high = 1.0;                                      ///< largest value
  double lag = 0.0;                                       ///< time constant [s], 0 = none
  double rate = std::numeric_limits<double>::infinity();  ///< largest change of the value [1/s], > 0

  /// The value dt [s] later. Pre: dt >= 0, all finite.
  [[nodiscard]] double next(double value, double asked, double dt) const noexcept {
    const double target = std::clamp(asked, low, high);
    const double share = 1.0 - left_by_lag(lag, dt);
    const double change = std::clamp((target - value) * share, -rate * dt, rate * dt);
    return std::clamp(value + change, low, high);
  }
};

// Gap in the effect of a steer helper: the original simulator's does nothing for one step of physics when the
// heading passes +y, where its yaw angle wraps (docs/limit.md, eq. 11 and 12).

inline constexpr double kHelperGapHeading = 0.5 * kPi;  ///< heading in W [rad]

/// Share of the turn from heading `from` to heading `to` [rad] at which it passes the gap, in (0, 1]; 0: it
/// does not pass it.
[[nodiscard]] inline double helper_gap_within(double from, double to) noexcept {
  const double before = angle_difference(from, kHelperGapHeading);
  const double after = before + (to - from);
  const bool passes = (before < 0.0 && after >= 0.0) || (before > 0.0 && after <= 0.0);
  return passes ? before / (before - after) : 0.0;
}

/// Angle [rad] by which the helper fails to turn the velocity in a gap that is passed at a yaw rate [rad/s].
[[nodiscard]] inline double helper_gap_turn(const VehicleParams& car, double yaw_rate) noexcept {
  return car.steer_helper * car.helper_gap * yaw_rate;
}

/// Share of the helper's effect that is missing at a heading. The gap is spread smoothly over some tenths of
/// a radian; the integral over the turn is that of the gap. `heading` is relative to the direction `line` of
/// the road [rad]. T holds derivatives.
template <class T>
[[nodiscard]] T helper_left_out(double gap, double line, const T& heading, const T& yaw_rate) {
  constexpr double kWidth = 0.12;      // [rad] half width of the spread gap; chosen
  constexpr double kLeastRate = 0.05;  // [rad/s] rounding of |yaw rate|; chosen
  const double now = value_of(heading);
  const T x = (1.0 / kWidth) * (angle_difference(line + now, kHelperGapHeading) - now + heading);
  const T bell = 1.0 / (1.0 + x * x);
  return (gap * 2.0 / (kPi * kWidth)) * sqrt(yaw_rate * yaw_rate + kLeastRate * kLeastRate) * bell * bell;
}

}  // namespace chicane::model
