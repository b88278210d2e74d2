// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "chicane/model/state.hpp"

namespace chicane::safety {

/// The receiver's side of a broken link: when no command has arrived for long, the car brakes by itself. A
/// watchdog at the sender could not help. The wheel stays where the last command put it: the actuator knows
/// no road. No allocation; one thread.
class ArrivalWatch {
 public:
  static constexpr double kPatience = 0.25;        ///< [s]
  static constexpr double kPatienceInPeriods = 3;  ///< where the control period is long
  static constexpr double kFadeSpeed = 2.5;        ///< [m/s] below, braking fades (controller/fallback.hpp)

  explicit ArrivalWatch(double control_period) noexcept
      : patience_{std::max(kPatience, kPatienceInPeriods * control_period)} {}

  /// A new run begins at time 0.
  void reset() noexcept { last_ = 0.0; }
  /// A command acts from `time` [s] on.
  void arrived(double time) noexcept { last_ = std::max(last_, time); }
  [[nodiscard]] bool is_silent(double time) const noexcept { return time > last_ + patience_; }
  /// What the actuators do at `time` [s]: `command`, the last that arrived, or its wheel with all useful
  /// braking, `brake_throttle_limit`, when nothing has come for long. `speed` [m/s] is the actuator's own.
  [[nodiscard]] model::Command guard(const model::Command& command, double time, double speed,
                                     double brake_throttle_limit) const noexcept {
    if (!is_silent(time)) return command;
    return {.steer = command.steer,
            .throttle = -brake_throttle_limit * std::clamp(speed / kFadeSpeed, 0.0, 1.0)};
  }

 private:
  double patience_;
  double last_ = 0.0;
};

}  // namespace chicane::safety
