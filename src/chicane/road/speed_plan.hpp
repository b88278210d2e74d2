// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "chicane/model/braking_stability.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/road/instalments.hpp"
#include "chicane/road/reference_line.hpp"

namespace chicane::road {

/// Which share of the modelled tyre and brake force the speed plan uses.
struct SpeedPlanOptions {
  double speed_limit = 60.0;    ///< [m/s]
  double grip_share = 0.9;      ///< of the tyres' lateral force; (0, 1]
  double brake_share = 0.8;     ///< of the braking; (0, 1]
  double drive_share = 1.0;     ///< of the drive; (0, 1]
  double end_curvature = 0.05;  ///< assumed behind the end of an open line [1/m]: sight limits the speed

  friend bool operator==(const SpeedPlanOptions&, const SpeedPlanOptions&) = default;
};

/// Fastest speed along a line within the modelled grip: a limit for each place from curvature and its slope,
/// then a forward pass for the drive and a backward pass for the brakes, which leaves the car stable
/// (docs/controller.md, eq. 10–14c). A point mass cannot do better; a car whose yaw lags must not either,
/// hence the curvature slope: turning the body takes tyre force, too,
///
///     v² |(1 − h) κ + i κ'| <= grip · friction · load(v),   i = I/(m b) at the front axle, −I/(m a) at the
///     rear.
///
/// Memory is reserved at construction. The work comes in instalments of about 10 ns, 12 for each sample.
class SpeedPlan {
 public:
  explicit SpeedPlan(int capacity) { demand_.resize(static_cast<std::size_t>(capacity)); }

  /// A new plan, for this car. One that is not the last one's takes 0.1 ms.
  void begin(const model::VehicleParams& vehicle, const SpeedPlanOptions& options) noexcept;
  /// Does up to `work` and takes it off; true when every sample of the line has its speed and limiter. Pre:
  /// the same line, at most of the capacity, from begin() on.
  [[nodiscard]] bool advance(int& work, ReferenceLine& line) noexcept;

 private:
  void limit(ReferenceLine& line, int i) noexcept;
  void finish_limits(ReferenceLine& line) noexcept;
  void accelerate(ReferenceLine& line, int turn) noexcept;
  void brake(ReferenceLine& line, int turn) noexcept;

  model::VehicleParams vehicle_;
  model::BrakingStability stability_{vehicle_};
  SpeedPlanOptions options_;
  Instalments instalments_;
  std::vector<double> demand_;  ///< tyre force per v² [1/m], by sample
  int slowest_ = 0;             ///< sample of the lowest limit: the passes round a closed line begin there
};

}  // namespace chicane::road
