// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "chicane/base/deadline.hpp"
#include "chicane/solver/detail/hard_solver.hpp"

namespace chicane::solver {

// How the solver of HardProblems begins.

/// The primal-dual method; where its steps get short, multipliers follow the barrier of the augmented
/// Lagrangian. Where that gets nowhere, either, the least violation: where there is one, it is the answer
/// unless more rounds from the guess find a better one.
template <HardProblem P, int Capacity, class Arch>
bool HardSolver<P, Capacity, Arch>::first_round(const State& x0, Trajectory& trajectory,
                                                const Deadline& deadline, int& left,
                                                HardReport& report) noexcept {
  constexpr double kFew = 1e-2;  // of the guess's misses are left where a path leads to a solution
  if constexpr (has_filter_method<P>()) {
    if (!options_.may_start_short) return round(x0, trajectory, deadline, left, report);
    if (follow(x0, trajectory, deadline, left, report)) return round(x0, trajectory, deadline, left, report);
    begin_again(trajectory, 1.0);
    const bool has_path = track(x0, trajectory, deadline, left, report);
    const double enough = kFew * std::max(1.0, first_.worst());
    if (has_path && measure(*problem_.problem, trajectory, nullptr).worst() <= enough)
      return round(x0, trajectory, deadline, left, report);
    begin_again(trajectory, 1.0);
    if (!is_infeasible(*problem_.problem, x0, trajectory, deadline, left, report) &&
        follow(x0, trajectory, deadline, left, report))
      return round(x0, trajectory, deadline, left, report);
    begin_again(trajectory, 1.0);
    trial_ = most_of_a_trial();
  }
  return round(x0, trajectory, deadline, left, report);
}
/// The primal-dual method (eq. 50–54). True when it has got to the end of its barrier: multipliers and prices
/// are those of its point, and full steps may go on from there.
template <HardProblem P, int Capacity, class Arch>
bool HardSolver<P, Capacity, Arch>::follow(const State& x0, Trajectory& trajectory, const Deadline& deadline,
                                           int& left, HardReport& report) noexcept {
  constexpr int kMostIterations = 60;
  constexpr double kDearer = 4.0;  // than the highest multiplier: the constraint is kept
  SolveReport seen;
  const int most = std::max(1, std::min({left, kMostIterations, options_.max_iterations / 4}));
  const bool is_solved = inner_.follow_barrier(problem_, &problem_, x0, trajectory, deadline, most, seen);
  report.iterations += seen.iterations;
  report.sweeps += seen.sweeps;
  left -= seen.iterations;
  if (!is_solved) return false;
  for (std::size_t c = 0; c < kNc; ++c) {
    if (!is_hard(*problem_.problem, c)) continue;
    double highest = 0.0;
    for (int k = 0; k < trajectory.horizon; ++k)
      highest = std::max(highest, inner_.constraint_multiplier(k, static_cast<int>(c)));
    const double price = std::max(1e-12, price_of(problem_, c).linear);
    problem_.price_factor[c] *= std::max(1.0, kDearer * highest / price);
  }
  inner_.reprice(problem_);
  keep_prices(trajectory.horizon);
  return can_go_on_ = true;
}

/// Follows the filter method's barrier down, and brings multipliers, weights and prices up to date at the
/// solution of each barrier's problem. True when it has got to the end within a trial's iterations.
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
    before = now;
    if (inner_.is_path_done()) break;
    inner_.lower_path(!can_go_on_);
  }
  inner_.end_path(problem_);
  return can_go_on_ = true;
}

}  // namespace chicane::solver
