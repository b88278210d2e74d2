// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "chicane/controller/explanation.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/path/path.hpp"

namespace chicane::controller {

/// How much of the believed car the speed plan uses.
struct SpeedPlanOptions {
  double speed_limit = 60.0;    ///< [m/s]
  double grip_share = 0.9;      ///< of the tyres' lateral force; (0, 1]
  double brake_share = 0.8;     ///< of the braking; (0, 1]
  double drive_share = 1.0;     ///< of the drive; (0, 1]
  double end_curvature = 0.05;  ///< assumed behind the end of an open path [1/m]: sight limits the speed

  friend bool operator==(const SpeedPlanOptions&, const SpeedPlanOptions&) = default;
};

/// Fastest speed along a path within the believed grip: a limit for each place from curvature and its slope,
/// then a forward pass for the drive and a backward pass for the brakes (docs/tracking.md, eq. 10–14). A
/// point mass cannot do better; a car whose yaw lags must not either, hence the curvature slope: turning the
/// body takes tyre force, too,
///
///     v² |(1 − h) κ + i κ'| <= grip · friction · load(v),   i = I/(m b) at the front axle, −I/(m a) at the
///     rear.
///
/// Memory is reserved at construction; rebuild() allocates nothing and costs about 0.2 µs per sample.
class SpeedPlan {
 public:
  static constexpr int kCapacity = 8192;
  SpeedPlan();

  /// Plans anew for the whole of `path`. An empty path clears the plan.
  void rebuild(const path::Path& path, const model::VehicleParams& vehicle,
               const SpeedPlanOptions& options) noexcept;

  struct Sample {
    double speed = 0.0;                          ///< [m/s]
    double slope = 0.0;                          ///< dv/ds [1/s]
    SpeedLimiter limiter = SpeedLimiter::kNone;  ///< which pass bound it at the sample before s
  };
  /// Speed at arc length s (wrapped when closed, held beyond open ends).
  [[nodiscard]] Sample at(double s) const noexcept;

 private:
  std::vector<double> speed_;
  std::vector<SpeedLimiter> limiter_;
  double spacing_ = 1.0;
  int count_ = 0;
  bool is_closed_ = false;
};

}  // namespace chicane::controller
