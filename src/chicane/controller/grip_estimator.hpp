// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace chicane::controller {

/// What the tyres give sideways of what a model believes: the share ρ that fits best
///
///     d = (ρ − 1) a                                                        (docs/racing.md, eq. 3)
///
/// to the lateral accelerations a that the model has, and d that it lacks (StateEstimator::disturbance), by
/// least squares over the last kMemory of cornering. The slip is the same for car and model, as the estimator
/// sees the motion: so ρ shows before the grip is used up. One thread; allocates nothing.
class GripEstimator {
 public:
  static constexpr double kLeast = 3.0;    ///< [m/s²] of lateral acceleration: less tells too little
  static constexpr double kMemory = 10.0;  ///< time constant of forgetting, of cornering [s]
  static constexpr double kEnough = 1.0;   ///< of cornering [s] until something is known
  static constexpr double kLow = 0.3, kHigh = 1.3;  ///< range of share()

  void reset() noexcept { *this = {}; }
  /// Accelerations sideways, of the model and beside it [m/s²], during the last `elapsed` [s]. What is not
  /// finite, or less than kLeast, is left out.
  void add(double lateral, double missing, double elapsed) noexcept {
    const bool tells = std::isfinite(lateral + missing + elapsed) && std::fabs(lateral) >= kLeast;
    if (!tells || elapsed <= 0.0) return;
    const double left = kMemory / (kMemory + elapsed);
    time_ = left * time_ + elapsed;
    products_ = left * products_ + elapsed * lateral * missing;
    squares_ = left * squares_ + elapsed * lateral * lateral;
    residuals_ = left * residuals_ + elapsed * missing * missing;
  }
  [[nodiscard]] bool is_known() const noexcept { return time_ >= kEnough; }
  /// ρ; 1 until it is known.
  [[nodiscard]] double share() const noexcept {
    if (!is_known()) return 1.0;
    const double share = 1.0 + products_ / squares_;
    return share < kLow ? kLow : share > kHigh ? kHigh : share;
  }
  /// Standard deviation of single measurements of ρ about it.
  [[nodiscard]] double deviation() const noexcept {
    if (!is_known()) return 0.0;
    const double rest = residuals_ - products_ * products_ / squares_;
    return std::sqrt(rest > 0.0 ? rest / squares_ : 0.0);
  }

 private:
  double time_ = 0.0;
  double products_ = 0.0, squares_ = 0.0, residuals_ = 0.0;
};

}  // namespace chicane::controller
