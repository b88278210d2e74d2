// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <limits>

#include "chicane/base/result.hpp"
#include "chicane/lap_time/limit.hpp"
#include "chicane/model/stability.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/road/racing_road.hpp"
#include "chicane/road/track.hpp"

namespace chicane::lap_time {

/// Reserves of a plan to race by.
struct RacingPlanOptions {
  double margin = 0.0;       ///< distance of each contact patch to its edge, kerb included [m], >= 0
  double grip_share = 1.0;   ///< share of the friction, (0, 1]
  double slip_share = 1.0;   ///< largest axle slip over the slip of peak force, (0, 2]
  double brake_share = 1.0;  ///< share of the largest useful deceleration, (0, 1]
  bool slides = false;       ///< the rear tyres beyond their peak where model::SlidingBound permits it ...
  double delay = model::SlidingBound::kAssumedDelay;  ///< ... with this delay of the controller [s], > 0
  double speed_limit = 100.0;                         ///< [m/s], > 3
  double time_step = 0.08;                            ///< time between nodes, about [s]; [0.01, 0.2]
  /// Limit of the work [s], > 0 (PlanProgress). The best plan so far is the answer then, the same on every
  /// machine.
  double budget = std::numeric_limits<double>::infinity();
  /// Called with the progress, and the lap time, after each iteration; false ends the search. May be empty.
  std::function<bool(int iteration, double lap_time)> go_on{};
  std::function<void(const PlanProgress&)> on_progress{};  ///< called after each iteration; may be empty
};

/// The fastest lap of a car as a controller models it (model::PredictionModel), with its yaw motion,
/// sideslip, lags and rates: a plan that such a controller can follow (docs/racing.md, eq. 1). Takes 0.2
/// to 30 s and some 10 MB. Deterministic. Keeps nothing between calls.
///
/// An open road's plan enters as it leaves: the same speed and place across the road at both ends.
///
/// kInvalidArgument for a road too narrow for the car or with a bend too tight for its full
/// lock (names the place and the radius), parameters or options out of range, and for a search that was
/// stopped. kNotFound for one that ended without a plan. RacingLine::is_best_so_far where the budget ended
/// it.
[[nodiscard]] Result<road::RacingLine> plan_racing_line(const road::Track& track,
                                                        const model::VehicleParams& vehicle,
                                                        const RacingPlanOptions& options = {});

/// Whether a controller can take the car round: wide enough everywhere, and no bend so tight that nothing of
/// its lock is left to steer by; its centre of mass is at most `beside` from the middle of the road [m].
/// `scale` of the lengths in the message. True of any open road. kInvalidArgument "the bend at s = 211.2 m
/// leaves room for a radius of 10.60 m, and the car's full lock drives no less than 10.44 m", or the width.
[[nodiscard]] Result<void> can_be_driven(const road::Track& track, const model::VehicleParams& vehicle,
                                         double beside, double scale = 1.0);

}  // namespace chicane::lap_time
