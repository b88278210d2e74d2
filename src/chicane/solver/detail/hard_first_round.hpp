// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "chicane/base/deadline.hpp"
#include "chicane/solver/detail/hard_solver.hpp"

namespace chicane::solver {

// How the solver of HardProblems begins.

/// Full steps; where they lose their way, multipliers follow the barrier; where that gets nowhere, either,
/// a solve like any other.
template <HardProblem P, int Capacity, class Arch>
bool HardSolver<P, Capacity, Arch>::first_round(const State& x0, Trajectory& trajectory,
                                                const Deadline& deadline, int& left,
                                                HardReport& report) noexcept {
  if constexpr (has_filter_method<P>()) {
    if (options_.may_start_short) {
      inner_.use_full_steps_only(true);
      const bool converged = round(x0, trajectory, deadline, left, report);
      inner_.use_full_steps_only(false);
      if (converged || left <= 0 || report.status == SolveStatus::kNotFinite) return converged;
      begin_again(trajectory, 1.0);
      if (!track(x0, trajectory, deadline, left, report)) {
        begin_again(trajectory, 1.0);
        trial_ = most_of_a_trial();
      }
    }
  }
  return round(x0, trajectory, deadline, left, report);
}
/// Follows the filter method's barrier down, and brings multipliers, weights and prices up to date at the
/// solution of each barrier's problem. True when it has got to the end within a trial's turns.
template <HardProblem P, int Capacity, class Arch>
bool HardSolver<P, Capacity, Arch>::track(const State& x0, Trajectory& trajectory, const Deadline& deadline,
                                          int& left, HardReport& report) noexcept {
  if (!inner_.begin_path(problem_, x0, trajectory)) return false;
  int most = std::min(left, most_of_a_trial());
  Misses before;
  for (bool is_first = true;; is_first = false) {
    SolveReport seen;
    const bool is_solved = inner_.follow_path(problem_, trajectory, deadline, most, seen);
    report.iterations += seen.iterations;
    report.sweeps += seen.sweeps;
    ++report.rounds;
    left -= seen.iterations;
    most -= seen.iterations;
    if (!is_solved) return false;
    Misses now = measure(*problem_.problem, trajectory, nullptr);
    can_go_on_ = true;
    update(now, is_first ? nullptr : &before, trajectory.horizon, inner_.path_barrier());
    if (inner_.is_path_done()) break;
    inner_.lower_path(!can_go_on_);
    before = now;
  }
  inner_.end_path();
  return can_go_on_ = true;
}

}  // namespace chicane::solver
