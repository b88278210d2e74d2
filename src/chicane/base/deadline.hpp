// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace chicane {

/// What a Deadline was asked, so that a step can be computed again: clocks differ, the questions do not.
struct DeadlineLog {
  std::uint32_t asked = 0;     ///< questions so far
  std::uint32_t spent_at = 0;  ///< the first one answered with "spent", from 1; 0 = none so far
};

/// A time budget that can be asked "spent?". Built at the rim (run) and handed down, so that nothing
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

  /// The same budget, which counts in `log` how often it is asked, through all its copies. A log that comes
  /// with `spent_at` already has its answers: spent from that question on, whatever the clock says.
  [[nodiscard]] Deadline counted_in(DeadlineLog& log) const noexcept {
    Deadline counted = *this;
    counted.log_ = &log;
    return counted;
  }

  [[nodiscard]] bool spent() const noexcept {
    if (log_ == nullptr) return is_past();
    ++log_->asked;
    if (log_->spent_at == 0 && is_past()) log_->spent_at = log_->asked;
    return log_->spent_at > 0 && log_->asked >= log_->spent_at;
  }
  [[nodiscard]] bool is_never() const noexcept { return !end_.has_value(); }
  /// Since it was made [s]; 0 for never(). For reports only: nothing may be decided by it.
  [[nodiscard]] double elapsed() const noexcept {
    return start_.has_value() ? std::chrono::duration<double>(Clock::now() - *start_).count() : 0.0;
  }

 private:
  [[nodiscard]] bool is_past() const noexcept { return end_.has_value() && Clock::now() >= *end_; }

  std::optional<Clock::time_point> start_;
  std::optional<Clock::time_point> end_;
  DeadlineLog* log_ = nullptr;
};

}  // namespace chicane
