// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "chicane/controller/controller.hpp"
#include "chicane/safety/measurement_monitor.hpp"

namespace chicane::safety {

/// How a condition ends.
enum class ConditionEnd {
  kByItself,  ///< when the sensor agrees again
  kByTrial,   ///< also when the car stands and answers its pedal where it is measured (ResetWatch), or by a
              ///< person who takes over or resets the run
  kByAnswer,  ///< with the next answer of the controller that can be sent
  kByMotion,  ///< when the car moves, wheels and brakes as usual
  kByPerson   ///< when a person turns the car round or resets the run
};

/// What the car is stopped for, held back for, or found with.
struct Condition {
  bool Findings::*finding;  ///< null: Guard itself finds it, and acts by it
  controller::GuardReason reason;
  double tolerated;  ///< [s] for which a finding may last
  ConditionEnd ends;
  int measurements = 1;  ///< that have to show it in a row, however rare they are
};

/// All of them; of several findings that last too long, the last is named. A moment's doubt comes from
/// noise or a car that slides, so 0.1 s of it, five measurements of the fastest sensor, is tolerated; without
/// a measurement 0.12 s, three at the simulator's 25 Hz. What is frozen has repeated for 0.3 m of driving
/// before it is found. Whether a speed is wrong or the model is shows in the next measurement
/// (docs/guard.md, eq. 10a).
inline constexpr std::array<Condition, 14> kConditions{{
    {&Findings::late, controller::GuardReason::kLate, 0.12, ConditionEnd::kByItself},
    {&Findings::unmeasured, controller::GuardReason::kNotMeasured, 0.12, ConditionEnd::kByItself},
    {&Findings::frozen, controller::GuardReason::kFrozen, 0.0, ConditionEnd::kByItself},
    {&Findings::speed_mismatch, controller::GuardReason::kSpeedMismatch, 0.1, ConditionEnd::kByTrial, 2},
    {&Findings::heading_jump, controller::GuardReason::kHeadingJump, 0.1, ConditionEnd::kByTrial},
    {&Findings::position_jump, controller::GuardReason::kPositionJump, 0.1, ConditionEnd::kByTrial},
    {nullptr, controller::GuardReason::kNoAnswer, 0.0, ConditionEnd::kByAnswer},
    {nullptr, controller::GuardReason::kNoWayToStop, 0.0, ConditionEnd::kByAnswer},
    {nullptr, controller::GuardReason::kFarFromRoad, 0.0, ConditionEnd::kByAnswer},
    {nullptr, controller::GuardReason::kTooFastForSilence, 0.0, ConditionEnd::kByAnswer},
    {nullptr, controller::GuardReason::kOtherSteering, 0.0, ConditionEnd::kByMotion},
    {nullptr, controller::GuardReason::kWeakBrakes, 0.0, ConditionEnd::kByMotion},
    {nullptr, controller::GuardReason::kStuck, 0.0, ConditionEnd::kByMotion},
    {nullptr, controller::GuardReason::kFacesEdge, 0.0, ConditionEnd::kByPerson},
}};

/// The row of a reason; null for GuardReason::kNone.
[[nodiscard]] constexpr const Condition* condition_of(controller::GuardReason reason) noexcept {
  for (const Condition& each : kConditions)
    if (each.reason == reason) return &each;
  return nullptr;
}

/// Decides by kConditions whether the car has to be stopped. A place that was accepted because it lasts would
/// lead a car off the road that it stands on. No allocation; one thread.
class Supervisor {
 public:
  void reset() noexcept { *this = {}; }

  struct Verdict {
    controller::GuardReason reason = controller::GuardReason::kNone;
    bool must_stop = false;
  };
  [[nodiscard]] Verdict judge(const Findings& findings, double time) noexcept {
    const Condition* worst = nullptr;
    for (std::size_t i = 0; i < kConditions.size(); ++i) {
      const Condition& each = kConditions[i];
      if (each.finding == nullptr) continue;
      shown_[i] = findings.*each.finding ? shown_[i] + 1 : 0;
      if (shown_[i] == 0)
        since_[i] = time;
      else if (time - since_[i] > each.tolerated && shown_[i] >= each.measurements)
        worst = &each;
    }
    return worst == nullptr ? Verdict{} : Verdict{worst->reason, true};
  }
  /// Something is found that a trial may end.
  [[nodiscard]] static bool wants_trial(const Findings& findings) noexcept {
    return std::any_of(kConditions.begin(), kConditions.end(), [&](const Condition& each) {
      return each.ends == ConditionEnd::kByTrial && findings.*each.finding;  // all of these are findings
    });
  }

 private:
  std::array<double, kConditions.size()> since_{};  ///< when each was last not there [s]
  std::array<long, kConditions.size()> shown_{};    ///< measurements in a row that show it
};

}  // namespace chicane::safety
