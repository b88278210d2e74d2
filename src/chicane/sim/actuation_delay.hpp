// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "chicane/model/state.hpp"

namespace chicane::sim {

/// Commands on their way to the actuators: each acts from its own time on, until a later one does. Any delay,
/// not only multiples of a step. Fixed memory: when full, the oldest waiting command is dropped in favour of
/// the next.
class ActuationDelay {
 public:
  void reset(const model::Command& acting) noexcept;
  /// `command` acts from `time` [s] on. Times must not decrease; a decreasing one is raised to the last.
  void push(double time, const model::Command& command) noexcept;
  /// When the last command that waits will act [s]; minus infinity when none does.
  [[nodiscard]] double last_time() const noexcept;
  /// The command acting at `time` [s]. Times must not decrease from call to call.
  [[nodiscard]] const model::Command& at(double time) noexcept;

 private:
  struct Entry {
    double time = 0.0;
    model::Command command;
  };
  static constexpr int kCapacity = 128;
  std::array<Entry, kCapacity> waiting_{};
  int first_ = 0;
  int count_ = 0;
  model::Command acting_;
};

/// Delay that chance adds to a command sent at `time` [s]: evenly distributed in [0, most) [s]. The same for
/// the same seed and time, whatever was drawn before: a run that is continued from within goes on as it did.
[[nodiscard]] double random_delay(std::uint64_t seed, double time, double most) noexcept;

}  // namespace chicane::sim
