// SPDX-License-Identifier: MIT
#pragma once

namespace chicane::road {

/// Work that is spread over control cycles: loops that stop when a cycle's share is used up and go on where
/// they stopped. What is done in a cycle depends on the counted work alone, never on a clock.
class Instalments {
 public:
  /// Back to the first turn of the first loop.
  void restart() noexcept { phase_ = next_ = 0; }
  [[nodiscard]] int phase() const noexcept { return phase_; }

  /// Turns next..end-1 of the loop of this phase, each of which takes `cost` of `work`, as far as the work
  /// goes. At the end of the loop the next phase begins.
  template <class Turn>
  void loop(int end, int cost, int& work, Turn&& turn) noexcept {
    for (; next_ < end && work > 0; ++next_, work -= cost) turn(next_);
    if (next_ < end) return;
    enter(phase_ + 1);
  }
  /// Goes to a phase without a loop.
  void enter(int phase) noexcept {
    phase_ = phase;
    next_ = 0;
  }

 private:
  int phase_ = 0;
  int next_ = 0;
};

}  // namespace chicane::road
