// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "chicane/controller/cubic_solver.hpp"

namespace chicane::bench {

/// Processor time that solves took.
class SolveClock {
 public:
  virtual ~SolveClock() = default;
  /// Of the last solve [s].
  [[nodiscard]] virtual double last() const noexcept = 0;
};

/// A solver of the described problem and the clock of its solves, which lives as long as the solver.
struct TimedSolver {
  std::unique_ptr<controller::CubicSolver> solver;
  const SolveClock* clock = nullptr;
};

/// CppAD and Ipopt as the write-ups' programs use them: derivatives by a tape that is recorded anew in each
/// solve, every solve from zeros, the options of the course's template but for max_cpu_time, which is 10 s in
/// the place of 0.5 s: no answer depends on the clock. Allocates.
[[nodiscard]] TimedSolver make_cppad_solver();

/// Our own, timed the same way.
[[nodiscard]] TimedSolver make_own_solver();

}  // namespace chicane::bench
