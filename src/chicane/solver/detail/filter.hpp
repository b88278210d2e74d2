// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace chicane::solver {

/// Quality of a point of the barrier problem: violation of its equations, and cost with barriers.
struct Merit {
  double miss = 0.0;  ///< sum of the violations
  double cost = 0.0;  ///< cost less the barrier μ times `logs`
  double logs = 0.0;  ///< sum of the slacks' logarithms
  [[nodiscard]] bool is_finite() const noexcept { return std::isfinite(miss + cost); }
};

/// Set of pairs of miss and cost; no later point may be worse in both (Fletcher, Leyffer 2002; Wächter,
/// Biegler 2006). Its size is fixed: the pairs that exclude least are dropped.
class Filter {
 public:
  static constexpr double kMissMargin = 1e-5;  ///< margin of the miss, relative
  static constexpr double kCostMargin = 1e-8;  ///< margin of the cost, over the miss

  /// Empties the filter, except for an upper limit of the miss.
  void reset(double most_miss) noexcept {
    count_ = 0;
    most_miss_ = most_miss;
  }
  [[nodiscard]] bool accepts(const Merit& merit) const noexcept {
    if (!merit.is_finite() || merit.miss > most_miss_) return false;
    for (std::size_t n = 0; n < count_; ++n) {
      if (merit.miss >= entry_[n].miss && merit.cost >= entry_[n].cost) return false;
    }
    return true;
  }
  /// Excludes later points that are as bad as `merit` in both, less a margin.
  void add(const Merit& merit) noexcept {
    const Merit entry{(1.0 - kMissMargin) * merit.miss, merit.cost - kCostMargin * merit.miss};
    std::size_t kept = 0;
    for (std::size_t n = 0; n < count_; ++n) {
      const bool is_dominated = entry_[n].miss >= entry.miss && entry_[n].cost >= entry.cost;
      if (!is_dominated) entry_[kept++] = entry_[n];
    }
    count_ = kept;
    if (count_ == kMost) {  // the largest miss excludes least
      std::size_t worst = 0;
      for (std::size_t n = 1; n < count_; ++n) worst = entry_[n].miss > entry_[worst].miss ? n : worst;
      entry_[worst] = entry_[--count_];
    }
    entry_[count_++] = entry;
  }

 private:
  static constexpr std::size_t kMost = 64;  ///< limit of entries; chosen
  std::array<Merit, kMost> entry_{};        ///< pairs that exclude points
  std::size_t count_ = 0;                   ///< used entries
  double most_miss_ = 0.0;                  ///< upper limit of the miss
};

}  // namespace chicane::solver
