// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "chicane/base/math.hpp"
#include "chicane/model/vehicle.hpp"

namespace chicane::model {

/// Slopes of the axles' lateral forces over their slip angles, divided by the car's mass [m/s² per rad].
struct AxleSlopes {
  double front;
  double rear;
};

/// One over the static stability at speed v [m/s]: (1 − h) v² (a k_f − b k_r) over k_f k_r L². Above 1 the
/// car turns away from its path by itself; negative where it understeers, infinite where the rear axle
/// slides, −1 where only the front one does.
[[nodiscard]] inline double static_instability(const VehicleParams& car, double v,
                                               const AxleSlopes& k) noexcept {
  if (!(k.rear > 0.0)) return std::numeric_limits<double>::infinity();
  if (!(k.front > 0.0)) return -1.0;
  return (1.0 - car.steer_helper) * v * v * (car.front_axle * k.front - car.rear_axle * k.rear) /
         (k.front * k.rear * car.wheelbase() * car.wheelbase());
}

/// The right-most real part of the poles of yaw and sideslip [1/s] at speed v > 0 [m/s]; slopes of any sign.
[[nodiscard]] inline double yaw_pole(const VehicleParams& car, double v, const AxleSlopes& k) noexcept {
  const double a = car.front_axle, b = car.rear_axle, wheelbase = car.wheelbase();
  const double turn = car.mass / car.yaw_inertia;
  const double damping = 0.5 * (k.front + k.rear + turn * (a * a * k.front + b * b * k.rear)) / v;
  const double spring = turn * (k.front * k.rear * wheelbase * wheelbase / (v * v) -
                                (1.0 - car.steer_helper) * (a * k.front - b * k.rear));
  return std::sqrt(std::max(damping * damping - spring, 0.0)) - damping;
}

/// Bound on braking in a bend, so that the car does not turn away from its path faster than a controller with
/// delay can catch. Braking unloads the rear axle, whose tyres then use more of their curve than the front
/// ones and answer less to more slip (docs/controller.md, eq. 14a–14c).
class BrakingStability {
 public:
  /// The unstable pole that is left to the controller: in 100 ms an error grows by a tenth [1/s].
  static constexpr double kMostPole = 1.0;

  /// `most_pole`: that is left to the controller [1/s]. Takes some 0.1 ms.
  explicit BrakingStability(const VehicleParams& car, double most_pole = kMostPole) noexcept;

  /// Largest braking force over mass [m/s²] that leaves the car at speed v [m/s] no pole above that.
  /// `use` is the share of its grip that it uses sideways; more than 1 counts as 1. From a table, in 10 ns.
  /// Infinite where the tyres do not share force between the directions.
  [[nodiscard]] double most_braking(double v, double use) const noexcept;
  /// The same with continuous slopes, for searches: equal at the table's values, elsewhere through them by
  /// cubics. T is double, or holds derivatives. Pre: the tyres share force.
  template <class T>
  [[nodiscard]] T smooth_most_braking(const T& v, const T& use) const noexcept {
    const auto [i, up] = cell<kSpeeds>(T((v - kLeastSpeed) * (1.0 / kSpeedStep)));
    const auto [k, on] = cell<kUses>(T(use * (kUses - 1.0)));
    T at[4];
    for (int q = -1; q <= 2; ++q) {
      T along[4];
      for (int p = -1; p <= 2; ++p) along[p + 1] = T(value(i + q, k + p));
      at[q + 1] = cubic(along, on);
    }
    return cubic(at, up);
  }
  /// The share of its grip that the car uses sideways with a lateral acceleration by tyres [m/s²] at speed v.
  template <class T>
  [[nodiscard]] T use(const T& lateral, const T& v) const noexcept {
    const T load = car_.load_constant + (car_.load_per_speed + car_.load_quadratic * v) * v;
    return lateral / (friction_ * load);
  }
  /// The right-most real part of the poles of yaw and sideslip [1/s] at speed v > 0 [m/s] and braking force
  /// over mass `force` >= 0 [m/s²], with the slopes that the tyres' curves have there;
  /// infinite where the rear axle slides.
  [[nodiscard]] double pole(double v, double use, double force) const noexcept;

  /// The car it was made for.
  [[nodiscard]] const VehicleParams& vehicle() const noexcept { return car_; }

 private:
  struct Axle {
    double cornering = 0.0;  ///< [1/rad]
    double share = 0.0;      ///< share of the load at rest
    double transfer = 0.0;   ///< share of that load which a unit of braking force over load adds
    double pull = 0.0;       ///< the axle's share of the braking force over its share of the load
  };
  /// Change of the axle's lateral force by its slip angle over the car's load [1/rad].
  [[nodiscard]] double slope(const Axle& axle, double use, double force_over_load) const noexcept;

  /// Cell of a table of kSize values: its first index, and the weight of the next value.
  template <int kSize, class T>
  [[nodiscard]] static std::pair<int, T> cell(const T& position) noexcept {
    if (!(value_of(position) > 0.0)) return {0, T(0.0)};
    if (!(value_of(position) < kSize - 1.0)) return {kSize - 2, T(1.0)};
    const int i = std::min(static_cast<int>(value_of(position)), kSize - 2);
    return {i, position - static_cast<double>(i)};
  }
  /// Value of the table, continued straight by one row and column.
  [[nodiscard]] double value(int i, int k) const noexcept {
    if (i < 0) return 2.0 * value(0, k) - value(1, k);
    if (i >= kSpeeds) return 2.0 * value(kSpeeds - 1, k) - value(kSpeeds - 2, k);
    const auto& row = most_[static_cast<std::size_t>(i)];
    if (k < 0) return 2.0 * row[0] - row[1];
    if (k >= kUses) return 2.0 * row[kUses - 1] - row[kUses - 2];
    return row[static_cast<std::size_t>(k)];
  }
  /// Interpolates from at[1] to at[2], with the slopes of their neighbours (Catmull, Rom 1974).
  template <class T>
  [[nodiscard]] static T cubic(const T* at, const T& share) noexcept {
    const T out = 0.5 * (at[2] - at[0]);
    const T in = 0.5 * (at[3] - at[1]);
    const T rise = at[2] - at[1];
    return at[1] + share * (out + share * ((3.0 * rise - 2.0 * out - in) + share * (out + in - 2.0 * rise)));
  }

  static constexpr int kSpeeds = 12;
  static constexpr int kUses = 9;
  static constexpr double kLeastSpeed = 8.0;  ///< [m/s]
  static constexpr double kSpeedStep = 8.0;   ///< [m/s]

  VehicleParams car_;
  double friction_ = 1.0;
  Axle front_, rear_;
  std::array<std::array<double, kUses>, kSpeeds> most_{};
};

/// Bound on the rear tyres' slip beyond the peak of their curve, up to which a controller with delay still
/// holds the car: yaw and sideslip have a pole to the right there, and an error grows by it until a command
/// acts (docs/limit.md, eq. 13 to 17). Slips are over the slip at the peak.
class SlidingBound {
 public:
  static constexpr double kMostGrowth = 1.5;  ///< largest growth of an error within the delay
  static constexpr double kFrontSlope = 0.5;  ///< share of the slope at rest that the front tyres keep
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
  /// Share of these bounds in a lap at speed v [m/s], 0 to 1; the remainder is for a lap that does not slide.
  /// Full below 42 m/s, none above 47: an error of place grows with the speed, and at the peak of the tyres
  /// no force is left to correct it.
  template <class T>
  [[nodiscard]] static T share(const T& v) noexcept {
    constexpr double kAll = 42.0, kNone = 47.0;  // [m/s]
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
