// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

namespace chicane {

/// Histogram of durations in fixed memory: 16 bins per octave from 1 ns to 18 minutes, so percentiles are
/// exact to 4.4 %. No allocation; one writer.
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
  static constexpr std::size_t kSub = 16;
  static constexpr std::size_t kOctaves = 40;
  static std::size_t bin(std::uint64_t ns) noexcept {
    if (ns < kSub) return static_cast<std::size_t>(ns);
    const auto octave = static_cast<std::size_t>(std::bit_width(ns) - 5);
    const auto sub = static_cast<std::size_t>((ns >> octave) - kSub);
    return std::min(kSub + octave * kSub + sub, kSub * kOctaves - 1);
  }
  static std::uint64_t upper_edge(std::size_t i) noexcept {
    if (i < kSub) return i;
    const std::size_t octave = (i - kSub) / kSub;
    return ((kSub + (i - kSub) % kSub + 1) << octave) - 1;
  }
  std::array<std::uint64_t, kSub * kOctaves> counts_{};
  std::uint64_t total_ = 0;
  std::uint64_t max_ = 0;
};

}  // namespace chicane
