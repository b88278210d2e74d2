// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>

#include "chicane/base/math.hpp"

namespace chicane::solver {

/// Watches the length of full steps: the one measure that neither saturates at the bounds nor depends on the
/// weights.
class Progress {
 public:
  void restart() noexcept { *this = Progress{}; }

  /// Takes note of the step of one turn. `excused`: the problem itself still changes, no verdict yet.
  void note(double step, bool excused) noexcept {
    if (excused) return restart();
    rate_ = step / last_;
    last_ = step;
    const bool improved = step < kImprovement * shortest_;
    shortest_ = std::fmin(step, shortest_);
    idle_ = improved ? 0 : idle_ + 1;
    good_ = improved ? good_ + 1 : 0;
  }

  /// The latest step was an improvement (also before the first one).
  [[nodiscard]] bool is_good() const noexcept { return idle_ == 0; }
  /// Steps have not become shorter for a while.
  [[nodiscard]] bool is_lost() const noexcept { return idle_ >= kPatience; }
  /// Further turns until `residual` falls to `tolerance` at the present linear rate; 0 while there is no such
  /// rate.
  [[nodiscard]] double turns_left(double residual, double tolerance) const noexcept {
    if (good_ < 3 || !(rate_ < 1.0)) return 0.0;
    return log(residual / tolerance) / -log(rate_);
  }

 private:
  static constexpr double kImprovement = 0.9;
  static constexpr int kPatience = 2;
  double shortest_ = std::numeric_limits<double>::infinity();
  double last_ = std::numeric_limits<double>::infinity();
  double rate_ = 1.0;
  int idle_ = 0;
  int good_ = 0;
};

}  // namespace chicane::solver
