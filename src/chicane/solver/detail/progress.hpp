// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "chicane/base/math.hpp"

namespace chicane::solver {

/// Progress of full steps by their length, which neither saturates at the bounds nor depends on the weights.
class Progress {
 public:
  void restart() noexcept { *this = Progress{}; }

  /// Adds the step length of one iteration. `excused`: the problem itself still changes, so that the count of
  /// steps without progress starts again.
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

  /// Whether the last step was shorter than all before it; true without steps.
  [[nodiscard]] bool is_good() const noexcept { return idle_ == 0; }
  /// Whether steps have not become shorter for a while.
  [[nodiscard]] bool is_lost() const noexcept { return idle_ >= kPatience; }
  /// Shortest step so far.
  [[nodiscard]] double shortest() const noexcept { return shortest_; }
  /// Whether steps need more than `iterations` further iterations to become as short as `length`, at the
  /// present linear rate.
  [[nodiscard]] bool is_slow(double length, double iterations) const noexcept {
    return log(last_ / length) > iterations * -log(std::fmin(rate_, 1.0));
  }

 private:
  static constexpr double kImprovement = 0.9;                  ///< step over the shortest that counts; chosen
  static constexpr int kPatience = 2;                          ///< steps without progress; chosen
  double shortest_ = std::numeric_limits<double>::infinity();  ///< shortest()
  double last_ = std::numeric_limits<double>::infinity();      ///< last step
  double rate_ = 0.0;                                          ///< last step over the one before
  int idle_ = 0;                                               ///< steps since the shortest one
};

/// Detects the floor of rounding: residuals that do not fall any more, or steps that move nothing.
class FloorWatch {
 public:
  /// Adds a residual. True if rounding keeps it, `small` or less, from falling, or steps from moving.
  bool is_reached(double residual, double small) noexcept {
    idle_ = residual < kFalls * least_ ? 0 : idle_ + 1;
    least_ = std::fmin(least_, residual);
    return (idle_ >= kMostIdle && residual <= small) || tiny_ >= kMostTiny;
  }
  /// Adds a step; `is_tiny`: it moves nothing by more than rounding.
  void note_step(bool is_tiny) noexcept { tiny_ = is_tiny ? tiny_ + 1 : 0; }

 private:
  static constexpr double kFalls = 0.9;                     ///< residual over the least that counts; chosen
  static constexpr int kMostIdle = 6, kMostTiny = 2;        ///< limits of idle_ and tiny_; chosen
  double least_ = std::numeric_limits<double>::infinity();  ///< least residual so far
  int idle_ = 0;                                            ///< residuals since the least one
  int tiny_ = 0;                                            ///< tiny steps in succession
};

/// Detects full steps that make cost and defects worse: they lead to a poor local optimum, or to none.
class Course {
 public:
  /// Adds an iterate. True if it costs kDearer times as much as the cheapest one so far, with larger defects.
  bool leads_astray(double cost, double defect) noexcept {
    if (cost < least_cost_) {
      least_cost_ = cost;
      defect_of_least_ = defect;
    }
    return defect_of_least_ > 0.0 && defect > defect_of_least_ && cost > kDearer * least_cost_;
  }

 private:
  static constexpr double kDearer = 5.0;  ///< cost over the least that shows a wrong course; chosen
  double least_cost_ = std::numeric_limits<double>::infinity();  ///< cost of the cheapest iterate
  double defect_of_least_ = 0.0;                                 ///< its largest defect
};

}  // namespace chicane::solver
