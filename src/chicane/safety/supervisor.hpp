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
  kByTrial    ///< also when the car stands and answers its pedal where it is measured (ResetWatch), or by a
              ///< person who takes over or resets the run
};

/// What the car is stopped for.
struct Condition {
  bool Findings::*finding;
  controller::GuardReason reason;
  double tolerated;  ///< [s] for which it may last
  ConditionEnd ends;
  int measurements = 1;  ///< that have to show it in a row, however rare they are
};

/// All of them, the worst last: of several that last too long, the last is named. A moment's doubt comes from
/// noise or a car that slides, so 0.1 s of it, five measurements of the fastest sensor, is tolerated; without
/// a measurement 0.12 s, three at the simulator's 25 Hz. What is frozen has repeated for 0.3 m of driving
/// before it is found. Whether a speed is wrong or the model is shows in the next measurement (eq. 10a).
inline constexpr std::array<Condition, 6> kConditions{{
    {&Findings::late, controller::GuardReason::kLate, 0.12, ConditionEnd::kByItself},
    {&Findings::unmeasured, controller::GuardReason::kNotMeasured, 0.12, ConditionEnd::kByItself},
    {&Findings::frozen, controller::GuardReason::kFrozen, 0.0, ConditionEnd::kByItself},
    {&Findings::speed_mismatch, controller::GuardReason::kSpeedMismatch, 0.1, ConditionEnd::kByTrial, 2},
    {&Findings::heading_jump, controller::GuardReason::kHeadingJump, 0.1, ConditionEnd::kByTrial},
    {&Findings::position_jump, controller::GuardReason::kPositionJump, 0.1, ConditionEnd::kByTrial},
}};

/// Decides by kConditions whether the car has to be stopped. A place that was believed because it lasts would
/// lead a car off the road that it stands on. No allocation; one thread.
class Supervisor {
 public:
  void reset() noexcept { *this = {}; }

  struct Verdict {
    controller::GuardReason reason = controller::GuardReason::kNone;
    bool must_stop = false;
  };
  [[nodiscard]] Verdict judge(const Findings& findings, double time) noexcept {
    Verdict verdict;
    const Condition* worst = nullptr;
    for (std::size_t i = 0; i < kConditions.size(); ++i) {
      const Condition& each = kConditions[i];
      shown_[i] = findings.*each.finding ? shown_[i] + 1 : 0;
      if (shown_[i] == 0)
        since_[i] = time;
      else if (time - since_[i] > each.tolerated && shown_[i] >= each.measurements)
        worst = &each;
    }
    if (worst != nullptr) verdict = {.reason = worst->reason, .must_stop = true};
    return verdict;
  }
  /// Something is found that a trial may end.
  [[nodiscard]] static bool wants_trial(const Findings& findings) noexcept {
    return std::any_of(kConditions.begin(), kConditions.end(), [&](const Condition& each) {
      return each.ends == ConditionEnd::kByTrial && findings.*each.finding;
    });
  }

 private:
  std::array<double, kConditions.size()> since_{};  ///< when each was last not there [s]
  std::array<long, kConditions.size()> shown_{};    ///< measurements in a row that show it
};

}  // namespace chicane::safety
