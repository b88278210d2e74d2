// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/model/state.hpp"

namespace chicane::safety {

/// How the actuators answer: the wheels turn to gain · command + offset, the brakes give a share of what is
/// asked for, and both act later than configured.
struct ActuatorAnswer {
  double gain = 1.0;
  double offset = 0.0;   ///< [rad]
  double braking = 1.0;  ///< (0, 1]
  double delay = 0.0;    ///< beyond the configured one [s]

  /// Commands have the effect that they are meant to have.
  [[nodiscard]] bool is_usual() const noexcept { return gain == 1.0 && offset == 0.0 && braking == 1.0; }
  /// The command that turns the wheels as `wanted` says.
  [[nodiscard]] model::Command command_for(const model::Command& wanted) const noexcept {
    return {(wanted.steer - offset) / gain, wanted.throttle};
  }
  /// How the wheels turn by `command`.
  [[nodiscard]] model::Command effect_of(const model::Command& command) const noexcept {
    return {gain * command.steer + offset, command.throttle};
  }
  /// This answer to commands that come out of `first`.
  [[nodiscard]] ActuatorAnswer after(const ActuatorAnswer& first) const noexcept {
    return {.gain = gain * first.gain,
            .offset = gain * first.offset + offset,
            .braking = braking * first.braking,
            .delay = delay + first.delay};
  }
};

}  // namespace chicane::safety
