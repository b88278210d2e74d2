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

// HardSolver's use of the primal-dual method, and restoration, which finds a feasible point or proves that
// there is none nearby.

/// The primal-dual method (eq. 50–54). True if it reaches the end of its barrier: multipliers and penalties
/// are then those of its point, and full steps may continue from there.
template <HardProblem P, int Capacity, class Arch>
bool HardSolver<P, Capacity, Arch>::follow(Begin begin, const State& x0, Trajectory& trajectory,
                                           const Deadline& deadline, int& left, HardReport& report) noexcept {
  constexpr double kDearer =
      4.0;  // penalty over the highest multiplier, so that the constraint holds; chosen
  SolveReport seen;
  inner_.ask_for(round_tolerance());
  const bool is_solved =
      inner_.follow_barrier(problem_, x0, trajectory, deadline, std::min(left, kMostIterations), begin, seen);
  count(seen, left, report);
  if (!is_solved) return false;
  inner_.keep_point();
  for (std::size_t c = 0; c < kNc; ++c) {
    double highest = 0.0;
    for (int k = 0; problem_.must_hold(c) && k < trajectory.horizon; ++k)
      highest = std::max(highest, inner_.constraint_multiplier(k, static_cast<int>(c)));
    const double penalty = std::max(1e-12, penalty_of(problem_, c).linear);
    problem_.penalty_factor[c] *= std::max(1.0, kDearer * highest / penalty);
  }
  inner_.update_penalties(problem_);
  keep_multipliers(trajectory.horizon);
  point_multipliers_ = multipliers_;
  return can_go_on_ = true;
}
/// Restoration (docs/solver.md, eq. 55): the primal-dual method with elastic rows. A share of the cost counts
/// at first, `share`, and falls to almost none; the last step is repeated as long as it leaves a small share
/// of the violation. True if a minimum of the violation above zero is proven; `trajectory` is there, else at
/// the point found.
template <HardProblem P, int Capacity, class Arch>
bool HardSolver<P, Capacity, Arch>::is_infeasible(const P& problem, const State& x0, Trajectory& trajectory,
                                                  double share, const Deadline& deadline, int& left,
                                                  HardReport& report) noexcept {
  // Chosen.
  constexpr double kTolerance = 1e-8;  // tolerance of the method
  constexpr double kNoDefect = 1e-9;   // largest defect of a simulation
  constexpr double kFall = 1e-2;       // next share of the cost over this one
  constexpr double kLimitShare =
      1e-1;                            // penalty of the stages' constraints over others while the cost counts
  constexpr double kSame = 1e-3;       // relative difference of two violations at one point
  constexpr double kFirstUnit = 0.1;   // least first unit of violations
  constexpr double kMuch = 0.1;        // violation over its unit below which the last step is repeated
  constexpr double kLeastUnit = 1e-3;  // least next unit over this one
  forget_multipliers();
  inner_.ask_for(kTolerance);
  Misses misses = measure(problem, trajectory, nullptr);
  double unit = std::max(kFirstUnit, misses.worst);  // a guess may violate the dynamics alone
  SolveReport seen;
  bool converged = false;
  for (Begin begin = Begin::kGuess; left > 0 && !deadline.spent(); begin = Begin::kNear) {
    const double cost = std::isfinite(misses.cost) ? std::max(unit_, misses.cost) : unit_;
    weigh_misses(share / ((share > kLeastShare ? unit_ : cost) * std::max(1.0, unit)), unit);
    problem_.limit_share = share <= kLeastShare ? 1.0 : kLimitShare;
    seen = {};
    converged = inner_.follow_barrier(problem_, x0, trajectory, deadline, std::min(left, kMostIterations),
                                      begin, seen);
    inner_.start_from_states(true);
    count(seen, left, report);
    misses = measure(problem, trajectory, &report);
    const bool was_least = share <= kLeastShare, holds = converged && misses.worst <= options_.tolerance;
    is_possible_ = is_possible_ || holds;
    if (holds || (was_least && !(converged && misses.worst < kMuch * unit))) break;
    unit = was_least ? std::max(misses.worst, kLeastUnit * unit) : std::max(kFirstUnit, misses.worst);
    share = share > kFall ? kFall * share : kLeastShare;
  }
  keep_multipliers(trajectory.horizon);
  is_certified_ = share <= kLeastShare && !is_possible_ && misses.worst > options_.tolerance &&
                  (converged || (seen.iterations > 0 && seen.defect <= kNoDefect)) &&
                  is_proven(problem, x0, trajectory, misses.total / unit, converged);
  problem_.violation_penalty = 0.0;
  if (is_certified_) {
    is_final_ = is_final_ || std::fabs(misses.total - least_total_) <= kSame * misses.total;
    least_total_ = misses.total;
    least_ = trajectory;
    least_multipliers_ = multipliers_;
    least_unit_ = unit;
  }
  forget_multipliers();
  return is_certified_;
}
/// Whether no inputs within their bounds are free of violation, by slopes and multipliers at the point
/// `least`, whose violation is `violation` units (docs/solver.md, eq. 55a). The proof: the sum of all slopes,
/// each times the distance to the bound that it points to, and the violation that multipliers do not show,
/// are small shares of the violation. The proof is final if rows are linear, that is if their values at other
/// inputs are as the slopes predict.
template <HardProblem P, int Capacity, class Arch>
bool HardSolver<P, Capacity, Arch>::is_proven(const P& problem, const State& x0, const Trajectory& least,
                                              double violation, bool converged) noexcept {
  // Chosen.
  constexpr double kFarthest = 1e3;   // distance over the input that stands for an infinite bound
  constexpr double kRounding = 1e-6;  // relative error of a linear prediction
  constexpr double kLittle = 1e-1, kNextToNothing = 1e-3;  // small shares for linear rows, and for others
  double gain = 0.0, change = 0.0;
  copy_ = guess_;
  clamp_inputs(problem, copy_);
  for (int k = 0; k < least.horizon; ++k) {
    const auto stage = static_cast<std::size_t>(k);
    const auto low = problem.input_lower(k), high = problem.input_upper(k);
    for (std::size_t m = 0; m < low.size(); ++m) {
      const double u = least.u[stage][m];
      const double slope = inner_.bound_multiplier(k, static_cast<int>(m));
      const double room = slope > 0.0 ? u - low[m] : high[m] - u;
      gain += std::fabs(slope) * (std::isfinite(room) ? room : kFarthest * (1.0 + std::fabs(u)));
      const double guess = copy_.u[stage][m],
                   by = ((stage + m) % 2 == 0 ? 0.5 : -0.5) * (1.0 + std::fabs(guess));
      const double other = copy_.u[stage][m] = std::clamp(guess + by, low[m], high[m]);
      change += slope * (other - u);
    }
  }
  const double here = measure(problem, least, nullptr).weighted;
  roll_out(problem, x0, copy_);
  const double there = measure(problem, copy_, nullptr).weighted;
  is_final_ = std::fabs(there - here - change) <=
              kRounding * (std::fabs(here) + std::fabs(there) + std::fabs(change));
  const double little = is_final_ ? kLittle : (converged ? kNextToNothing : 0.0);
  return gain <= little * violation && here >= (1.0 - little) * violation;
}
/// Returns the point of least violation, with the multipliers of the violation alone, which are its
/// certificate.
template <HardProblem P, int Capacity, class Arch>
HardReport HardSolver<P, Capacity, Arch>::report_infeasible(const P& problem, const State& x0,
                                                            Trajectory& trajectory,
                                                            HardReport report) noexcept {
  put_light(least_multipliers_, trajectory.horizon);
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
/// Sets the weight of the cost to `share`, and of misses to one for each `unit`.
template <HardProblem P, int Capacity, class Arch>
void HardSolver<P, Capacity, Arch>::weigh_misses(double share, double unit) noexcept {
  problem_.cost_root = std::sqrt(share);
  problem_.penalty_factor.fill(share);
  problem_.violation_penalty = 1.0 / unit;
}

}  // namespace chicane::solver
