// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cstdint>
#include <optional>

namespace chicane {

/// Calls to Deadline::spent(). With them a replay ends a step at the same call, without a clock.
struct DeadlineLog {
  std::uint32_t asked = 0;     ///< count of calls
  std::uint32_t spent_at = 0;  ///< number of the first call that returned true, from 1; 0: none
};

/// A time budget that can be asked "spent?". Made by loops in real time and handed down: no algorithm reads a
/// clock unless it was given one. `Deadline::never()` and `Deadline::stopwatch()` make a run deterministic.
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

  /// The same budget; it and its copies count their questions in `log`, which outlives them. If `spent_at` is
  /// set in `log`, the budget is spent from that question on, and the clock is not read.
  [[nodiscard]] Deadline counted_in(DeadlineLog& log) const noexcept {
    Deadline counted = *this;
    counted.log_ = &log;
    return counted;
  }

  /// Whether the budget is used up. A question in the sense of DeadlineLog.
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

  std::optional<Clock::time_point> start_;
  std::optional<Clock::time_point> end_;
  DeadlineLog* log_ = nullptr;
};

/// Histogram of durations in fixed memory: bins of 1 ns below 16 ns, then 16 bins per octave up to 2.4 hours.
/// Percentiles are at most one bin, 1/16 (6.3 %), too high. No allocation; one writer.
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
  static constexpr std::size_t kPerOctave = 16;  ///< bins; durations below 16 ns have one each
  static constexpr std::size_t kOctaves = 40;    ///< blocks of kPerOctave bins, from 0 to 2^43 ns
  static std::size_t bin(std::uint64_t ns) noexcept {
    if (ns < kPerOctave) return static_cast<std::size_t>(ns);
    const auto octave = static_cast<std::size_t>(std::bit_width(ns) - 5);
    const auto within = static_cast<std::size_t>((ns >> octave) - kPerOctave);
    return std::min(kPerOctave + octave * kPerOctave + within, kPerOctave * kOctaves - 1);
  }
  static std::uint64_t upper_edge(std::size_t i) noexcept {
    if (i < kPerOctave) return i;
    const std::size_t octave = (i - kPerOctave) / kPerOctave;
    return ((kPerOctave + (i - kPerOctave) % kPerOctave + 1) << octave) - 1;
  }
  std::array<std::uint64_t, kPerOctave * kOctaves> counts_{};
  std::uint64_t total_ = 0;
  std::uint64_t max_ = 0;
};

}  // namespace chicane
