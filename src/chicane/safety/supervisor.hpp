// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/controller/controller.hpp"
#include "chicane/safety/measurement_monitor.hpp"

namespace chicane::safety {

/// Decides from what the monitor finds whether the car has to be stopped, and when it may drive on:
///
///     condition        tolerated [s]   ends
///     late             0.12            by itself
///     not measured     0.12            by itself
///     frozen           0               by itself
///     speed mismatch   0.1             by itself when the sensor agrees again; else as below
///     heading jump     0.1             by itself when the sensor agrees again, else by a person
///     position jump    0.1             the same
///
/// A speed that still disagrees when the car has stood for kStanding is believed anew, once in kOnceIn; after
/// that, and where the place jumped, a person has to: by a reset of the run, or by taking over. A place that
/// is believed because it lasts leads a car off the road that it stands on. Worst condition wins. No
/// allocation; one thread.
class Supervisor {
 public:
  static constexpr double kTolerated = 0.1;      ///< [s] of a sensor that disagrees
  static constexpr double kUnmeasured = 0.12;    ///< [s] without a measurement
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
    using enum controller::GuardReason;
    Verdict verdict;
    const auto note = [&](double& since, bool is_there, double tolerated, controller::GuardReason reason) {
      if (!is_there) since = time;
      if (!is_there || !(time - since > tolerated)) return;
      verdict.reason = reason;
      verdict.must_stop = true;
    };
    note(late_, findings.late, kUnmeasured, kLate);
    note(unmeasured_, findings.unmeasured, kUnmeasured, kNotMeasured);
    note(frozen_, findings.frozen, 0.0, kFrozen);
    note(speed_, findings.speed_mismatch, kTolerated, kSpeedMismatch);
    note(heading_, findings.heading_jump, kTolerated, kHeadingJump);
    note(position_, findings.position_jump, kTolerated, kPositionJump);
    const bool is_latched =
        verdict.reason == kSpeedMismatch || verdict.reason == kHeadingJump || verdict.reason == kPositionJump;
    if (!is_latched || !(speed < kStandingSpeed)) stood_ = time;
    const bool is_due = verdict.reason == kSpeedMismatch ? time - rearmed_ > kOnceIn : has_person_;
    if (is_latched && is_due && time - stood_ > kStanding) {
      verdict.may_begin_anew = true;
      rearmed_ = time;
      has_person_ = false;
    }
    return verdict;
  }

 private:
  static constexpr double kNever = -1e9;
  double late_ = 0.0, unmeasured_ = 0.0, frozen_ = 0.0, speed_ = 0.0, heading_ = 0.0,
         position_ = 0.0;  ///< since [s]
  double stood_ = 0.0;
  double rearmed_ = kNever;
  bool has_person_ = false;  ///< has taken over since
};

}  // namespace chicane::safety
