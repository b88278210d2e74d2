// SPDX-License-Identifier: MIT
#include "chicane/tracking/command_history.hpp"

#include <algorithm>

namespace chicane::tracking {

void CommandHistory::add(double time, const model::Command& command) noexcept {
  while (count_ > 0 && entry(count_ - 1).time >= time) --count_;
  if (count_ == kCapacity) {
    first_ = (first_ + 1) % kCapacity;
    --count_;
  }
  entries_[static_cast<std::size_t>((first_ + count_) % kCapacity)] = {time, command};
  ++count_;
}

model::Command CommandHistory::at(double time) const noexcept {
  for (int i = count_ - 1; i >= 0; --i) {
    if (entry(i).time <= time) return entry(i).command;
  }
  return {};
}

double CommandHistory::next_change(double time, double limit) const noexcept {
  for (int i = 0; i < count_; ++i) {
    if (entry(i).time > time) return std::min(entry(i).time, limit);
  }
  return limit;
}

}  // namespace chicane::tracking
