// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "chicane/base/deadline.hpp"
#include "chicane/solver/detail/hard_solver.hpp"

namespace chicane::solver {

// Start of the solver of HardProblems, and its restoration when the primal-dual method fails.

/// First round: the primal-dual method; if it fails, restoration and the method again from there. A proof
/// that no solution is nearby is the answer unless rounds from the guess find a solution.
template <HardProblem P, int Capacity, class Arch>
bool HardSolver<P, Capacity, Arch>::first_round(const State& x0, Trajectory& trajectory,
                                                const Deadline& deadline, int& left,
                                                HardReport& report) noexcept {
  if constexpr (has_filter_method<P>()) {
    if (!options_.may_start_short || follow(x0, trajectory, deadline, left, report))
      return round(x0, trajectory, deadline, left, report);
    begin_again(trajectory, 1.0);
    if (is_infeasible(*problem_.problem, x0, trajectory, deadline, left, report) ||
        !follow(x0, trajectory, deadline, left, report)) {
      begin_again(trajectory, 1.0);
      trial_ = most_of_a_trial();
    }
  }
  return round(x0, trajectory, deadline, left, report);
}
/// The primal-dual method (eq. 50–54). True if it reached the end of its barrier: multipliers and penalties
/// are then those of its point, and full steps may continue from there.
template <HardProblem P, int Capacity, class Arch>
bool HardSolver<P, Capacity, Arch>::follow(const State& x0, Trajectory& trajectory, const Deadline& deadline,
                                           int& left, HardReport& report) noexcept {
  constexpr int kMostIterations = 60;
  constexpr double kDearer = 4.0;  // factor over the highest multiplier: the constraint is kept
  SolveReport seen;
  const int most = std::max(1, std::min({left, kMostIterations, options_.max_iterations / 4}));
  const bool is_solved = inner_.follow_barrier(problem_, x0, trajectory, deadline, most, false, seen);
  report.iterations += seen.iterations;
  report.sweeps += seen.sweeps;
  left -= seen.iterations;
  if (!is_solved) return false;
  for (std::size_t c = 0; c < kNc; ++c) {
    double highest = 0.0;
    for (int k = 0; is_hard(*problem_.problem, c) && k < trajectory.horizon; ++k)
      highest = std::max(highest, inner_.constraint_multiplier(k, static_cast<int>(c)));
    const double penalty = std::max(1e-12, penalty_of(problem_, c).linear);
    problem_.penalty_factor[c] *= std::max(1.0, kDearer * highest / penalty);
  }
  inner_.update_penalties(problem_);
  keep_multipliers(trajectory.horizon);
  return can_go_on_ = true;
}
/// Restoration: the primal-dual method with elastic rows and almost no cost (docs/solver.md, eq. 55),
/// repeated as long as a small share of the violation is left. True if a minimum above zero is proven:
/// `trajectory` is there. Else weights and multipliers are those of the point found.
template <HardProblem P, int Capacity, class Arch>
bool HardSolver<P, Capacity, Arch>::is_infeasible(const P& problem, const State& x0, Trajectory& trajectory,
                                                  const Deadline& deadline, int& left,
                                                  HardReport& report) noexcept {
  constexpr double kShare = 1e-8, kTolerance = 1e-8, kFirstUnit = 0.1;
  constexpr double kMuch = 0.1, kLeastShare = 1e-3;  // over the unit: repeat below it, least next unit
  if (left <= 0) return false;
  has_restored_ = true;
  const auto factors = problem_.penalty_factor;
  for (auto& shift : problem_.equality_shift) shift.values.fill(0.0);
  problem_.terminal_shift.fill(0.0);
  inner_.ask_for(kTolerance);
  Misses misses = measure(problem, trajectory, nullptr);
  least_unit_ = std::max(kFirstUnit, misses.worst());  // states of a guess may miss nothing but the dynamics
  bool converged = true, is_less = true, is_near = false;
  for (; converged && is_less && left > 0; is_near = true) {
    const double cost = std::isfinite(misses.cost) ? std::max(unit_, misses.cost) : unit_;
    weigh_misses(kShare / (cost * std::max(1.0, least_unit_)), least_unit_);
    SolveReport seen;
    const int most = std::max(1, std::min(left, most_of_a_trial()));
    converged = inner_.follow_barrier(problem_, x0, trajectory, deadline, most, is_near, seen);
    inner_.start_from_states(true);
    report.iterations += seen.iterations;
    report.sweeps += seen.sweeps;
    left -= seen.iterations;
    misses = measure(problem, trajectory, &report);
    const double worst = misses.worst();
    is_possible_ = is_possible_ || (converged && worst <= options_.tolerance);
    is_less = !is_possible_ && worst < kMuch * least_unit_;
    if (is_less) least_unit_ = std::max(worst, kLeastShare * least_unit_);
  }
  is_certified_ =
      converged && !is_less && !is_possible_ && is_proven(problem, trajectory, misses.total / least_unit_);
  least_ = trajectory;
  problem_.violation_penalty = 0.0;
  inner_.ask_for(round_tolerance());
  keep_multipliers(trajectory.horizon);
  least_multipliers_ = multipliers_;
  if (is_certified_) return true;
  report.status = SolveStatus::kStalled;  // converged, but not with the whole cost
  can_go_on_ = false;
  problem_.cost_root = 1.0;
  problem_.penalty_factor = factors;
  return false;
}
/// Whether no inputs within their bounds are free of violation, by the slopes at the inputs of the least: all
/// slopes together, each times the distance to the bound that it points to, are next to nothing beside
/// `violation` (docs/solver.md, eq. 55a). Infinite bounds count as kFarthest times the input away.
template <HardProblem P, int Capacity, class Arch>
bool HardSolver<P, Capacity, Arch>::is_proven(const P& problem, const Trajectory& least,
                                              double violation) const noexcept {
  constexpr double kFarthest = 1e3, kNextToNothing = 1e-3;
  double gain = 0.0;
  for (int k = 0; k < least.horizon; ++k) {
    const auto low = problem.input_lower(k), high = problem.input_upper(k);
    for (std::size_t m = 0; m < low.size(); ++m) {
      const double u = least.u[static_cast<std::size_t>(k)][m];
      const double slope = inner_.bound_multiplier(k, static_cast<int>(m));
      const double room = slope > 0.0 ? u - low[m] : high[m] - u;
      gain += std::fabs(slope) * (std::isfinite(room) ? room : kFarthest * (1.0 + std::fabs(u)));
    }
  }
  return gain <= kNextToNothing * violation;
}
/// The answer is the point of least violation, with the multipliers of the violation alone: its certificate.
template <HardProblem P, int Capacity, class Arch>
HardReport HardSolver<P, Capacity, Arch>::tell_infeasible(const P& problem, const State& x0,
                                                          Trajectory& trajectory,
                                                          HardReport report) noexcept {
  constexpr double kLight = 1e-9;  // weight of rows, negligible beside their multipliers
  multipliers_ = least_multipliers_;
  multipliers_.equality_weight.fill(kLight);
  multipliers_.terminal_weight.fill(kLight);
  put_multipliers(trajectory.horizon);
  weigh_misses(0.0, least_unit_);
  trajectory = least_;
  HardReport seen;
  copy_ = least_;
  assess(x0, copy_, true, seen);
  multipliers_ = least_multipliers_;
  multipliers_.is_known = false;  // multipliers of the violation alone cannot start another solve
  const Misses now = measure(problem, trajectory, &report);
  problem_.violation_penalty = 0.0;
  return finish(SolveStatus::kInfeasible, now, report);
}
/// The cost by `share`; misses cost their multiples of `unit`.
template <HardProblem P, int Capacity, class Arch>
void HardSolver<P, Capacity, Arch>::weigh_misses(double share, double unit) noexcept {
  problem_.cost_root = std::sqrt(share);
  problem_.penalty_factor.fill(share);
  problem_.violation_penalty = 1.0 / unit;
}

}  // namespace chicane::solver
