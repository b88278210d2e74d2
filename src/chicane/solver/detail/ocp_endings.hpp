// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>

#include "chicane/solver/ocp_solver.hpp"

namespace chicane::solver {

// How OcpSolver ends: the parts of it that make an answer of an iterate.

/// Admissible inputs and finite states, for when the data are not finite.
template <OcpProblem P, int Capacity>
CHICANE_INLINE inline void leave_admissible(const P& problem, const std::array<double, P::kNx>& x0,
                                            int horizon,
                                            Trajectory<P::kNx, P::kNu, Capacity>& trajectory) noexcept {
  for (auto& u : trajectory.u) u.fill(0.0);
  trajectory.horizon = horizon;
  trajectory.x[0] = x0;
  clamp_inputs(problem, trajectory);
  for (auto& u : trajectory.u) {  // of bounds that no number keeps
    for (double& value : u) value = std::isfinite(value) ? value : 0.0;
  }
  for (auto& x : trajectory.x) {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = std::isfinite(x0[i]) ? x0[i] : 0.0;
  }
}

/// The worst violation of a soft constraint at the last linearisation, and the complementarity gap.
template <OcpProblem P, class Slacks>
void tell_violation(const P& problem, const Slacks& slacks, std::size_t horizon,
                    SolveReport& report) noexcept {
  WorstViolation worst;
  for (std::size_t k = 0; k < horizon; ++k) {
    for (std::size_t c = 0; c < static_cast<std::size_t>(P::kNc); ++c)
      worst.consider(slacks.value(c, k), penalty_of(problem, c).cap, k, c);
  }
  worst.tell(report);
  report.gap = slacks.gap(horizon);
}

/// The data are not finite: leaves admissible inputs and finite states behind.
template <OcpProblem P, int Capacity, class Arch>
SolveReport OcpSolver<P, Capacity, Arch>::give_up(const P& problem, const State& x0, Trajectory& trajectory,
                                                  SolveReport report) noexcept {
  leave_admissible(problem, x0, static_cast<int>(target_), trajectory);
  report.status = SolveStatus::kNotFinite;
  return report;
}
/// Constraints and multipliers are to be of the answer, and the report of both.
template <OcpProblem P, int Capacity, class Arch>
void OcpSolver<P, Capacity, Arch>::look_at_best(const P& problem, SolveReport& report) noexcept {
  is_exact_ = false;
  if constexpr (kCanFilter) {
    full_steps_ = true;
    is_fresh_ = false;
    barrier_.restore(best_slacks_, t_.horizon);
    linearise(problem, report);
  } else {
    full_steps_ = false;
    SolveReport unused;
    linearise(problem, unused);
  }
}
/// Returns the best iterate, extended to the whole horizon; unless it is optimal, its residuals decide
/// the status.
template <OcpProblem P, int Capacity, class Arch>
SolveReport OcpSolver<P, Capacity, Arch>::finish(SolveStatus status, const P& problem, Trajectory& trajectory,
                                                 SolveReport report) noexcept {
  if (status != SolveStatus::kOptimal) {
    const int iterations = report.iterations;
    const int sweeps = report.sweeps;
    if (has_best_) {
      t_ = best_;
      report = best_report_;
      if (!shows_best_) look_at_best(problem, report);
    }
    if (kCanFilter && has_best_ && bring_inside()) linearise(problem, report);
    if (kCanFilter && !(has_best_ && is_close(report))) take_cheapest(problem, trajectory, report);
    if (is_growing() || !has_best_) {
      while (is_growing()) grow(problem);
      linearise(problem, report);
      if (!is_finite(report)) return give_up(problem, t_.template state<double>(0), trajectory, report);
    }
    report.iterations = iterations;
    report.sweeps = sweeps;
    if (status != SolveStatus::kAtFloor || !(residual(report) <= kFloorResidual))
      status = is_close(report) ? SolveStatus::kBudgetSpent : SolveStatus::kStalled;
  } else if (barrier_.exceeds_a_cap(problem, t_.horizon)) {
    status = SolveStatus::kInfeasible;
  }
  t_.write(trajectory);
  for (std::size_t k = 0; k < t_.horizon; ++k) {  // u + (bound − u) may miss the bound by one rounding
    for (std::size_t m = 0; m < kNu; ++m)
      trajectory.u[k][m] = nearest(trajectory.u[k][m], now_.lower[m][k], now_.upper[m][k]);
  }
  tell_violation(problem, barrier_, t_.horizon, report);
  report.status = status;
  return report;
}

/// Inputs that iterations have left outside their bounds become the nearest inside. True when that moves one
/// by more than rounding does.
template <OcpProblem P, int Capacity, class Arch>
bool OcpSolver<P, Capacity, Arch>::bring_inside() noexcept {
  constexpr double kMoved = 1e-12;
  bool has_moved = false;
  for (std::size_t m = 0; m < kNu; ++m) {
    for (std::size_t k = 0; k < t_.horizon; ++k) {
      const double inside = nearest(t_.u[m][k], now_.lower[m][k], now_.upper[m][k]);
      has_moved |= std::fabs(inside - t_.u[m][k]) > kMoved * (1.0 + std::fabs(inside));
      t_.u[m][k] = inside;
    }
  }
  return has_moved;
}

}  // namespace chicane::solver
