// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>
#include <vector>

#include "chicane/lap_time/detail/plan_search.hpp"
#include "chicane/lap_time/detail/ring_feedback.hpp"
#include "chicane/road/track.hpp"
#include "chicane/sim/plant.hpp"

namespace chicane::lap_time {

/// What came of driving a plan.
struct DrivenLaps {
  bool is_clean = false;  ///< all laps, without a boundary event since the start
  int laps = 0;
  double best = 0.0;  ///< lap time [s]
  double worst = 0.0;
  double least_edge = 0.0;  ///< of a contact patch to the edge [m]
  double event_s = 0.0;     ///< where the first boundary event was [m]
};

/// Drives a plan in the plant with full state and without latency: what the plan asks for, and feedback.
[[nodiscard]] DrivenLaps drive_plan(const road::Track& track, LimitModel& model, const NodePlan& plan,
                                    sim::Plant& plant, const Tuning& tuning, int laps);

}  // namespace chicane::lap_time
