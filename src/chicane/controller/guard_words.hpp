// SPDX-License-Identifier: MIT
// Enumerations of the guard, source of a command (Rung) and reason of an intervention (GuardReason), with
// their words.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "chicane/base/text.hpp"

/// Table of Rung. A row makes the enumerator, its name in JSON, its constant in the messages, its sentence in
/// terminal and dashboard, and its severity in /diagnostics. Rows are numbered in order, and recordings keep
/// the numbers: a new row goes to the end. Columns: enumerator, name, severity, sentence (base/text.hpp).
// clang-format off
#define CHICANE_RUNGS(ROW)                                                                                       \
  ROW(kController, "controller", kOk, "the controller drives")                                                   \
  ROW(kShiftedPlan, "shifted_plan", kWarning, "the car follows the last plan")                                   \
  ROW(kHoldAndBrake, "hold_and_brake", kError, "the car follows the last plan and brakes gently")                \
  ROW(kBrake, "brake", kError, "the car follows the last plan and brakes as hard as is useful")                      \
  ROW(kReturnToRoad, "return_to_road", kWarning, "the controller returns to the road at walking pace")           \
  ROW(kStopOnRoad, "stop_on_road", kError, "the controller has no plan and stops the car along the road")        \
  ROW(kGuardStop, "guard_stop", kError, "the guard stops the car on the known road")

/// Table of GuardReason, with rows as in CHICANE_RUNGS. kWarning: the controller continues to drive, with less
/// throttle. kError: it does not.
#define CHICANE_GUARD_REASONS(ROW)                                                                               \
  ROW(kNone, "none", kOk, "the guard found nothing")                                                             \
  ROW(kNoAnswer, "no_answer", kError, "the controller has no answer")                                            \
  ROW(kNotMeasured, "not_measured", kError, "position, yaw or speed has not been measured for too long")         \
  ROW(kFrozen, "frozen", kError, "the measurements repeat although the car moves")                               \
  ROW(kSpeedMismatch, "speed_mismatch", kError, "measured speed and measured displacement contradict each other") \
  ROW(kHeadingJump, "heading_jump", kError, "the measured yaw changed faster than a car can turn")               \
  ROW(kPositionJump, "position_jump", kError, "the measured position changed faster than a car can move")        \
  ROW(kNoWayToStop, "no_way_to_stop", kError, "the controller's command would leave no way to stop on the road")  \
  ROW(kFarFromRoad, "far_from_road", kError, "the known road is far away")                                       \
  ROW(kTooFastForSilence, "too_fast_for_silence", kWarning,                                                      \
      "a receiver left alone could not stop the car on the road")                                                \
  ROW(kLate, "late", kError, "the measurements are of an earlier moment")                                        \
  ROW(kOtherSteering, "other_steering", kWarning, "the wheels turn otherwise than they are asked to")            \
  ROW(kWeakBrakes, "weak_brakes", kWarning, "the brakes give less than they are asked for")                      \
  ROW(kStuck, "stuck", kWarning, "the car stands although its road goes on")                                     \
  ROW(kFacesEdge, "faces_edge", kError, "the car faces the edge of its road, nearer than it can turn")
// clang-format on

namespace chicane::controller {

#define CHICANE_ENUMERATOR(enumerator, name, severity, sentence) enumerator,
/// Source of the command of a control cycle; set by safety::Guard.
enum class Rung : signed char { CHICANE_RUNGS(CHICANE_ENUMERATOR) };
/// Reason why the guard did not send the controller's answer; in observe mode, would not have sent it
/// (docs/safety.md, table of conditions). Of several reasons the last one of the table is reported.
enum class GuardReason : signed char { CHICANE_GUARD_REASONS(CHICANE_ENUMERATOR) };
#undef CHICANE_ENUMERATOR

/// Words of all enumerators, in their order.
#define CHICANE_WORD(enumerator, name, severity, sentence) \
  Word<Rung>{Rung::enumerator, name, Severity::severity, sentence},
inline constexpr std::array kRungWords{CHICANE_RUNGS(CHICANE_WORD)};
#undef CHICANE_WORD
#define CHICANE_WORD(enumerator, name, severity, sentence) \
  Word<GuardReason>{GuardReason::enumerator, name, Severity::severity, sentence},
inline constexpr std::array kGuardReasonWords{CHICANE_GUARD_REASONS(CHICANE_WORD)};
#undef CHICANE_WORD

inline constexpr std::size_t kRungCount = kRungWords.size();
inline constexpr std::size_t kGuardReasonCount = kGuardReasonWords.size();

/// Words of an enumerator.
[[nodiscard]] constexpr const Word<Rung>& word_of(Rung rung) noexcept {
  return kRungWords[static_cast<std::size_t>(rung)];
}
[[nodiscard]] constexpr const Word<GuardReason>& word_of(GuardReason reason) noexcept {
  return kGuardReasonWords[static_cast<std::size_t>(reason)];
}

}  // namespace chicane::controller
