// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include "chicane/controller/controller.hpp"
#include "chicane/safety/measurement_monitor.hpp"

namespace chicane::safety {

/// How a condition ends.
enum class ConditionEnd {
  kByItself,       ///< when the sensor agrees again
  kAfterStanding,  ///< also when the car has stood for Supervisor::kStanding: the sensor is believed anew,
                   ///< once in kOnceIn
  kByPerson        ///< also when the car has stood so and a person has taken over or reset the run
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
    {&Findings::speed_mismatch, controller::GuardReason::kSpeedMismatch, 0.1, ConditionEnd::kAfterStanding,
     2},
    {&Findings::heading_jump, controller::GuardReason::kHeadingJump, 0.1, ConditionEnd::kByPerson},
    {&Findings::position_jump, controller::GuardReason::kPositionJump, 0.1, ConditionEnd::kByPerson},
}};

/// Decides by kConditions whether the car has to be stopped, and when it may drive on. A place that was
/// believed because it lasts would lead a car off the road that it stands on. No allocation; one thread.
class Supervisor {
 public:
  static constexpr double kStanding = 3.0;       ///< [s]
  static constexpr double kOnceIn = 60.0;        ///< [s]
  static constexpr double kStandingSpeed = 0.3;  ///< [m/s]

  void reset() noexcept { *this = {}; }
  /// A person has taken over: what was latched is forgotten.
  void rearm() noexcept {
    rearmed_ = kNever;
    has_person_ = true;
  }

  struct Verdict {
    controller::GuardReason reason = controller::GuardReason::kNone;
    bool must_stop = false;
    bool may_begin_anew = false;  ///< stands, and the sensors may be believed anew
  };
  /// `speed`: as estimated [m/s].
  [[nodiscard]] Verdict judge(const Findings& findings, double time, double speed) noexcept {
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
    const bool is_latched = worst != nullptr && worst->ends != ConditionEnd::kByItself;
    if (!is_latched || !(speed < kStandingSpeed)) stood_ = time;
    if (!is_latched || !(time - stood_ > kStanding)) return verdict;
    verdict.may_begin_anew =
        worst->ends == ConditionEnd::kAfterStanding ? time - rearmed_ > kOnceIn : has_person_;
    if (verdict.may_begin_anew) {
      rearmed_ = time;
      has_person_ = false;
    }
    return verdict;
  }

 private:
  static constexpr double kNever = -1e9;
  std::array<double, kConditions.size()> since_{};  ///< when each was last not there [s]
  std::array<long, kConditions.size()> shown_{};    ///< measurements in a row that show it
  double stood_ = 0.0;
  double rearmed_ = kNever;
  bool has_person_ = false;  ///< has taken over since
};

}  // namespace chicane::safety
