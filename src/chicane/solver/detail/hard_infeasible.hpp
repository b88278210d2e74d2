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

// What cannot hold: the parts of the solver of HardProblems that find out.

/// Minimises the misses with ever less of the cost (docs/solver_hard.md, eq. 55). True when they have a
/// minimum above zero that does not depend on how much, nor on whether hard constraints may give way:
/// `trajectory` is there. Else weights and multipliers are those of the point that was found.
template <HardProblem P, int Capacity, class Arch>
bool HardSolver<P, Capacity, Arch>::is_infeasible(const P& problem, const State& x0, Trajectory& trajectory,
                                                  const Deadline& deadline, int& left,
                                                  HardReport& report) noexcept {
  constexpr double kFirstUnit = 0.1;
  constexpr std::array kShares{1e-5, 1e-8, 1e-8};
  constexpr std::array kKept{0.0, 0.5, 0.01};  // of the largest miss; squares spread it
  constexpr std::size_t kSquares = 2, kPhases = kShares.size();
  if (left <= 0) return false;
  const auto factors = problem_.penalty_factor;
  double unit = std::max(kFirstUnit, measure(problem, trajectory, nullptr).worst());
  double share = 1.0;
  double last = 0.0;
  for (auto& shift : problem_.equality_shift) shift.values.fill(0.0);
  problem_.terminal_shift.fill(0.0);
  ask_for(finest_tolerance(problem, trajectory.horizon));
  bool is_minimum = false;
  for (std::size_t phase = 0; phase < kPhases; ++phase) {
    const double cost = measure(problem, trajectory, nullptr).cost;
    const double cost_unit = std::isfinite(cost) ? std::max(unit_, cost) : unit_;
    share = kShares[phase] / (cost_unit * std::max(1.0, unit * unit));
    weigh_misses(share, unit);
    problem_.square_penalty = phase == kSquares ? 1.0 / (unit * unit) : 0.0;
    if (phase == kSquares) {
      least_ = trajectory;
      least_unit_ = unit;
    }
    SolveReport seen;
    const int most = std::max(1, std::min(left, most_of_a_trial()));
    const bool converged = inner_.follow_barrier(problem_, nullptr, x0, trajectory, deadline, most, seen);
    inner_.start_from_states(true);
    report.iterations += seen.iterations;
    report.sweeps += seen.sweeps;
    left -= seen.iterations;
    const double worst = measure(problem, trajectory, &report).worst();
    is_minimum = converged && worst > options_.tolerance && worst > kKept[phase] * last;
    if (!is_minimum || left <= 0) {
      is_minimum = is_minimum && phase + 1 == kPhases;
      break;
    }
    last = unit = worst;
  }
  problem_.square_penalty = 0.0;
  is_minimum = is_minimum && !leads_downhill(problem, x0, trajectory, report);
  problem_.violation_penalty = 0.0;
  ask_for(round_tolerance());
  if (is_minimum) return is_certified_ = true;
  report.status = SolveStatus::kStalled;  // it converged, but not with the whole cost
  can_go_on_ = false;
  problem_.cost_root = 1.0;
  problem_.penalty_factor = factors;
  const double multiplier = 1.0 / (share * unit * unit);  // times a miss: of the same point
  const double weight = std::min(multiplier, kHeavy * unit_ / (0.5 * unit * unit));
  for (std::size_t n = 0; n < kNh; ++n) {
    problem_.equality_weight[n].set(weight);
    for (std::size_t k = 0; k < static_cast<std::size_t>(trajectory.horizon); ++k)
      problem_.equality_shift[n][k] = multiplier / weight * equality_[n][k];
  }
  for (std::size_t n = 0; n < kEnd; ++n) {
    problem_.terminal_weight[n].set(weight);
    problem_.terminal_shift[n] =
        multiplier / weight * (n < kNeh ? terminal_[n] : std::max(0.0, terminal_[n]));
  }
  return false;
}
/// Whether `least_` is no minimum of the violation after all (docs/solver_hard.md, eq. 55a): inputs against
/// the slope of (55) without the cost, by a factor of 1 to 1e20, simulate to a tenth less of it than its own
/// do. `trajectory` is that simulation then.
template <HardProblem P, int Capacity, class Arch>
bool HardSolver<P, Capacity, Arch>::leads_downhill(const P& problem, const State& x0, Trajectory& trajectory,
                                                   HardReport& report) noexcept {
  constexpr double kLess = 0.9, kFarthest = 1e20;
  weigh_misses(0.0, least_unit_);
  HardReport seen;
  downhill_ = least_;  // which finish() may change
  assess(x0, downhill_, true, seen);
  double least = std::numeric_limits<double>::infinity();
  for (double step = 0.0; step <= kFarthest; step = step > 0.0 ? 10.0 * step : 1.0) {
    downhill_ = least_;
    for (int k = 0; k < downhill_.horizon; ++k) {
      const auto low = problem.input_lower(k), high = problem.input_upper(k);
      for (std::size_t m = 0; m < low.size(); ++m) {
        double& u = downhill_.u[static_cast<std::size_t>(k)][m];
        u = std::min(std::max(u - step * inner_.bound_multiplier(k, static_cast<int>(m)), low[m]), high[m]);
      }
    }
    if (!roll_out(problem, x0, downhill_)) break;
    const double violation = measure(problem, downhill_, nullptr).violation;
    if (step == 0.0) {
      least = violation;
    } else if (violation < kLess * least) {
      trajectory = downhill_;
      measure(problem, trajectory, &report);
      return true;
    }
  }
  measure(problem, trajectory, &report);
  return false;
}
/// The answer is the point of least violation, with the multipliers of the violation alone: its certificate.
template <HardProblem P, int Capacity, class Arch>
HardReport HardSolver<P, Capacity, Arch>::tell_infeasible(const P& problem, const State& x0,
                                                          Trajectory& trajectory,
                                                          HardReport report) noexcept {
  weigh_misses(0.0, least_unit_);
  for (auto& shift : problem_.equality_shift) shift.values.fill(0.0);
  problem_.terminal_shift.fill(0.0);
  trajectory = least_;
  HardReport seen;
  downhill_ = least_;  // which finish() may change
  assess(x0, downhill_, true, seen);
  const Misses now = measure(problem, trajectory, &report);
  for (std::size_t n = 0; n < kNh; ++n) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(trajectory.horizon); ++k)
      problem_.equality_shift[n][k] = equality_[n][k];
  }
  for (std::size_t n = 0; n < kEnd; ++n)
    problem_.terminal_shift[n] = n < kNeh ? terminal_[n] : std::max(0.0, terminal_[n]);
  keep_multipliers(trajectory.horizon);
  problem_.violation_penalty = 0.0;
  return finish(SolveStatus::kInfeasible, now, report);
}
/// A ten thousandth of the narrowest bounds' distance, at most 1e-8: steps from one to the other are
/// no longer than the distance, whatever the slope.
template <HardProblem P, int Capacity, class Arch>
double HardSolver<P, Capacity, Arch>::finest_tolerance(const P& problem, int horizon) const noexcept {
  constexpr double kFiner = 1e-4, kLeast = 1e-13, kUsual = 1e-4;
  double width = kUsual;
  for (int k = 0; k < horizon; ++k) {
    const auto low = problem.input_lower(k), high = problem.input_upper(k);
    for (std::size_t m = 0; m < low.size(); ++m) {
      if (high[m] > low[m]) width = std::min(width, high[m] - low[m]);
    }
  }
  return std::max(kLeast, kFiner * width);
}
/// The cost by `share`, misses in multiples of `unit`: what is small counts, too.
template <HardProblem P, int Capacity, class Arch>
void HardSolver<P, Capacity, Arch>::weigh_misses(double share, double unit) noexcept {
  problem_.cost_root = std::sqrt(share);
  for (auto& weight : problem_.equality_weight) weight.set(1.0 / (unit * unit));
  for (auto& weight : problem_.terminal_weight) weight.set(1.0 / (unit * unit));
  problem_.penalty_factor.fill(share);
  problem_.violation_penalty = 1.0 / unit;
}

}  // namespace chicane::solver
