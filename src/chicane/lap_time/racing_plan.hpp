// SPDX-License-Identifier: MIT
// Plans the fastest lap that a controller can follow, with reserves, as the line to drive by.
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

/// Reserves of a racing plan, and limits of its search.
struct RacingPlanOptions {
  double margin = 0.0;       ///< distance of each contact patch to its edge, kerb included [m], >= 0
  double grip_share = 1.0;   ///< used share of the friction, (0, 1]
  double slip_share = 1.0;   ///< largest axle slip, as a share of the slip at peak force, (0, 2]
  double brake_share = 1.0;  ///< used share of the largest useful deceleration, (0, 1]
  bool slides = false;       ///< permits slip beyond the peak, up to model::SlidingBound
  double delay = model::SlidingBound::kAssumedDelay;  ///< delay of the controller, for that bound [s], > 0
  double speed_limit = 100.0;                         ///< largest speed [m/s], > 3
  double time_step = 0.08;  ///< approximate time between nodes [s], in [0.01, 0.2]; chosen
  /// Limit of the work, in seconds of a reference machine: counted, not measured (PlanProgress::work), > 0.
  /// When it is spent the best plan so far is returned, the same on every machine.
  double budget = std::numeric_limits<double>::infinity();
  /// Called after each iteration with its number and its lap time [s], and with 0, 0 while the road is
  /// checked. False ends the search. May be empty.
  std::function<bool(int iteration, double lap_time)> go_on{};
  std::function<void(const PlanProgress&)> on_progress{};  ///< called after each iteration; may be empty
};

/// The fastest lap of a car as a controller models it (model::PredictionModel), with its yaw motion,
/// sideslip, lags and rates: a plan that such a controller can follow (docs/racing.md, eq. 1). Takes 0.2
/// to 30 s and some 10 MB. Deterministic. Keeps nothing between calls.
///
/// A plan of an open road has the same speed and offset at both ends.
///
/// Fails with kInvalidArgument for a road too narrow for the car or with a bend too tight for its full lock
/// (with the place and the radius), for parameters or options out of range, and for a stopped search; with
/// kNotFound for a search that ended without a plan. RacingLine::is_best_so_far is set if the budget ended
/// it.
[[nodiscard]] Result<road::RacingLine> plan_racing_line(const road::Track& track,
                                                        const model::VehicleParams& vehicle,
                                                        const RacingPlanOptions& options = {});

/// Checks that a controller can drive a closed road: it is wide enough everywhere, and no bend needs all of
/// the car's lock. Any open road passes unchecked. `max_offset`: largest distance of the car's centre of mass
/// from the middle of the road [m]. `scale`: factor of the lengths in the message. Fails with
/// kInvalidArgument "the bend at s = 211.2 m leaves room for a radius of 10.60 m, and the car's full lock
/// drives no less than 10.44 m", or with the width.
[[nodiscard]] Result<void> can_be_driven(const road::Track& track, const model::VehicleParams& vehicle,
                                         double max_offset, double scale = 1.0);

}  // namespace chicane::lap_time
