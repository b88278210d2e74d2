// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "chicane/base/math.hpp"
#include "chicane/model/vehicle.hpp"

namespace chicane::model {

/// How far beyond the peak of their curve the rear tyres may slip so that a controller with delay still holds
/// the car: yaw and sideslip have a pole to the right there, and an error grows by it until a command acts
/// (docs/limit.md, eq. 13 to 17). Slips are over that of the peak.
class SlidingBound {
 public:
  static constexpr double kMostGrowth = 1.5;  ///< of an error within the delay
  static constexpr double kFrontSlope = 0.5;  ///< of the curve at rest that the front tyres keep: they steer
  static constexpr double kMostSlip =
      1.5;  ///< two thirds of the way to where the original curve falls most steeply
  static constexpr double kAssumedDelay = 0.14;  ///< [s] 100 ms of latency and a control period

  /// `delay`: from a measurement to its command's effect [s], > 0. Takes some 0.1 ms.
  explicit SlidingBound(const VehicleParams& car, double delay = kAssumedDelay) noexcept;

  /// The longest delay that permits() [s]; 0: none does.
  [[nodiscard]] static double longest_delay(const VehicleParams& car) noexcept;
  /// Whether the car may slide at any speed of the table. False for tyres that share their force between the
  /// directions: drive and brakes change their slopes.
  [[nodiscard]] bool permits() const noexcept { return permits_; }
  /// Most slip of the front tyres.
  [[nodiscard]] double front() const noexcept { return front_; }
  /// Most slip of the rear tyres at speed v [m/s], with continuous slopes: cubics through a table. T is
  /// double, or holds derivatives.
  template <class T>
  [[nodiscard]] T rear(const T& v) const noexcept {
    const T position = (v - kLeastSpeed) * (1.0 / kSpeedStep);
    const double at = std::clamp(value_of(position), 0.0, kSpeeds - 1.0);
    const int i = std::min(static_cast<int>(at), kSpeeds - 2);
    if (at != value_of(position)) return T(value(at > 0.0 ? kSpeeds - 1 : 0));
    const T share = position - static_cast<double>(i);
    const double out = i > 0 ? 0.5 * (value(i + 1) - value(i - 1)) : 0.0;
    const double in = i + 2 < kSpeeds ? 0.5 * (value(i + 2) - value(i)) : 0.0;
    const double rise = value(i + 1) - value(i);
    return value(i) +
           share * (out + share * ((3.0 * rise - 2.0 * out - in) + share * (out + in - 2.0 * rise)));
  }
  /// How much of these bounds a lap has at speed v [m/s], 0 to 1; the rest are those of a lap that does not
  /// slide. All below 42 m/s, nothing above 47. An error of place grows with the speed, and at the peak of
  /// the tyres nothing is left to take it back.
  template <class T>
  [[nodiscard]] static T share(const T& v) noexcept {
    constexpr double kAll = 42.0, kNone = 47.0;
    const T t = (kNone - v) * (1.0 / (kNone - kAll));
    if (value_of(t) <= 0.0) return T(0.0);
    if (value_of(t) >= 1.0) return T(1.0);
    return t * t * (3.0 - 2.0 * t);
  }
  /// Largest value of rear().
  [[nodiscard]] double most_rear() const noexcept { return *std::max_element(rear_.begin(), rear_.end()); }
  /// The right-most real part of the poles of yaw and sideslip [1/s] at speed v > 0 [m/s] with these slips.
  [[nodiscard]] double pole(double v, double front_slip, double rear_slip) const noexcept;

 private:
  static constexpr int kSpeeds = 12;
  static constexpr double kLeastSpeed = 5.0;  ///< [m/s]
  static constexpr double kSpeedStep = 5.0;   ///< [m/s]

  [[nodiscard]] double value(int i) const noexcept {
    return rear_[static_cast<std::size_t>(std::clamp(i, 0, kSpeeds - 1))];
  }
  /// Slope of the tyres' curve over that at rest.
  [[nodiscard]] double slope(double slip) const noexcept;
  /// The largest pole with any slip of the front tyres within their bound.
  [[nodiscard]] double worst_pole(double v, double rear_slip) const noexcept;

  VehicleParams car_;
  double front_ = 1.0;
  std::array<double, kSpeeds> rear_{};
  bool permits_ = false;
};

}  // namespace chicane::model
