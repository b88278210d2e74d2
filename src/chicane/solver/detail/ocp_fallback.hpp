// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "chicane/base/deadline.hpp"
#include "chicane/solver/ocp_solver.hpp"

namespace chicane::solver {

// Parts of OcpSolver beside its iterations: endings, which make an answer of an iterate; recovery when full
// steps fail; preparation and feedback.

// ---- endings

/// Sets admissible inputs and finite states, for data that are not finite.
template <OcpProblem P, int Capacity>
CHICANE_INLINE inline void leave_admissible(const P& problem, const std::array<double, P::kNx>& x0,
                                            int horizon,
                                            Trajectory<P::kNx, P::kNu, Capacity>& trajectory) noexcept {
  for (auto& u : trajectory.u) u.fill(0.0);
  trajectory.horizon = horizon;
  trajectory.x[0] = x0;
  clamp_inputs(problem, trajectory);
  for (auto& u : trajectory.u) {  // bounds may be infinite or not a number
    for (double& value : u) value = std::isfinite(value) ? value : 0.0;
  }
  for (auto& x : trajectory.x) {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = std::isfinite(x0[i]) ? x0[i] : 0.0;
  }
}

/// Sets the worst violation of a soft constraint at the last linearisation, and the complementarity gap.
template <OcpProblem P, class Slacks>
void report_violation(const P& problem, const Slacks& slacks, std::size_t horizon,
                      SolveReport& report) noexcept {
  WorstViolation worst;
  for (std::size_t k = 0; k < horizon; ++k) {
    for (std::size_t c = 0; c < static_cast<std::size_t>(P::kNc); ++c)
      worst.consider(slacks.value(c, k), penalty_of(problem, c).cap, k, c);
  }
  worst.tell(report);
  report.gap = slacks.gap(horizon);
}

/// Ends a solve whose data are not finite, with admissible inputs and finite states.
template <OcpProblem P, int Capacity, class Arch>
SolveReport OcpSolver<P, Capacity, Arch>::give_up(const P& problem, const State& x0, Trajectory& trajectory,
                                                  SolveReport report) noexcept {
  leave_admissible(problem, x0, static_cast<int>(target_), trajectory);
  report.status = SolveStatus::kNotFinite;
  return report;
}
/// Constraints, multipliers and, with the filter method, the report then belong to the best iterate.
template <OcpProblem P, int Capacity, class Arch>
void OcpSolver<P, Capacity, Arch>::linearise_best(const P& problem, SolveReport& report) noexcept {
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
/// Returns the best iterate, extended to the whole horizon. Without an optimum its residuals decide the
/// status.
template <OcpProblem P, int Capacity, class Arch>
SolveReport OcpSolver<P, Capacity, Arch>::finish(SolveStatus status, const P& problem, Trajectory& trajectory,
                                                 SolveReport report) noexcept {
  if (status != SolveStatus::kOptimal) {
    const int iterations = report.iterations;
    const int sweeps = report.sweeps;
    if (has_best_) {
      t_ = best_;
      report = best_report_;
      if (!shows_best_) linearise_best(problem, report);
    }
    if (kCanFilter && has_best_ && bring_inside()) linearise(problem, report);
    if (kCanFilter && !only_full_steps_ && !(has_best_ && is_close(report)))
      take_cheapest(problem, trajectory, report);
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
  write(t_, trajectory);
  report_violation(problem, barrier_, t_.horizon, report);
  report.status = status;
  return report;
}

template <OcpProblem P, int Capacity, class Arch>
SolveReport OcpSolver<P, Capacity, Arch>::take_point(const P& problem, Trajectory& trajectory) noexcept {
  SolveReport report;
  t_ = kept_;
  barrier_.restore(kept_slacks_, t_.horizon);
  update_penalties(problem);
  if (bring_inside()) roll_out(problem);
  full_steps_ = true;
  is_fresh_ = is_exact_ = false;
  linearise(problem, report);
  const bool is_optimal = residual(report) <= options_.tolerance && now_.defect_excess <= 0.0;
  report.status = is_optimal                                     ? SolveStatus::kOptimal
                  : residual(report) <= options_.loose_tolerance ? SolveStatus::kBudgetSpent
                                                                 : SolveStatus::kStalled;
  t_.write(trajectory);
  report_violation(problem, barrier_, t_.horizon, report);
  return report;
}

/// Moves inputs outside of their bounds to the nearest value inside. True if one moves by more than rounding.
template <OcpProblem P, int Capacity, class Arch>
bool OcpSolver<P, Capacity, Arch>::bring_inside() noexcept {
  constexpr double kMoved = 1e-12;  // change that is more than rounding, relative
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

// ---- recovery when full steps fail

/// Starts the filter method at the solve's start, or resumes it after an earlier use.
template <OcpProblem P, int Capacity, class Arch>
bool OcpSolver<P, Capacity, Arch>::begin_filter(const P& problem, const Trajectory& trajectory,
                                                SolveReport& report) noexcept {
  is_filtering_ = true;
  if (has_filtered_) return filter_.resume(now_, barrier_, t_, true);
  full_steps_ = is_fresh_ = has_filtered_ = true;
  is_exact_ = shows_best_ = false;
  if (!take_guess(problem, trajectory)) return false;
  if (stands_still_) hold_states();
  if (!is_again_) break_symmetry();
  filter_.start(problem, final_barrier(problem), options_.second_order, is_again_, now_, lq_, barrier_, t_,
                report);
  return true;
}

/// Moves states and inputs by at most 1e-8 of their size, each by another amount, the same in each solve.
/// From a symmetric start, as with an obstacle straight ahead, steps would never choose a side.
template <OcpProblem P, int Capacity, class Arch>
void OcpSolver<P, Capacity, Arch>::break_symmetry() noexcept {
  constexpr double kMove = 1e-8;                  // largest move, relative; chosen
  constexpr double kGolden = 0.6180339887498949;  // golden ratio: its multiples are spread evenly
  double share = 0.0;                             // equidistributed in [0, 1)
  const auto move = [&](double& value) {
    share += kGolden;
    share -= share >= 1.0 ? 1.0 : 0.0;
    value += kMove * (share - 0.5) * (1.0 + std::fabs(value));
  };
  for (std::size_t k = 0; k < t_.horizon; ++k) {
    for (auto& row : t_.u) move(row[k]);
    for (auto& row : t_.x) move(row[k + 1]);
  }
}

/// One iteration of the filter method. Near the solution full steps, which converge faster, continue with its
/// working set. False at the end of the budget, or if the method is stuck.
template <OcpProblem P, int Capacity, class Arch>
bool OcpSolver<P, Capacity, Arch>::filter_iteration(const P& problem, const Deadline& deadline,
                                                    SolveReport& report) noexcept {
  using Outcome = typename Filter::Outcome;
  if (work_ >= options_.max_iterations || deadline.spent()) return false;
  const Outcome outcome = filter_.iterate(problem, now_, lq_, barrier_, t_, deadline, report);
  record_filter_iteration(report);
  if (outcome == Outcome::kGoing) return true;
  is_filtering_ = false;
  if (outcome != Outcome::kSolved) return false;
  filter_.hand_over(now_, lq_);
  best_ = t_;
  best_report_ = report;
  best_report_.stationarity = kInfinity;  // its multipliers differ from the first linearisation's
  barrier_.save(best_slacks_, t_.horizon);
  has_best_ = full_steps_ = true;
  is_exact_ = options_.second_order;
  progress_.restart();
  barrier_.set_mu(std::max(barrier_.mu(), final_barrier(problem)));
  return true;
}

template <OcpProblem P, int Capacity, class Arch>
bool OcpSolver<P, Capacity, Arch>::follow_barrier(P& problem, const State& x0, Trajectory& trajectory,
                                                  const Deadline& deadline, int most, Begin begin,
                                                  SolveReport& report) noexcept {
  using Outcome = typename Filter::Outcome;
  constexpr int kPatience = 20;  // limit of short steps in succession, except in restoration; chosen
  const int patience = problem.violation_penalty > 0.0 ? most : kPatience;
  filter_.take_rows(&problem);
  SolveReport last;
  bool is_solved = false;
  bool has_begun = begin == Begin::kHere;
  if (has_begun) {
    is_filtering_ = true;
    barrier_.restore(kept_slacks_, t_.horizon);
    has_begun = filter_.resume(now_, barrier_, t_, false);
    if (has_begun) now_.hard.resume(problem, filter_.mu(), t_.horizon);
  } else {
    has_begun = start(problem, x0, trajectory);
    is_again_ = begin == Begin::kNear;
    has_begun = has_begun && begin_filter(problem, trajectory, last);
  }
  for (; has_begun && report.iterations < most && !is_solved; ++report.iterations) {
    const Outcome outcome = filter_.iterate(problem, now_, lq_, barrier_, t_, deadline, report);
    record_filter_iteration(report);
    if (outcome == Outcome::kGoing && filter_.short_steps() < patience) continue;
    is_solved = outcome == Outcome::kSolved;
    break;
  }
  filter_.take_rows(nullptr);
  is_filtering_ = false;
  if (!has_begun) return false;
  if (now_.hard.is_elastic()) {  // restoration: slopes of the violation alone, by an exact adjoint
    is_solved = !bring_inside() && is_solved;
    problem.cost_root = 0.0;
    barrier_.forget_soft(problem);
    now_.template linearise<1>(problem, t_, false, 1.0, barrier_, lq_.lq, last);
    report.defect = last.defect;
  }
  now_.hard.end(problem, t_.horizon);
  t_.write(trajectory);
  if (!is_solved) return false;
  filter_.hand_over(now_, lq_);
  barrier_.set_mu(std::max(barrier_.mu(), final_barrier(problem)));
  return true;
}

template <OcpProblem P, int Capacity, class Arch>
bool OcpSolver<P, Capacity, Arch>::start_short(const P& problem, const Trajectory& trajectory) noexcept {
  if (!take_guess(problem, trajectory)) t_ = best_;
  t_.horizon = kFirstHorizon;
  has_grown_ = true;
  const bool is_good = restart(problem);
  barrier_.start(problem, final_barrier(problem), Evaluate::violation(problem, t_));
  return is_good;
}
template <OcpProblem P, int Capacity, class Arch>
bool OcpSolver<P, Capacity, Arch>::grow(const P& problem) noexcept {
  const std::size_t known = t_.horizon;
  t_.horizon = std::min(target_, known + std::min((known + 1) / 2, kMaxGrowth));
  for (std::size_t m = 0; m < kNu; ++m) {
    for (std::size_t k = known; k < t_.horizon; ++k)
      t_.u[m][k] = nearest(t_.u[m][known - 1], now_.lower[m][k], now_.upper[m][k]);
  }
  return restart(problem);
}

template <OcpProblem P, int Capacity, class Arch>
bool OcpSolver<P, Capacity, Arch>::restart(const P& problem) noexcept {
  full_steps_ = is_fresh_ = true;
  has_best_ = is_exact_ = false;
  progress_.restart();
  descent_.forget();
  return roll_out(problem);
}
template <OcpProblem P, int Capacity, class Arch>
bool OcpSolver<P, Capacity, Arch>::stand_still(const P& problem, const SolveReport& report) noexcept {
  if (!kCanFilter || stands_still_ || report.iterations > 0) return false;
  hold_states();
  is_fresh_ = true;
  barrier_.start(problem, final_barrier(problem), Evaluate::violation(problem, t_));
  return true;
}
template <OcpProblem P, int Capacity, class Arch>
bool OcpSolver<P, Capacity, Arch>::descend(const P& problem, const Deadline& deadline,
                                           SolveReport& report) noexcept {
  if (!descent_.step(problem, now_, lq_, barrier_, t_, deadline, report.sweeps)) return false;
  if (log_ != nullptr) log_->set_step(descent_.moved());
  is_exact_ = options_.second_order && descent_.is_under_way();
  if (!descent_.is_smooth()) return true;
  full_steps_ = true;
  has_best_ = false;
  progress_.restart();
  return true;
}
template <OcpProblem P, int Capacity, class Arch>
void OcpSolver<P, Capacity, Arch>::record_filter_iteration(const SolveReport& report) noexcept {
  if (log_ == nullptr) return;
  log_->add(report, Iteration::Kind::kFilter, filter_.mu());
  log_->set_step(filter_.moved());
}

/// If so, the present iterate, whose slacks and multipliers are known, becomes the best one.
template <OcpProblem P, int Capacity, class Arch>
bool OcpSolver<P, Capacity, Arch>::is_at_floor(const SolveReport& report) noexcept {
  constexpr double kFloor = 1e-8;  // step over the largest input that counts as shortest; chosen
  if (!kCanFilter || !is_finite(report) || !has_best_ || !full_steps_ || is_growing() || !barrier_.is_final())
    return false;
  double largest = 1.0;
  for (std::size_t m = 0; m < kNu; ++m) {
    for (std::size_t k = 0; k < t_.horizon; ++k) largest = std::max(largest, std::fabs(t_.u[m][k]));
  }
  const bool is_short = progress_.shortest() <= kFloor * largest;
  if (!is_short || !(residual(report) <= std::min(kFloorResidual, options_.loose_tolerance))) return false;
  best_ = t_;
  best_report_ = report;
  return shows_best_ = true;
}

/// Takes the filter method's point if it is close to a solution; else the cheapest simulation of the inputs
/// of that point, of the best iterate and of the guess. It never costs more than the guess.
template <OcpProblem P, int Capacity, class Arch>
void OcpSolver<P, Capacity, Arch>::take_cheapest(const P& problem, const Trajectory& trajectory,
                                                 SolveReport& report) noexcept {
  if constexpr (kCanFilter) {
    full_steps_ = is_exact_ = false;  // slacks on their central path
    double least = kInfinity;
    const auto consider = [&](bool is_solution) {
      if (!is_solution && !roll_out(problem)) return false;
      SolveReport seen = report;
      linearise(problem, seen);
      if (!is_finite(seen) || (is_solution && !is_close(seen))) return false;
      if (!is_solution && seen.cost >= least) return false;
      least = seen.cost;
      step_ = t_;
      return true;
    };
    if (has_filtered_) {
      t_ = filter_.point();
      bring_inside();
    }
    if (!has_filtered_ || !consider(true)) {
      if (has_filtered_) consider(false);
      if (has_best_) {
        t_ = best_;
        consider(false);
      }
      if (take_guess(problem, trajectory)) consider(false);
    }
    if (least < kInfinity) {
      t_ = step_;
      has_best_ = true;
    } else if (has_best_) {
      t_ = best_;
    }
    linearise(problem, report);
  }
}

// ---- preparation and feedback (docs/solver_guide.md)

template <OcpProblem P, int Capacity, class Arch>
bool OcpSolver<P, Capacity, Arch>::prepare(const P& problem) noexcept {
  full_steps_ = true;
  is_fresh_ = false;
  is_exact_ = options_.second_order;
  SolveReport seen;
  linearise(problem, seen);
  const double extra = lq_.backward(t_.horizon);
  if (extra > 0.0 && is_exact_) {  // exact Hessians are indefinite, Gauss–Newton's are not
    take_gauss_newton(problem);
    lq_.backward(t_.horizon);
  }
  return is_finite(seen);
}

template <OcpProblem P, int Capacity, class Arch>
FeedbackReport OcpSolver<P, Capacity, Arch>::feedback(const State& x0, Trajectory& trajectory) noexcept {
  constexpr int kMaxSweeps = 20;  // limit of corrections of the working set; chosen
  using Repair = typename Lq::Repair;
  for (std::size_t i = 0; i < kNx; ++i) lq_.dx[0][i] = x0[i] - t_.x[i][0];
  FeedbackReport done;
  while (!(done.is_solved = lq_.forward(t_.horizon, Repair::kAll) == 0) && done.sweeps < kMaxSweeps) {
    lq_.backward_again();
    ++done.sweeps;
  }
  if (!done.is_solved) lq_.forward(t_.horizon, Repair::kClip);
  collect_step<Arch, true>(lq_, t_.horizon, step_);
  std::fill(lq_.dx[0], lq_.dx[0] + kNx, 0.0);
  add_step<Arch>(t_, 1.0, step_, best_);
  write(best_, trajectory);
  return done;
}

}  // namespace chicane::solver
