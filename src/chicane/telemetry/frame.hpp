// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "chicane/controller/controller.hpp"
#include "chicane/model/measurement.hpp"
#include "chicane/model/state.hpp"
#include "chicane/safety/guard_report.hpp"
#include "chicane/telemetry/situation.hpp"

namespace chicane::telemetry {

/// A completed lap, for viewers and logs. lap = 0: none yet.
struct CompletedLap {
  int lap = 0;                           ///< its number, from 1
  double lap_time = 0.0;                 ///< [s]
  std::array<double, 3> sector_times{};  ///< thirds of the lap [s]
  bool is_clean = false;                 ///< no tyre left the road
  double mean_speed = 0.0;               ///< over time [m/s]
  double top_speed = 0.0;                ///< [m/s]
  double min_edge_distance = 0.0;        ///< of the outermost tyre [m], negative = off the road
  double rms_lateral_error = 0.0;        ///< over time [m]
};

/// One control cycle with all it saw, decided and sent: what viewers draw, logs keep and metrics count. Plain
/// data, about 15 kB, copied without allocation.
struct Frame {
  std::uint64_t cycle = 0;
  double time = 0.0;   ///< of the measurement [s]
  model::State truth;  ///< of the plant; NaN where an external simulator does not tell
  bool has_truth = false;
  model::Measurement measurement;
  controller::StepResult result;  ///< its command is the one sent: after the gate
  safety::GuardReport guard;      ///< of the cycle; as it is at first where another program drives
  model::Command asked;           ///< the controller's own command, before the gate
  model::Command applied;         ///< what acts on the plant at `time`, after the delay
  bool is_manual = false;         ///< a person drives; the controller's command is `asked`
  double step_time = 0.0;         ///< of the whole control step [s], wall clock
  double solve_time =
      0.0;  ///< of the optimisation in it [s], wall clock; 0 for controllers that solve nothing
  double lateral_acceleration = 0.0;       ///< of the plant [m/s²], left positive
  double longitudinal_acceleration = 0.0;  ///< of the plant [m/s²]
  /// Share of its grip that each axle of the plant uses, front and rear (sim::PlantOutput); NaN unknown.
  std::array<double, 2> tire_use{std::numeric_limits<double>::quiet_NaN(),
                                 std::numeric_limits<double>::quiet_NaN()};
  /// Distance of the car from where plans said it would be, one delay and one period ago [m]; NaN unknown.
  double prediction_error = std::numeric_limits<double>::quiet_NaN();
  double pace = 1.0;                ///< run seconds per second of the clock
  std::uint32_t active_faults = 0;  ///< bits in the order of the fault registry (sim/fault.hpp)

  // Where the car is on the track: a judge's word, not the controller's.
  bool is_judged = false;      ///< else of these only the errors mean something: from the controller's line
  double s = 0.0;              ///< along the track's line [m]
  double lateral_error = 0.0;  ///< from the track's line [m], left positive
  double heading_error = 0.0;  ///< [rad]
  double edge_distance = 0.0;  ///< of the outermost contact patch to the edge [m], negative = off the road
  bool is_off_track = false;
  int lap = 0;                 ///< laps completed
  double lap_time = 0.0;       ///< of the running lap [s]
  double last_lap_time = 0.0;  ///< 0 before the first completed lap [s]
  int off_track_events = 0;
  CompletedLap completed_lap;  ///< the last one
  Situation situation;         ///< of the cycle, for people

  // What else decided the command: with the settings and the measurement, enough to compute it again.
  bool begins = false;                  ///< controller and gate had forgotten everything
  bool has_measurement = true;          ///< false: what came was unusable, the controller was not asked
  model::Command manual;                ///< a person's command, while is_manual
  double gate_interval = 0.0;           ///< since the command before, by the gate's clock [s]
  std::uint32_t deadline_spent_at = 0;  ///< DeadlineLog::spent_at of the control step
};

}  // namespace chicane::telemetry
