// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <span>
#include <string_view>

#include "chicane/base/deadline.hpp"
#include "chicane/base/vec2.hpp"
#include "chicane/controller/explanation.hpp"
#include "chicane/controller/plan.hpp"
#include "chicane/model/measurement.hpp"
#include "chicane/model/state.hpp"
#include "chicane/solver/solution.hpp"

namespace chicane::road {
class RacingRoad;
}

namespace chicane::controller {

/// What a controller's step came to.
enum class Answer : signed char {
  kNone = 0,          ///< no command: the guard falls back on the last plan (safety/guard.hpp)
  kDrive = 1,         ///< the command is the first of the plan
  kStopOnRoad = 2,    ///< no plan: the command stops the car along the known road
  kReturnToRoad = 3,  ///< no plan: the command leads back to the road at walking pace
};

/// Who chose the command of a cycle, worst last but for the two that a controller chooses without a plan. Set
/// by safety::Guard alone.
enum class Rung : signed char {
  kController = 0,    ///< the controller's own answer
  kShiftedPlan = 1,   ///< the last usable plan, at the time that has come
  kHoldAndBrake = 2,  ///< steering along the last plan's path, gentle braking
  kBrake = 3,         ///< the same steering, all useful braking
  kReturnToRoad = 4,  ///< the controller's own: Answer::kReturnToRoad
  kStopOnRoad = 5,    ///< the controller's own: Answer::kStopOnRoad
  kGuardStop = 6,     ///< the guard's verified stop on the known road (safety/stop_planner.hpp)
};
inline constexpr int kRungCount = 7;

/// Why the guard did not send the controller's answer, or would not have (docs/safety.md, table of
/// conditions). The worst one holds: later ones win.
enum class GuardReason : signed char {
  kNone = 0,
  kNoAnswer = 1,           ///< the controller had none
  kNotMeasured = 2,        ///< position, yaw or speed unknown for longer than is tolerated
  kFrozen = 3,             ///< measurements repeat although the car moves
  kSpeedMismatch = 4,      ///< measured speed and measured displacement contradict each other
  kHeadingJump = 5,        ///< measured yaw changed as no car turns
  kPositionJump = 6,       ///< measured position changed as no car moves
  kNoWayToStop = 7,        ///< after the answer the car could not be stopped on the road any more
  kFarFromRoad = 8,        ///< there is no answer, and the car is far beside the road that is known
  kTooFastForSilence = 9,  ///< after the answer a receiver left alone could not: it is sent, braking
};
inline constexpr int kGuardReasonCount = 10;
/// As reports name them.
inline constexpr std::array<std::string_view, kGuardReasonCount> kGuardReasonNames{
    "none",         "no_answer",     "not_measured",   "frozen",        "speed_mismatch",
    "heading_jump", "position_jump", "no_way_to_stop", "far_from_road", "too_fast_for_silence"};

/// How one step went.
struct StepReport {
  solver::SolveReport solve{.status = solver::SolveStatus::kOptimal};  ///< as it is where nothing is solved
  double act_time = std::numeric_limits<double>::quiet_NaN();  ///< when the command acts [s], clock of the
                                                               ///< run; NaN: measurement time plus its delay
  double lateral_error = 0.0;    ///< of the measured position from the reference line [m], left positive
  double heading_error = 0.0;    ///< measured yaw minus the line's heading [rad]
  double speed_reference = 0.0;  ///< wanted at the point where the command acts [m/s]
  double delay = 0.0;            ///< compensated: from measurement to actuation [s]
  double sight = 0.0;            ///< length of known road ahead [m]
  double solve_time = 0.0;  ///< of the optimisation alone [s], as the deadline's clock saw it; 0 without one
  bool has_map = false;     ///< the lap is closed in memory
  Explanation explanation;  ///< why the answer is what it is; empty without an answer

  // The guard's word, not the controller's.
  Rung rung = Rung::kController;
  bool gated = false;                       ///< the command gate had to change the command
  GuardReason reason = GuardReason::kNone;  ///< with mode `observe` also where nothing was done about it
  double stop_edge = std::numeric_limits<double>::quiet_NaN();  ///< of the stop at hand: least distance of a
                                                                ///< tyre to the known edge [m]
  double stop_distance = std::numeric_limits<double>::quiet_NaN();  ///< and its length [m]; NaN: none at hand
};

struct StepResult {
  Answer answer = Answer::kDrive;
  model::Command command;  ///< finite and inside the vehicle's limits; without meaning for Answer::kNone
  Plan plan;               ///< empty for any answer but kDrive
  StepReport report;
};

/// A lap that a controller wants to be planned, from what it has learned of road and grip.
struct LapWish {
  bool is_wanted = false;
  std::span<const Vec2> waypoints{};  ///< of the closed road that was learned, in driving order; empty: the
                                      ///< track's, which is known
  double grip = 1.0;                  ///< over the one that the vehicle's parameters tell
};

/// The contract every controller fulfils: a measurement goes in, an answer or none comes out. What happens
/// without an answer is not the controller's concern: safety::Guard decides it, for all controllers alike.
///
/// step() is noexcept, allocates nothing, takes no lock and reads no clock but the deadline's. It accepts any
/// measurement, also one with NaN or without waypoints. The result stays valid until the next call. One
/// thread; different objects are independent.
class Controller {
 public:
  virtual ~Controller() = default;
  [[nodiscard]] virtual const StepResult& step(const model::Measurement& now, Deadline deadline) noexcept = 0;
  /// After each step(): what was really sent, which may be another command than the step's.
  virtual void note_sent(const model::Command& /*command*/) noexcept {}
  /// A planned lap to race by from the next step() on; null: none any more. Controllers that follow the
  /// waypoints do not care. Allocates nothing.
  virtual void use_line(std::shared_ptr<const road::RacingRoad> /*lap*/) noexcept {}
  /// The lap to race by that the controller would rather have than what it drives by. Valid until step().
  [[nodiscard]] virtual LapWish wants_lap() const noexcept { return {}; }
  /// Forget everything learned (map, warm start): a new run begins. A planned lap stays, one of a road that
  /// was learned does not.
  virtual void reset() noexcept = 0;
  [[nodiscard]] virtual std::string_view name() const noexcept = 0;
  /// Names of Explanation's cost terms and of the bits of its active constraints; empty for none.
  [[nodiscard]] virtual std::span<const std::string_view> cost_terms() const noexcept { return {}; }
  [[nodiscard]] virtual std::span<const std::string_view> constraints() const noexcept { return {}; }
};

}  // namespace chicane::controller
