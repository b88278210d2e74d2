// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "chicane/base/math.hpp"

namespace chicane::solver {

/// Watches the length of full steps: the one measure that neither saturates at the bounds nor depends on the
/// weights.
class Progress {
 public:
  void restart() noexcept { *this = Progress{}; }

  /// Takes note of the step of one iteration. `excused`: the problem itself still changes, no verdict yet.
  void note(double step, bool excused) noexcept {
    if (excused) {
      restart();
    } else {
      idle_ = step < kImprovement * shortest_ ? 0 : idle_ + 1;
      shortest_ = std::fmin(step, shortest_);
    }
    rate_ = step / last_;
    last_ = step;
  }

  /// The latest step was an improvement (also before the first one).
  [[nodiscard]] bool is_good() const noexcept { return idle_ == 0; }
  /// Steps have not become shorter for a while.
  [[nodiscard]] bool is_lost() const noexcept { return idle_ >= kPatience; }
  /// Shortest step up to now.
  [[nodiscard]] double shortest() const noexcept { return shortest_; }
  /// Whether more than `iterations` further steps would be needed to get as short as `length`, at the present
  /// linear rate.
  [[nodiscard]] bool is_slow(double length, double iterations) const noexcept {
    return log(last_ / length) > iterations * -log(std::fmin(rate_, 1.0));
  }

 private:
  static constexpr double kImprovement = 0.9;  ///< step that counts as shorter, relative
  static constexpr int kPatience = 2;
  double shortest_ = std::numeric_limits<double>::infinity();
  double last_ = std::numeric_limits<double>::infinity();
  double rate_ = 0.0;
  int idle_ = 0;
};

/// Watches for the floor of rounding: residuals that no longer fall, steps that move nothing.
class FloorWatch {
 public:
  /// Takes note of a residual. Whether rounding keeps it, `small` or less, from falling, or steps from
  /// moving.
  bool is_reached(double residual, double small) noexcept {
    idle_ = residual < kFalls * least_ ? 0 : idle_ + 1;
    least_ = std::fmin(least_, residual);
    return (idle_ >= kMostIdle && residual <= small) || tiny_ >= kMostTiny;
  }
  void note_step(bool is_tiny) noexcept { tiny_ = is_tiny ? tiny_ + 1 : 0; }

 private:
  static constexpr double kFalls = 0.9;  ///< residual that counts as less, relative
  static constexpr int kMostIdle = 6, kMostTiny = 2;
  double least_ = std::numeric_limits<double>::infinity();
  int idle_ = 0;  ///< residuals since it fell
  int tiny_ = 0;  ///< steps in succession
};

/// Watches cost and defects of full steps: steps that make both worse lead to a poor local optimum, or to
/// none.
class Course {
 public:
  /// Takes note of an iterate. Whether it costs five times as much as the cheapest before it, with more
  /// defects than that had.
  bool leads_astray(double cost, double defect) noexcept {
    if (cost < least_cost_) {
      least_cost_ = cost;
      its_defect_ = defect;
    }
    return its_defect_ > 0.0 && defect > its_defect_ && cost > kDearer * least_cost_;
  }

 private:
  static constexpr double kDearer = 5.0;  ///< cost that counts as lost, relative
  double least_cost_ = std::numeric_limits<double>::infinity();
  double its_defect_ = 0.0;
};

}  // namespace chicane::solver
