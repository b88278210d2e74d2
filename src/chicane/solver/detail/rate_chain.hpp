// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace chicane::solver {

/// What one input may be when its change is bounded, too (docs/solver_constraints.md, eq. 23–26):
///
///     low_k <= u_k <= high_k,   rate_low_k <= u_k − u_{k−1} <= rate_high_k,   u_{−1} = previous
///
/// Where both kinds contradict each other, an input's own bounds count. No allocation.
template <std::size_t Stages>
class RateChain {
 public:
  alignas(64) double low[Stages]{};
  alignas(64) double high[Stages]{};
  alignas(64) double rate_low[Stages]{};  ///< infinite where there is none
  alignas(64) double rate_high[Stages]{};
  double previous = 0.0;
  std::size_t horizon = 0;

  double excess = 0.0;           ///< largest amount by which a rate bound gave way
  std::size_t excess_stage = 0;  ///< and where

  /// Widens rate bounds where no admissible inputs would exist otherwise, and finds from which inputs the
  /// rest of the horizon can be reached. To be called when all numbers are set, before anything below.
  void make_consistent() noexcept {
    excess = 0.0;
    for (std::size_t k = horizon; k-- > 0;) {
      open_low_[k] = low[k];
      open_high_[k] = high[k];
      if (k + 1 < horizon) narrow(open_low_[k], open_high_[k], k + 1);
    }
    double first_low = previous;
    double first_high = previous;
    if (horizon > 0 && std::isfinite(previous)) narrow(first_low, first_high, 0);
  }

  /// The admissible value of stage k nearest to `value` (to zero where that is not a number) behind `last`.
  [[nodiscard]] double admit(std::size_t k, double value, double last) const noexcept {
    double from = open_low_[k];
    double to = open_high_[k];
    if (std::isfinite(last)) {
      from = std::min(std::max(from, last + rate_low[k]), to);
      to = std::max(std::min(to, last + rate_high[k]), from);
    }
    return std::min(std::max(std::isfinite(value) ? value : 0.0, from), to);
  }

  /// How far u is from optimal: ‖u − v‖∞ with v the admissible inputs nearest to u − slope, as (12) without
  /// rate bounds; for the first `count` stages. Keeps the multipliers that belong to v.
  double distance(const double* u, const double* slope, std::size_t count) noexcept {
    count_ = count;
    for (std::size_t k = 0; k < count_; ++k) wanted_[k] = u[k] - slope[k];
    if (!clip()) project();
    find_multipliers();
    double largest = 0.0;
    for (std::size_t k = 0; k < count_; ++k) largest = std::max(largest, std::fabs(u[k] - nearest_[k]));
    return largest;
  }
  /// Multiplier of the rate bounds of stage k at the last distance(): positive at the upper one, negative at
  /// the lower one.
  [[nodiscard]] double multiplier(std::size_t k) const noexcept { return k < count_ ? multiplier_[k] : 0.0; }

 private:
  /// Cuts [from, to] of stage k − 1 to what stage k can be reached from; its point nearest to that, and a
  /// wider rate bound, where there is nothing.
  void narrow(double& from, double& to, std::size_t k) noexcept {
    const double reach_low = open_low_[k] - rate_high[k];
    const double reach_high = open_high_[k] - rate_low[k];
    if (reach_low > to) {
      note(k, reach_low - to);
      rate_high[k] = open_low_[k] - to;
      from = to;
    } else if (reach_high < from) {
      note(k, from - reach_high);
      rate_low[k] = open_high_[k] - from;
      to = from;
    } else {
      from = std::max(from, reach_low);
      to = std::min(to, reach_high);
    }
  }
  void note(std::size_t k, double amount) noexcept {
    if (amount <= excess) return;
    excess = amount;
    excess_stage = k;
  }

  /// The nearest inputs when no rate bound matters. False when one does.
  bool clip() noexcept {
    double last = previous;
    for (std::size_t k = 0; k < count_; ++k) {
      const double v = nearest_[k] = std::min(std::max(wanted_[k], low[k]), high[k]);
      if (v - last > rate_high[k] || v - last < rate_low[k]) return false;
      last = v;
    }
    return true;
  }

  // ---- the nearest admissible inputs, by dynamic programming (eq. 25)

  /// min Σ ½ (v_k − wanted_k)²: the derivative of the cost of stages 0 … k by v_k is a rising line of
  /// straight pieces. From stage to stage its falling part moves with the lower rate bound, its rising part
  /// with the upper one, and a level piece opens between them.
  void project() noexcept {
    const double far = window();
    points_ = 0;
    push(previous, 0.0);
    for (std::size_t k = 0; k < count_; ++k) {
      open_at(best_ = zero(), std::max(rate_low[k], -far), std::min(rate_high[k], far));
      if (k > 0) least_[k - 1] = best_;
      cut(std::max(low[k], -far), std::min(high[k], far));
      for (std::size_t i = 0; i < points_; ++i) derivative_[i] += at_[i] - wanted_[k];
    }
    double v = zero();
    for (std::size_t k = count_; k-- > 0;) {
      nearest_[k] = v;
      if (k > 0) v = std::min(std::max(least_[k - 1], v - rate_high[k]), v - rate_low[k]);
    }
  }
  /// Bounds without end are cut where no solution is.
  [[nodiscard]] double window() const noexcept {
    double sum = 1.0 + std::fabs(previous);
    double largest = 0.0;
    for (std::size_t k = 0; k < count_; ++k) {
      largest = std::max(largest, std::fabs(wanted_[k]));
      sum += std::max({rate_low[k], -rate_high[k], 0.0});
      if (std::isfinite(low[k])) largest = std::max(largest, std::fabs(low[k]));
      if (std::isfinite(high[k])) largest = std::max(largest, std::fabs(high[k]));
    }
    return 4.0 * (sum + largest);
  }
  void push(double x, double derivative) noexcept {
    at_[points_] = x;
    derivative_[points_++] = derivative;
  }
  /// Where the derivative is zero, or the end nearest to that.
  [[nodiscard]] double zero() const noexcept {
    const std::size_t right = first_rising();
    if (right == 0) return at_[0];
    if (right == points_) return at_[points_ - 1];
    const double left = derivative_[right - 1];
    return at_[right - 1] - left * (at_[right] - at_[right - 1]) / (derivative_[right] - left);
  }
  [[nodiscard]] std::size_t first_rising() const noexcept {
    std::size_t right = 0;
    while (right < points_ && derivative_[right] < 0.0) ++right;
    return right;
  }
  void open_at(double where, double shift_low, double shift_high) noexcept {
    const std::size_t right = first_rising();
    for (std::size_t i = points_; i-- > right;) {
      at_[i + 2] = at_[i] + shift_high;
      derivative_[i + 2] = derivative_[i];
    }
    for (std::size_t i = 0; i < right; ++i) at_[i] += shift_low;
    at_[right] = where + shift_low;
    at_[right + 1] = where + shift_high;
    derivative_[right] = derivative_[right + 1] = 0.0;
    points_ += 2;
  }
  /// Keeps the piece over [from, to]; at least a point.
  void cut(double from, double to) noexcept {
    std::size_t first = 0;
    while (first + 1 < points_ && at_[first + 1] <= from) ++first;
    std::size_t last = points_ - 1;
    while (last > first && at_[last - 1] >= to) --last;
    const double left = value(first, last, std::max(at_[first], from));
    const double right = value(first, last, std::min(at_[last], to));
    const double begin = std::min(std::max(at_[first], from), to);
    const double end = std::max(std::min(at_[last], to), begin);
    points_ = 0;
    for (std::size_t i = first; i <= last; ++i) push(at_[i], derivative_[i]);
    at_[0] = begin;
    derivative_[0] = left;
    if (points_ > 1) {
      at_[points_ - 1] = end;
      derivative_[points_ - 1] = right;
    }
  }
  /// The derivative at x, between the first two or the last two points.
  [[nodiscard]] double value(std::size_t first, std::size_t last, double x) const noexcept {
    if (first == last) return derivative_[first];
    const std::size_t i = x <= at_[first + 1] ? first : last - 1;
    const double width = at_[i + 1] - at_[i];
    if (!(width > 0.0)) return derivative_[x <= at_[i] ? i : i + 1];
    return derivative_[i] + (derivative_[i + 1] - derivative_[i]) * ((x - at_[i]) / width);
  }

  // ---- multipliers (eq. 26)

  /// Inputs tied by changes at their bounds are chains, in which the multipliers are sums of what is left of
  /// the slope.
  void find_multipliers() noexcept {
    std::size_t begin = 0;
    while (begin < count_) {
      std::size_t end = begin + 1;
      while (end < count_ && is_tied(end)) ++end;
      solve_chain(begin, end);
      begin = end;
    }
  }
  [[nodiscard]] bool is_tied(std::size_t k) const noexcept { return side(k) != 0; }
  /// 1, -1: the change of stage k stands at its upper, lower bound; 2 where those are equal.
  static constexpr int kBoth = 2;
  static constexpr double kRounding = 1e-12;
  [[nodiscard]] int side(std::size_t k) const noexcept {
    const double last = k == 0 ? previous : nearest_[k - 1];
    const double slack = kRounding * (1.0 + std::fabs(nearest_[k]) + std::fabs(last));
    const double change = nearest_[k] - last;
    if (rate_low[k] == rate_high[k]) return kBoth;
    if (change >= rate_high[k] - slack) return 1;
    return change <= rate_low[k] + slack ? -1 : 0;
  }
  [[nodiscard]] bool is_fixed(std::size_t k) const noexcept {
    const double slack = kRounding * (1.0 + std::fabs(nearest_[k]));
    return nearest_[k] <= low[k] + slack || nearest_[k] >= high[k] - slack;
  }
  [[nodiscard]] bool is_high(std::size_t k) const noexcept {
    return high[k] - nearest_[k] < nearest_[k] - low[k];
  }
  [[nodiscard]] double pull(std::size_t k) const noexcept { return nearest_[k] - wanted_[k]; }

  /// What the multiplier of a stage may be.
  struct Range {
    double least = -std::numeric_limits<double>::infinity();
    double most = std::numeric_limits<double>::infinity();

    /// The value nearest to zero.
    [[nodiscard]] double nearest() const noexcept { return std::min(std::max(0.0, least), most); }
    void cut(const Range& other) noexcept {
      least = std::max(least, other.least);
      most = std::min(most, other.most);
    }
  };
  /// Of which sign the side at which a change stands lets it be.
  [[nodiscard]] Range range_of_side(std::size_t k) const noexcept {
    Range range;
    if (side(k) == 1) range.least = 0.0;
    if (side(k) == -1) range.most = 0.0;
    return range;
  }
  /// Stages [begin, end) are tied to each other: ν_{k+1} = ν_k + pull_k where k is free, at most that at its
  /// lower bound, at least that at its upper one. Forwards: what each may be, given those before it; then
  /// from the end, where it is 0, one by one the value nearest to zero. The input before the first stage is
  /// given.
  void solve_chain(std::size_t begin, std::size_t end) noexcept {
    Range range{0.0, 0.0};
    if (begin == 0 && is_tied(0)) range = range_of_side(0);
    for (std::size_t k = begin; k < end; ++k) {
      range_[k] = range;
      const double sum = pull(k);
      range.least = may_fall(k) ? -std::numeric_limits<double>::infinity() : range.least + sum;
      range.most = may_rise(k) ? std::numeric_limits<double>::infinity() : range.most + sum;
      if (k + 1 < end) range.cut(range_of_side(k + 1));
    }
    double next = 0.0;
    for (std::size_t k = end; k-- > begin;) {
      const double sum = next - pull(k);
      if (is_fixed(k)) {
        Range own = range_[k];
        if (!may_fall(k)) own.most = std::min(own.most, sum);
        if (!may_rise(k)) own.least = std::max(own.least, sum);
        next = own.nearest();
      } else {
        next = sum;
      }
      multiplier_[k] = next;
    }
    if (!(begin == 0 && is_tied(0))) multiplier_[begin] = 0.0;
  }
  /// Whether the own bound of stage k lets the multiplier behind it be less, more than ν_k + pull_k.
  [[nodiscard]] bool may_fall(std::size_t k) const noexcept {
    return is_fixed(k) && (low[k] == high[k] || !is_high(k));
  }
  [[nodiscard]] bool may_rise(std::size_t k) const noexcept {
    return is_fixed(k) && (low[k] == high[k] || is_high(k));
  }

  double open_low_[Stages]{};  ///< from here on the rest of the horizon can be reached
  double open_high_[Stages]{};
  double wanted_[Stages]{};
  double nearest_[Stages]{};
  double multiplier_[Stages]{};
  Range range_[Stages]{};
  double least_[Stages]{};
  std::size_t count_ = 0;  ///< stages counted
  double best_ = 0.0;
  double at_[2 * Stages + 2]{};  ///< points of the derivative
  double derivative_[2 * Stages + 2]{};
  std::size_t points_ = 0;
};

}  // namespace chicane::solver
