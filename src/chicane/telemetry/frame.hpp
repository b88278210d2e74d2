// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "chicane/controller/controller.hpp"
#include "chicane/model/measurement.hpp"
#include "chicane/model/state.hpp"

namespace chicane::telemetry {

/// One control cycle with all it saw, decided and sent: what viewers draw, logs keep and metrics count. Plain
/// data, about 15 kB, copied without allocation.
struct Frame {
  std::uint64_t cycle = 0;
  double time = 0.0;   ///< of the measurement [s]
  model::State truth;  ///< of the plant; NaN where an external simulator does not tell
  bool has_truth = false;
  model::Measurement measurement;
  controller::StepResult result;
  model::Command applied;  ///< what acts on the plant at `time`, after the delay
  double step_time = 0.0;  ///< of the whole control step [s], wall clock
  double solve_time =
      0.0;  ///< of the optimisation in it [s], wall clock; 0 for controllers that solve nothing
  double lateral_acceleration = 0.0;       ///< of the plant [m/s²], left positive
  double longitudinal_acceleration = 0.0;  ///< of the plant [m/s²]

  // Where the car is on the track (world's judgement, not the controller's).
  double s = 0.0;              ///< along the track's line [m]
  double lateral_error = 0.0;  ///< from the track's line [m], left positive
  double heading_error = 0.0;  ///< [rad]
  double edge_distance = 0.0;  ///< of the outermost contact patch to the edge [m], negative = off the road
  bool is_off_track = false;
  int lap = 0;                 ///< laps completed
  double lap_time = 0.0;       ///< of the running lap [s]
  double last_lap_time = 0.0;  ///< 0 before the first completed lap [s]
  int off_track_events = 0;
};

}  // namespace chicane::telemetry
