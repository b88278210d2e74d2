// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "chicane/base/compiler.hpp"
#include "chicane/solver/solution.hpp"

namespace chicane::solver {

/// One iteration of a solve: the iterate it began at, and the step from there.
struct Iteration {
  /// Origin of the step (docs/solver.md): working set, line search over simulations, filter method.
  enum class Kind : std::uint8_t { kFullStep, kDescent, kFilter };
  int round = 0;  ///< round of the augmented Lagrangian, from 1; 0 for problems without rows that must hold
  Kind kind = Kind::kFullStep;
  double cost = 0.0;  ///< cost of the iterate, for the problem of the present round
  double stationarity = 0.0, defect = 0.0, complementarity = 0.0;  ///< as in SolveReport
  double step = 0.0;     ///< longest move of an input; 0 where no step was taken
  double barrier = 0.0;  ///< barrier of soft constraints, or of the filter method
};

/// Iterations of a solve, in memory of the caller. What does not fit is counted, not kept.
class IterationLog {
 public:
  explicit IterationLog(std::span<Iteration> memory) noexcept : iterations_{memory} {}

  void clear() noexcept {
    count_ = 0;
    round_ = 0;
  }
  void begin_round() noexcept { ++round_; }
  CHICANE_INLINE inline void add(const SolveReport& report, Iteration::Kind kind, double barrier) noexcept {
    if (count_ < iterations_.size())
      iterations_[count_] = {
          round_, kind,   report.cost, report.stationarity, report.defect, report.complementarity,
          0.0,    barrier};
    ++count_;
  }
  /// Sets the step length of the newest iteration.
  void set_step(double step) noexcept {
    if (count_ > 0 && count_ <= iterations_.size()) iterations_[count_ - 1].step = step;
  }

  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  /// Kept iterations in their order.
  [[nodiscard]] std::span<const Iteration> iterations() const noexcept {
    return iterations_.first(count_ < iterations_.size() ? count_ : iterations_.size());
  }

 private:
  std::span<Iteration> iterations_;
  std::size_t count_ = 0;
  int round_ = 0;
};

}  // namespace chicane::solver
