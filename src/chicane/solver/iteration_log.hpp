// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "chicane/base/compiler.hpp"
#include "chicane/solver/solution.hpp"

/// Record of the iterations of a solve, for displays and analysis.

namespace chicane::solver {

/// One iteration of a solve: its iterate, and the step from there.
struct Iteration {
  /// Origin of the step (docs/solver.md): working set, line search over simulations, filter method.
  enum class Kind : std::uint8_t { kFullStep, kDescent, kFilter };
  int round = 0;  ///< round of the augmented Lagrangian, from 1; 0 for problems without hard constraints
  Kind kind = Kind::kFullStep;
  double cost = 0.0;  ///< cost of the iterate, for the problem of the present round
  double stationarity = 0.0, defect = 0.0, complementarity = 0.0;  ///< as in SolveReport
  double step = 0.0;     ///< longest move of an input; 0 where no step was taken
  double barrier = 0.0;  ///< barrier of soft constraints, or of the filter method
};

/// Iterations of a solve, in memory of the caller. Iterations beyond the memory are only counted.
class IterationLog {
 public:
  explicit IterationLog(std::span<Iteration> memory) noexcept : iterations_{memory} {}

  void clear() noexcept {
    count_ = 0;
    round_ = 0;
  }
  /// Starts a round of the augmented Lagrangian.
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

  /// Number of iterations, also of those that were not kept.
  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  /// Kept iterations in their order.
  [[nodiscard]] std::span<const Iteration> iterations() const noexcept {
    return iterations_.first(count_ < iterations_.size() ? count_ : iterations_.size());
  }

 private:
  std::span<Iteration> iterations_;  ///< memory of the caller
  std::size_t count_ = 0;            ///< count()
  int round_ = 0;                    ///< present round
};

}  // namespace chicane::solver
