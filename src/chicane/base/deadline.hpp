// SPDX-License-Identifier: MIT
// Time budgets of algorithms, which a replay ends without a clock, and a histogram of durations.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cstdint>
#include <optional>

namespace chicane {

/// Count of calls to Deadline::spent(). A replay reads it to end a control step at the same call as the
/// recorded run, without a clock.
struct DeadlineLog {
  std::uint32_t asked = 0;     ///< number of calls
  std::uint32_t spent_at = 0;  ///< number of the first call that returned true, from 1; 0: none
};

/// A time budget that an algorithm polls by spent(). Loops in real time make it and hand it down: no
/// algorithm reads a clock of its own. `Deadline::never()` and `Deadline::stopwatch()` make a run
/// deterministic.
class Deadline {
 public:
  using Clock = std::chrono::steady_clock;

  /// A budget that is never spent and never reads the clock.
  static Deadline never() noexcept { return Deadline{}; }
  /// A budget that is never spent, with elapsed() counted from now.
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

  /// The same budget, which counts the calls of spent(), also those of its copies, in `log`, which outlives
  /// them all. If `log` has a `spent_at`, the budget is spent from that call on, and the clock is not read.
  [[nodiscard]] Deadline counted_in(DeadlineLog& log) const noexcept {
    Deadline counted = *this;
    counted.log_ = &log;
    return counted;
  }

  /// Whether the budget is used up. Counted in the log of counted_in(), if there is one.
  [[nodiscard]] bool spent() const noexcept {
    if (log_ == nullptr) return is_past();
    ++log_->asked;
    if (log_->spent_at == 0 && is_past()) log_->spent_at = log_->asked;
    return log_->spent_at > 0 && log_->asked >= log_->spent_at;
  }
  /// Time since the budget was made [s]; 0 for never(). For reports only, not for decisions.
  [[nodiscard]] double elapsed() const noexcept {
    return start_.has_value() ? std::chrono::duration<double>(Clock::now() - *start_).count() : 0.0;
  }

 private:
  [[nodiscard]] bool is_past() const noexcept { return end_.has_value() && Clock::now() >= *end_; }

  std::optional<Clock::time_point> start_;  ///< none: elapsed() is 0
  std::optional<Clock::time_point> end_;    ///< none: never spent by the clock
  DeadlineLog* log_ = nullptr;              ///< null: calls are not counted
};

/// Histogram of durations in fixed memory: bins of 1 ns below 16 ns, then 16 bins per octave up to 2.4 hours;
/// longer durations count in the last bin. Percentiles are at most one bin, 1/16 (6.3 %), too high. No
/// allocation; one writer.
class Durations {
 public:
  void add(std::uint64_t nanoseconds) noexcept {
    ++counts_[bin(nanoseconds)];
    ++total_;
    max_ = std::max(max_, nanoseconds);
  }
  [[nodiscard]] std::uint64_t count() const noexcept { return total_; }
  [[nodiscard]] std::uint64_t max() const noexcept { return max_; }
  /// Smallest bin edge [ns] not exceeded by the given share of values, share in (0, 1]; 0 when empty.
  [[nodiscard]] std::uint64_t percentile(double share) const noexcept {
    if (total_ == 0) return 0;
    const double wanted = share * static_cast<double>(total_);
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      seen += counts_[i];
      if (static_cast<double>(seen) >= wanted) return std::min(upper_edge(i), max_);
    }
    return max_;
  }

 private:
  static constexpr std::size_t kPerOctave = 16;  ///< bins; chosen: percentiles within 1/16
  static constexpr std::size_t kOctaves = 40;    ///< blocks of kPerOctave bins, from 0 to 2^43 ns (2.4 hours)

  /// Number of the bin that counts `ns`.
  static std::size_t bin(std::uint64_t ns) noexcept {
    if (ns < kPerOctave) return static_cast<std::size_t>(ns);
    const auto octave = static_cast<std::size_t>(std::bit_width(ns) - 5);
    const auto within = static_cast<std::size_t>((ns >> octave) - kPerOctave);
    return std::min(kPerOctave + octave * kPerOctave + within, kPerOctave * kOctaves - 1);
  }
  /// Longest duration [ns] that bin `i` counts.
  static std::uint64_t upper_edge(std::size_t i) noexcept {
    if (i < kPerOctave) return i;
    const std::size_t octave = (i - kPerOctave) / kPerOctave;
    return ((kPerOctave + (i - kPerOctave) % kPerOctave + 1) << octave) - 1;
  }

  std::array<std::uint64_t, kPerOctave * kOctaves> counts_{};  ///< durations in each bin
  std::uint64_t total_ = 0;                                    ///< sum of counts_
  std::uint64_t max_ = 0;                                      ///< longest duration [ns]
};

}  // namespace chicane
