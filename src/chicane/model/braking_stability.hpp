// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "chicane/model/vehicle.hpp"

namespace chicane::model {

/// How hard a car may brake in a bend before it turns away from its path faster than a controller with delay
/// can catch: braking unloads the rear axle, whose tyres then use more of their curve than the front ones and
/// answer less to more slip (docs/tracking.md, eq. 14a–14c).
class BrakingStability {
 public:
  /// The unstable pole that is left to the controller: in 100 ms an error grows by a tenth [1/s].
  static constexpr double kMostPole = 1.0;

  /// Takes some 0.1 ms.
  explicit BrakingStability(const VehicleParams& car) noexcept;

  /// Largest braking force over mass [m/s²] that leaves the car at speed v [m/s] no pole above kMostPole.
  /// `use` is the share of its grip that it uses sideways; more than 1 counts as 1. From a table, in 10 ns.
  /// Infinite where the tyres do not share force between the directions.
  [[nodiscard]] double most_braking(double v, double use) const noexcept;
  /// The right-most real part of the poles of yaw and sideslip [1/s] at speed v > 0 [m/s] and braking force
  /// over mass `force` >= 0 [m/s²], with the slopes that the tyres' curves have there;
  /// infinite where the rear axle slides.
  [[nodiscard]] double pole(double v, double use, double force) const noexcept;

  /// The car it was made for.
  [[nodiscard]] const VehicleParams& vehicle() const noexcept { return car_; }

 private:
  struct Axle {
    double cornering = 0.0;  ///< [1/rad]
    double share = 0.0;      ///< of the load at rest
    double transfer = 0.0;   ///< share of that load which a unit of braking force over load adds
    double pull = 0.0;       ///< the axle's share of the braking force over its share of the load
  };
  /// Change of the axle's lateral force by its slip angle over the car's load [1/rad].
  [[nodiscard]] double slope(const Axle& axle, double use, double force_over_load) const noexcept;

  static constexpr int kSpeeds = 12;
  static constexpr int kUses = 9;
  static constexpr double kLeastSpeed = 8.0;  ///< [m/s]
  static constexpr double kSpeedStep = 8.0;   ///< [m/s]

  VehicleParams car_;
  double friction_ = 1.0;
  Axle front_, rear_;
  std::array<std::array<double, kUses>, kSpeeds> most_{};
};

}  // namespace chicane::model
