// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "chicane/model/state.hpp"

namespace chicane::tracking {

/// The commands this controller has sent, with the time from which each acts. Fixed memory; the oldest is
/// forgotten.
class CommandHistory {
 public:
  void clear() noexcept { count_ = 0; }
  /// `command` acts from `time` [s] on; later commands replace earlier ones that would act later.
  void add(double time, const model::Command& command) noexcept;
  /// The same times with other commands: what `change` makes of each.
  template <class Change>
  [[nodiscard]] CommandHistory changed(const Change& change) const noexcept {
    CommandHistory other = *this;
    for (Entry& entry : other.entries_) entry.command = change(entry.command);
    return other;
  }
  /// Each command acts `time` [s] later; negative: earlier.
  void delay(double time) noexcept {
    for (Entry& entry : entries_) entry.time += time;
  }
  /// The command acting at `time`; zero before the first.
  [[nodiscard]] model::Command at(double time) const noexcept;
  /// First change of command after `time`, or `limit` when there is none before it.
  [[nodiscard]] double next_change(double time, double limit) const noexcept;

 private:
  struct Entry {
    double time = 0.0;
    model::Command command;
  };
  static constexpr int kCapacity = 128;
  std::array<Entry, kCapacity> entries_{};  ///< ring, ascending in time
  int first_ = 0;
  int count_ = 0;
  [[nodiscard]] const Entry& entry(int i) const noexcept {
    return entries_[static_cast<std::size_t>((first_ + i) % kCapacity)];
  }
};

}  // namespace chicane::tracking
