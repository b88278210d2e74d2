// SPDX-License-Identifier: MIT
// Frame: all that one control cycle measured, decided and sent; and the situation of the car in words.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include "chicane/base/text.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/controller/guard_words.hpp"
#include "chicane/model/state.hpp"
#include "chicane/road/track.hpp"
#include "chicane/safety/guard_options.hpp"

namespace chicane::telemetry {

struct Frame;

/// Kinds of situations, the rows of the table in frame.cpp. If several hold, the last one counts.
enum class SituationKind : std::uint8_t {
  kStands,
  kGrip,
  kBrakes,
  kFullThrottle,
  kRolls,
  kPartThrottle,
  kPersonDrives,
  kOtherSteering,
  kWeakBrakes,
  kThrottleLimited,
  kStopReported,
  kOffRoad,
  kLastPlan,
  kReturnsToRoad,
  kStopsWithoutPlan,
  kControllerStops,
  kGuardStops,
  kGuardHolds,
  kStuck
};

/// Situation of a run in a control cycle, for people: who drives, what limits or stops the car, and what ends
/// a stop. Computed by situation_of(); shown by terminal, dashboard, recordings and bindings. Plain data.
struct Situation {
  enum class Driver : std::uint8_t { kController, kGuard, kPerson };

  SituationKind kind = SituationKind::kStands;
  Driver driver = Driver::kController;
  controller::Rung rung = controller::Rung::kController;
  controller::GuardReason reason = controller::GuardReason::kNone;
  /// Number of the sentence: used share of the grip [%], or distance beyond the edge [m]; NaN: none.
  double number = std::numeric_limits<double>::quiet_NaN();
  int corner = 0;              ///< number from 1, in the order of a lap; 0: unknown
  bool is_ahead = false;       ///< the corner lies ahead of the car
  double pedal = 0.0;          ///< applied, as share of full throttle or of full braking, [-1, 1]
  double kind_since = 0.0;     ///< time of the run at which `kind` began [s]
  double event_since = -1.0;   ///< time of the run at which the newest alarm began [s]; < 0: none yet
  double stands_since = -1.0;  ///< time of the run at which the car came to rest [s]; < 0: it moves
  double alarmed_at = -1.0;    ///< time of the run of the last cycle with an alarm [s]; < 0: none yet
  std::uint32_t alarms = 0;    ///< count of alarms, with repetitions within kAlarmPause as one
  std::string_view remedy{};   ///< SituationTerms::remedy
};

/// Remedies for a stopped car: with a dashboard, with a car of another program, and with a controller of
/// another program.
inline constexpr std::string_view kKeysRemedy = "On the dashboard, M takes the wheel and R starts again";
inline constexpr std::string_view kSimulatorRemedy = "Reset the simulator, or drive there by hand";
inline constexpr std::string_view kControllerRemedy = "Restart the controller, or end the run with Ctrl-C";

/// Terms of a run that situation_of() needs in each cycle.
struct SituationTerms {
  double full_brake = 1.0;                  ///< VehicleParams::brake_throttle_limit
  std::span<const road::Corner> corners{};  ///< corners of the track; empty: unknown
  std::string_view remedy = kKeysRemedy;    ///< text in static storage
};

// Chosen for people who read the sentences.
/// Time for which a sentence on the motion is kept while it is still true [s].
inline constexpr double kSentenceHeld = 0.7;
/// Time at standstill after which a car without a person at the wheel is stuck [s].
inline constexpr double kStuckAfter = 3.0;
/// Pause between two alarms below which they are one [s].
inline constexpr double kAlarmPause = 1.0;

/// Situation of a cycle, by the applied command, the motion, the used grip and the guard's report in `frame`.
/// `before`: situation of the cycle before. No allocation.
[[nodiscard]] Situation situation_of(const Frame& frame, const Situation& before,
                                     const SituationTerms& terms) noexcept;

[[nodiscard]] std::string_view name_of(SituationKind kind) noexcept;        ///< "part_throttle"
[[nodiscard]] std::string_view name_of(Situation::Driver driver) noexcept;  ///< "controller"
[[nodiscard]] std::string_view name_of(Severity severity) noexcept;         ///< "normal", "notice", "alarm"
[[nodiscard]] Severity severity_of(const Situation& situation) noexcept;    ///< kError: an alarm
/// Sentence of at most six words: "Grip: 97 % in T4".
[[nodiscard]] std::string sentence_of(const Situation& situation);
/// Reason in a clause: "the controller has no answer"; empty if the sentence says it.
[[nodiscard]] std::string_view reason_of(const Situation& situation) noexcept;
/// Sentences on what ends an alarm, with the remedy; empty without an alarm.
[[nodiscard]] std::string what_ends(const Situation& situation);

/// Completed lap, for viewers and logs; number 0: none yet.
struct CompletedLap {
  int lap = 0;                           ///< number of the lap, from 1
  double lap_time = 0.0;                 ///< [s]
  std::array<double, 3> sector_times{};  ///< thirds of the lap [s]
  bool is_clean = false;                 ///< no tyre left the road
  double mean_speed = 0.0;               ///< mean over time [m/s]
  double top_speed = 0.0;                ///< [m/s]
  double min_edge_distance = 0.0;        ///< least gap of the outermost tyre [m], negative = off the road
  double rms_lateral_error = 0.0;        ///< root mean square over time [m]
};

/// One control cycle with everything that it measured, decided and sent: viewers draw it, logs keep it,
/// metrics count it. Plain data, about 15 kB, copied without allocation.
struct Frame {
  std::uint64_t cycle = 0;  ///< number of the cycle
  double time = 0.0;        ///< time of the measurement [s]
  model::State truth;       ///< state of the plant; NaN if an external simulator does not send it
  bool has_truth = false;   ///< `truth` is known
  model::Measurement measurement;
  controller::StepResult result;  ///< result of the controller; its command is the sent one, after the gate
  safety::GuardReport guard;      ///< report of the guard; default if another program drives
  model::Command asked;           ///< the controller's own command, before the gate
  model::Command applied;         ///< command acting on the plant at `time`, after the delay
  bool is_manual = false;         ///< a person drives; the controller's command is `asked`
  double step_time = 0.0;         ///< duration of the whole control step [s], wall clock
  double solve_time = 0.0;        ///< duration of the optimisation [s], wall clock; 0 without a solver
  double lateral_acceleration = 0.0;       ///< acceleration of the plant [m/s²], left positive
  double longitudinal_acceleration = 0.0;  ///< acceleration of the plant [m/s²]
  /// Share of the grip that the plant's front and rear axle use (sim::PlantOutput); NaN: unknown.
  std::array<double, 2> tire_use{std::numeric_limits<double>::quiet_NaN(),
                                 std::numeric_limits<double>::quiet_NaN()};
  /// Distance of the car from the position that a plan predicted one delay and one period ago [m]; NaN:
  /// unknown.
  double prediction_error = std::numeric_limits<double>::quiet_NaN();
  double pace = 1.0;                ///< run seconds per second of the clock
  std::uint32_t active_faults = 0;  ///< bits in the order of the fault registry (sim/fault.hpp)

  // Place of the car on the track, by a judge independent of the controller.
  bool is_judged = false;  ///< false: only the two errors are valid, with respect to the controller's line
  double s = 0.0;          ///< position along the track's line [m]
  double lateral_error = 0.0;  ///< offset from the track's line [m], left positive
  double heading_error = 0.0;  ///< heading relative to the track's line [rad], left positive
  double edge_distance = 0.0;  ///< gap of the outermost contact patch to the edge [m]; negative: off the road
  bool is_off_track = false;   ///< a contact patch is off the road
  int lap = 0;                 ///< laps completed
  double lap_time = 0.0;       ///< time since the running lap began [s]
  double last_lap_time = 0.0;  ///< time of the last lap [s]; 0 before the first completed lap
  int off_track_events = 0;    ///< times that a contact patch left the road in this run
  CompletedLap completed_lap;  ///< last completed lap
  Situation situation;         ///< situation of the cycle, for people

  // Further inputs of the command, from which, with settings and measurement, it is computed again.
  bool begins = false;                  ///< controller and gate were reset before this cycle
  bool has_measurement = true;          ///< false: missing or unusable; the controller did not compute
  model::Command manual;                ///< command of a person, while is_manual
  double gate_interval = 0.0;           ///< time since the previous command, by the gate's clock [s]
  double longest_interval = 0.0;        ///< ControlCycle::longest() [s]
  std::uint32_t deadline_spent_at = 0;  ///< DeadlineLog::spent_at of the control step
};

}  // namespace chicane::telemetry
