// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/controller/baselines.hpp"
#include "chicane/controller/explanation.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/road/path.hpp"

namespace chicane::controller {

/// Speed hold shared by the baselines: a proportional law on top of what drag costs, towards a reference that
/// slows for the curvature ahead. No allocation.
class SpeedHold {
 public:
  SpeedHold(const SpeedHoldOptions& options, const model::VehicleParams& vehicle) noexcept
      : options_{options}, vehicle_{vehicle} {}
  void configure(const SpeedHoldOptions& options, const model::VehicleParams& vehicle) noexcept {
    options_ = options;
    vehicle_ = vehicle;
  }

  struct Wanted {
    double speed = 0.0;  ///< [m/s]
    SpeedLimiter limiter = SpeedLimiter::kAsked;
  };
  /// Speed wanted at arc length s of `path`: at most the reference, and slow enough to meet v² |κ| <= limit
  /// everywhere ahead with comfortable braking.
  [[nodiscard]] Wanted reference(const road::Path& path, double s) const noexcept;
  /// Pedal in [-brake_throttle_limit, 1] towards `wanted` [m/s] at speed v [m/s].
  [[nodiscard]] double throttle(double wanted, double v) const noexcept;

 private:
  SpeedHoldOptions options_;
  model::VehicleParams vehicle_;
};

}  // namespace chicane::controller
