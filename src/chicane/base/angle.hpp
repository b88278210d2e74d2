// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace chicane {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kTwoPi = 2.0 * kPi;

/// The same angle in (-π, π]. Pre: |angle| < 1e6 rad.
[[nodiscard]] inline double wrap_angle(double angle) noexcept {
  if (angle > -kPi && angle <= kPi) return angle;
  const double turned = angle - kTwoPi * std::floor((angle + kPi) / kTwoPi);
  return turned <= -kPi ? turned + kTwoPi : turned;
}

/// Shortest way from `from` to `to`, counter-clockwise positive, in (-π, π].
[[nodiscard]] inline double angle_difference(double to, double from) noexcept {
  return wrap_angle(to - from);
}

[[nodiscard]] constexpr double degrees_to_radians(double degrees) noexcept { return degrees * (kPi / 180.0); }
[[nodiscard]] constexpr double radians_to_degrees(double radians) noexcept { return radians * (180.0 / kPi); }

/// 1 mph = 0.44704 m/s exactly. The simulator itself multiplies m/s by 2.23693629; its codec uses that
/// number.
[[nodiscard]] constexpr double mph_to_mps(double mph) noexcept { return mph * 0.44704; }
[[nodiscard]] constexpr double mps_to_mph(double mps) noexcept { return mps / 0.44704; }

}  // namespace chicane
