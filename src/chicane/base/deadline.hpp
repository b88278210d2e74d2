// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <optional>

namespace chicane {

/// A time budget that can be asked "spent?". Built at the rim (runtime) and handed down, so that nothing
/// below reads a clock unless it was given one. `Deadline::never()` and `Deadline::stopwatch()` make a run
/// deterministic.
class Deadline {
 public:
  using Clock = std::chrono::steady_clock;

  /// A budget that is never spent and never reads the clock.
  static Deadline never() noexcept { return Deadline{}; }
  /// A budget that is never spent, but knows how long it has been running.
  static Deadline stopwatch() noexcept {
    Deadline d;
    d.start_ = Clock::now();
    return d;
  }
  /// A budget that starts now.
  static Deadline after(std::chrono::nanoseconds budget) noexcept {
    Deadline d = stopwatch();
    d.end_ = *d.start_ + budget;
    return d;
  }

  [[nodiscard]] bool spent() const noexcept { return end_.has_value() && Clock::now() >= *end_; }
  [[nodiscard]] bool is_never() const noexcept { return !end_.has_value(); }
  /// Since it was made [s]; 0 for never(). For reports only: nothing may be decided by it.
  [[nodiscard]] double elapsed() const noexcept {
    return start_.has_value() ? std::chrono::duration<double>(Clock::now() - *start_).count() : 0.0;
  }

 private:
  std::optional<Clock::time_point> start_;
  std::optional<Clock::time_point> end_;
};

}  // namespace chicane
