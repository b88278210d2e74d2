// SPDX-License-Identifier: MIT
// Elementary functions with the same bits everywhere, choices as functions, angles and unit conversions.
#pragma once

#include <cmath>

namespace chicane {

/// Elementary functions with the same bits on every machine, compiler and build type: plain IEEE additions
/// and multiplications in a fixed order, no library call (the C library picks another kernel, with other last
/// bits, for each processor). Algorithms and coefficients after fdlibm (Sun Microsystems, 1993, freely
/// distributable); error below 1 ulp in the stated ranges, NaN in gives NaN out. No allocation, no errno.
[[nodiscard]] double sin(double x) noexcept;  ///< |x| < 1e6 [rad]; error grows with |x| beyond
[[nodiscard]] double cos(double x) noexcept;  ///< same range as sin
/// Sine and cosine of one angle.
struct SineCosine {
  double sine, cosine;
};
[[nodiscard]] SineCosine sine_cosine(double x) noexcept;  ///< same bits as sin and cos, in the time of one
[[nodiscard]] double tan(double x) noexcept;              ///< sin / cos: error up to 2 ulp
[[nodiscard]] double atan(double x) noexcept;             ///< all x
[[nodiscard]] double atan2(double y,
                           double x) noexcept;  ///< all x and y; angle in [-π, π] of the point (x, y)
[[nodiscard]] double exp(double x) noexcept;    ///< |x| < 700, saturates to 0 and infinity beyond
[[nodiscard]] double log(double x) noexcept;    ///< x > 0; NaN for x < 0, -inf for 0
[[nodiscard]] double tanh(double x) noexcept;   ///< error up to 4 ulp
[[nodiscard]] double asin(double x) noexcept;   ///< error up to 4 ulp; NaN beyond ±1
[[nodiscard]] double acos(double x) noexcept;   ///< same range and accuracy as asin
/// Power. Whole exponents up to ±64 by multiplication, for any x; others as exp(exponent · log(x)): NaN for x
/// < 0, relative error about (2 + |exponent · log(x)|) ulp.
[[nodiscard]] double pow(double x, double exponent) noexcept;

/// Functions whose bits IEEE 754 prescribes. hypot is infinite from 1.3e154 on.
[[nodiscard]] inline double sqrt(double x) noexcept { return std::sqrt(x); }
[[nodiscard]] inline double abs(double x) noexcept { return std::fabs(x); }
[[nodiscard]] inline double hypot(double x, double y) noexcept { return std::sqrt(x * x + y * y); }

/// The number itself. Templates over any scalar call value_of(), which packs and symbols overload.
[[nodiscard]] constexpr double value_of(double x) noexcept { return x; }

/// Choices as functions, for templates over any scalar: packs and jets, which cannot branch, overload them.
[[nodiscard]] constexpr double select(bool chosen, double a, double b) noexcept { return chosen ? a : b; }
[[nodiscard]] constexpr double max(double a, double b) noexcept { return a > b ? a : b; }
[[nodiscard]] constexpr double min(double a, double b) noexcept { return a < b ? a : b; }
[[nodiscard]] constexpr double positive_part(double x) noexcept { return x > 0.0 ? x : 0.0; }

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kTwoPi = 2.0 * kPi;

/// The angle, brought into (-π, π] by whole turns. Pre: |angle| < 1e6 rad.
[[nodiscard]] inline double wrap_angle(double angle) noexcept {
  if (angle > -kPi && angle <= kPi) return angle;
  const double turned = angle - kTwoPi * std::floor((angle + kPi) / kTwoPi);
  return turned <= -kPi ? turned + kTwoPi : turned;
}

/// Shortest turn from `from` to `to`, counter-clockwise positive, in (-π, π].
[[nodiscard]] inline double angle_difference(double to, double from) noexcept {
  return wrap_angle(to - from);
}

[[nodiscard]] constexpr double degrees_to_radians(double degrees) noexcept { return degrees * (kPi / 180.0); }
[[nodiscard]] constexpr double radians_to_degrees(double radians) noexcept { return radians * (180.0 / kPi); }

/// Conversion by the definition 1 mph = 0.44704 m/s. Udacity's simulator rounds the inverse to 2.23693629:
/// the codec and the car of that simulator use this number in place of mps_to_mph().
[[nodiscard]] constexpr double mph_to_mps(double mph) noexcept { return mph * 0.44704; }
[[nodiscard]] constexpr double mps_to_mph(double mps) noexcept { return mps / 0.44704; }

}  // namespace chicane
