// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <optional>

namespace chicane {

/// A time budget that can be asked "spent?". Built at the rim (runtime) and handed down, so that nothing below reads a
/// clock unless it was given one. `Deadline::never()` makes a run deterministic.
class Deadline {
 public:
  using Clock = std::chrono::steady_clock;

  /// A budget that is never spent and never reads the clock.
  static Deadline never() noexcept { return Deadline{}; }
  /// A budget that starts now.
  static Deadline after(std::chrono::nanoseconds budget) noexcept {
    Deadline d;
    d.end_ = Clock::now() + budget;
    return d;
  }

  [[nodiscard]] bool spent() const noexcept { return end_.has_value() && Clock::now() >= *end_; }
  [[nodiscard]] bool is_never() const noexcept { return !end_.has_value(); }

 private:
  std::optional<Clock::time_point> end_;
};

}  // namespace chicane
