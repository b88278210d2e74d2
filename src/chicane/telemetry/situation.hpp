// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include "chicane/base/word.hpp"
#include "chicane/controller/guard_words.hpp"
#include "chicane/road/corners.hpp"

namespace chicane::telemetry {

struct Frame;

/// Rows of the table of situations (situation.cpp), the weightier ones last.
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

/// State of a run in a control cycle, for people: who drives, what limits the car or stops it, and what ends
/// a stop. Computed from one frame by situation_of(); terminal, dashboard, recordings and bindings show it.
/// Plain data.
struct Situation {
  enum class Driver : std::uint8_t { kController, kGuard, kPerson };

  SituationKind kind = SituationKind::kStands;
  Driver driver = Driver::kController;
  controller::Rung rung = controller::Rung::kController;
  controller::GuardReason reason = controller::GuardReason::kNone;
  /// Of the sentence: used share of the grip [%], or distance beyond the edge [m]; NaN: none.
  double number = std::numeric_limits<double>::quiet_NaN();
  int corner = 0;              ///< from 1, in the order of a lap; 0: unknown
  bool is_ahead = false;       ///< the corner lies ahead of the car
  double pedal = 0.0;          ///< applied, as share of full throttle or of full braking, [-1, 1]
  double since = 0.0;          ///< time of the run at which `kind` began; of an alarm: the event [s]
  double stands_since = -1.0;  ///< time of the run at which the car came to rest [s]; < 0: it moves
  double alarmed_at = -1.0;    ///< time of the run of the last cycle with an alarm [s]; < 0: none yet
  std::uint32_t alarms = 0;    ///< events so far that a person has to know of
  std::string_view remedy{};   ///< SituationTerms::remedy
};

/// What a person can do about a car that is stopped: by the keys of the dashboard, where another program
/// simulates the car, and where another program drives it.
inline constexpr std::string_view kKeysRemedy = "On the dashboard, M takes the wheel and R starts again";
inline constexpr std::string_view kSimulatorRemedy = "Reset the simulator, or drive there by hand";
inline constexpr std::string_view kControllerRemedy = "Restart the controller, or end the run with Ctrl-C";

/// What the cycles of a run have in common.
struct SituationTerms {
  double full_brake = 1.0;                  ///< VehicleParams::brake_throttle_limit
  std::span<const road::Corner> corners{};  ///< of the track; empty: unknown
  std::string_view remedy = kKeysRemedy;    ///< in static storage
};

/// A sentence that is still true is kept so long [s].
inline constexpr double kSentenceHeld = 0.7;
/// Standing for longer, a car that nobody drives by hand is stuck [s].
inline constexpr double kStuckAfter = 3.0;
/// Alarms with a shorter pause between them are one event [s].
inline constexpr double kAlarmPause = 1.0;

/// Situation of a cycle. Goes by the applied command, the motion, the grip that is used and the guard's
/// verdict of `frame`; `before`: the situation of the cycle before it. No allocation.
[[nodiscard]] Situation situation_of(const Frame& frame, const Situation& before,
                                     const SituationTerms& terms) noexcept;

[[nodiscard]] std::string_view name_of(SituationKind kind) noexcept;        ///< "part_throttle"
[[nodiscard]] std::string_view name_of(Situation::Driver driver) noexcept;  ///< "controller"
[[nodiscard]] std::string_view name_of(Severity severity) noexcept;         ///< "normal", "notice", "alarm"
[[nodiscard]] Severity severity_of(const Situation& situation) noexcept;    ///< kError: an alarm
/// At most six words: "Grip: 97 % in T4".
[[nodiscard]] std::string sentence_of(const Situation& situation);
/// Why, in a clause: "the controller has no answer"; empty where the sentence says it.
[[nodiscard]] std::string_view reason_of(const Situation& situation) noexcept;
/// What ends an alarm, with the key or command by which a person does; empty without an alarm.
[[nodiscard]] std::string what_ends(const Situation& situation);

}  // namespace chicane::telemetry
