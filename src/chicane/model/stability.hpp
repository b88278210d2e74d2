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

/// Stability of yaw and sideslip: the poles of a car, and bounds on braking and on slip up to which a
/// controller with delay can catch it.

namespace chicane::model {

/// Slopes of the axles' lateral forces over their slip angles, divided by the car's mass [m/s² per rad].
struct AxleSlopes {
  double front;
  double rear;
};

/// Static instability at speed v [m/s]: (1 − h) v² (a k_f − b k_r) over k_f k_r L². Above 1 the car turns
/// away from its path by itself. Negative for a car that understeers, infinite when the rear axle slides, −1
/// when only the front axle slides.
[[nodiscard]] inline double static_instability(const VehicleParams& car, double v,
                                               const AxleSlopes& k) noexcept {
  if (!(k.rear > 0.0)) return std::numeric_limits<double>::infinity();
  if (!(k.front > 0.0)) return -1.0;
  return (1.0 - car.steer_helper) * v * v * (car.front_axle * k.front - car.rear_axle * k.rear) /
         (k.front * k.rear * car.wheelbase() * car.wheelbase());
}

/// Right-most real part of the poles of yaw and sideslip [1/s] at speed v > 0 [m/s]; slopes of any sign.
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
  /// Largest unstable pole that a controller has to catch [1/s]; chosen: in 100 ms an error grows by a tenth.
  static constexpr double kMostPole = 1.0;

  /// Bound for poles up to `most_pole` [1/s]. Takes some 0.1 ms.
  explicit BrakingStability(const VehicleParams& car, double most_pole = kMostPole) noexcept;

  /// Largest braking force over mass [m/s²] at speed v [m/s] with no pole above the bound. `use`: share of
  /// its grip that the car uses sideways; more than 1 counts as 1. From a table, in 10 ns. Infinite for tyres
  /// that do not share force between the directions.
  [[nodiscard]] double most_braking(double v, double use) const noexcept;
  /// Largest braking force like most_braking(), with continuous slopes, for searches: cubics through the
  /// values of the table. T is double, or holds derivatives. Pre: the tyres share force between the
  /// directions.
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
  /// Share of its grip that the car uses sideways, for a lateral acceleration by tyres [m/s²] at speed v
  /// [m/s].
  template <class T>
  [[nodiscard]] T use(const T& lateral, const T& v) const noexcept {
    const T load = car_.load_constant + (car_.load_per_speed + car_.load_quadratic * v) * v;
    return lateral / (friction_ * load);
  }
  /// Right-most real part of the poles of yaw and sideslip [1/s] at speed v > 0 [m/s] and braking force over
  /// mass `force` >= 0 [m/s²], by the slopes of the tyres' curves there; infinite when the rear axle slides.
  [[nodiscard]] double pole(double v, double use, double force) const noexcept;

  /// Car of this bound.
  [[nodiscard]] const VehicleParams& vehicle() const noexcept { return car_; }

 private:
  /// Axle while braking.
  struct Axle {
    double cornering = 0.0;  ///< [1/rad]
    double share = 0.0;      ///< share of the load at rest
    double transfer = 0.0;   ///< relative change of its load for each unit of braking force over load
    double pull = 0.0;       ///< share of the braking force over share of the load
  };
  /// Slope of an axle's lateral force over its slip angle, divided by the car's load [1/rad].
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

  // Size of the table; chosen: speeds up to 96 m/s, uses in steps of an eighth.
  static constexpr int kSpeeds = 12;
  static constexpr int kUses = 9;
  static constexpr double kLeastSpeed = 8.0;  ///< first speed [m/s]
  static constexpr double kSpeedStep = 8.0;   ///< step of the speeds [m/s]

  VehicleParams car_;
  double friction_ = 1.0;  ///< VehicleParams::cornering_friction()
  Axle front_, rear_;
  std::array<std::array<double, kUses>, kSpeeds> most_{};  ///< table of most_braking() [m/s²]
};

/// Bound on the rear tyres' slip beyond the peak of their curve, up to which a controller with delay still
/// holds the car. Beyond the peak yaw and sideslip have an unstable pole, by which an error grows until a
/// command acts (docs/limit.md, eq. 13 to 17). Slips are relative to the slip at the peak.
class SlidingBound {
 public:
  static constexpr double kMostGrowth = 1.5;  ///< largest growth of an error within the delay; chosen
  static constexpr double kFrontSlope = 0.5;  ///< least slope of the front tyres, over that at rest; chosen
  /// Largest slip; chosen: two thirds of the way to the steepest fall of the original simulator's curve.
  static constexpr double kMostSlip = 1.5;
  static constexpr double kAssumedDelay = 0.14;  ///< 100 ms of latency and a control period of 40 ms [s]

  /// Bound for a delay from a measurement to its command's effect [s], > 0. Takes some 0.1 ms.
  explicit SlidingBound(const VehicleParams& car, double delay = kAssumedDelay) noexcept;

  /// Longest delay for which permits() is true [s]; 0: it never is.
  [[nodiscard]] static double longest_delay(const VehicleParams& car) noexcept;
  /// Whether the car may slide at all speeds of the table. False for tyres that share force between the
  /// directions: drive and brakes change their slopes.
  [[nodiscard]] bool permits() const noexcept { return permits_; }
  /// Largest slip of the front tyres.
  [[nodiscard]] double front() const noexcept { return front_; }
  /// Largest slip of the rear tyres at speed v [m/s], with continuous slopes: cubics through a table. T is
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
  /// Share of these bounds that a lap uses at speed v [m/s], 0 to 1; the rest is the bound of a lap that does
  /// not slide. An error of position grows with the speed, and at the peak of the tyres no force is left to
  /// correct it.
  template <class T>
  [[nodiscard]] static T share(const T& v) noexcept {
    constexpr double kAll = 42.0, kNone = 47.0;  // [m/s] speeds up to which, and from which on; chosen
    const T t = (kNone - v) * (1.0 / (kNone - kAll));
    if (value_of(t) <= 0.0) return T(0.0);
    if (value_of(t) >= 1.0) return T(1.0);
    return t * t * (3.0 - 2.0 * t);
  }
  /// Largest value of rear().
  [[nodiscard]] double most_rear() const noexcept { return *std::max_element(rear_.begin(), rear_.end()); }
  /// Right-most real part of the poles of yaw and sideslip [1/s] at speed v > 0 [m/s] with these slips.
  [[nodiscard]] double pole(double v, double front_slip, double rear_slip) const noexcept;

 private:
  // Size of the table; chosen: speeds up to 60 m/s.
  static constexpr int kSpeeds = 12;
  static constexpr double kLeastSpeed = 5.0;  ///< first speed [m/s]
  static constexpr double kSpeedStep = 5.0;   ///< step of the speeds [m/s]

  /// Value of the table for the i-th speed, or the nearest one.
  [[nodiscard]] double value(int i) const noexcept {
    return rear_[static_cast<std::size_t>(std::clamp(i, 0, kSpeeds - 1))];
  }
  /// Slope of the tyres' curve at a slip, over that at rest.
  [[nodiscard]] double slope(double slip) const noexcept;
  /// Largest pole with any slip of the front tyres within their bound [1/s].
  [[nodiscard]] double worst_pole(double v, double rear_slip) const noexcept;

  VehicleParams car_;
  double front_ = 1.0;                  ///< front()
  std::array<double, kSpeeds> rear_{};  ///< table of rear()
  bool permits_ = false;                ///< permits()
};

}  // namespace chicane::model
