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

/// Restoration: the primal-dual method with elastic rows and next to nothing of the cost (docs/solver.md, eq.
/// 55). True when it ends where misses have a minimum above zero that does not depend on how much of the cost
/// counts: `trajectory` is there. Else weights and multipliers are those of the point that was found.
template <HardProblem P, int Capacity, class Arch>
bool HardSolver<P, Capacity, Arch>::is_infeasible(const P& problem, const State& x0, Trajectory& trajectory,
                                                  const Deadline& deadline, int& left,
                                                  HardReport& report) noexcept {
  constexpr double kFirstUnit = 0.1;
  constexpr std::array kShares{1e-5, 1e-8};
  constexpr double kLeastKept = 0.5, kMostKept = 1.1;  // of the largest miss, else problems disagree
  if (left <= 0) return false;
  const auto factors = problem_.price_factor;
  double unit = std::max(kFirstUnit, measure(problem, trajectory, nullptr).worst());
  double last = 0.0;
  for (auto& shift : problem_.equality_shift) shift.values.fill(0.0);
  problem_.terminal_shift.fill(0.0);
  ask_for(finest_tolerance(problem, trajectory.horizon));
  bool is_minimum = false;
  for (std::size_t phase = 0; phase < kShares.size(); ++phase) {
    const double cost = measure(problem, trajectory, nullptr).cost;
    const double cost_unit = std::isfinite(cost) ? std::max(unit_, cost) : unit_;
    weigh_misses(kShares[phase] / (cost_unit * std::max(1.0, unit)), unit);
    least_unit_ = unit;
    SolveReport seen;
    const int most = std::max(1, std::min(left, most_of_a_trial()));
    const bool converged = inner_.follow_barrier(problem_, &problem_, x0, trajectory, deadline, most, seen);
    inner_.start_from_states(true);
    report.iterations += seen.iterations;
    report.sweeps += seen.sweeps;
    left -= seen.iterations;
    const double worst = measure(problem, trajectory, &report).worst();
    const bool agrees = phase == 0 || (worst > kLeastKept * last && worst < kMostKept * last);
    is_minimum = converged && worst > options_.tolerance && agrees;
    if (!is_minimum || left <= 0) {
      is_minimum = is_minimum && phase + 1 == kShares.size();
      break;
    }
    last = unit = worst;
  }
  least_ = trajectory;
  problem_.violation_price = 0.0;
  ask_for(round_tolerance());
  keep_prices(trajectory.horizon);
  least_prices_ = prices_;
  least_prices_.scale(problem_.cost_root * problem_.cost_root);
  if (is_minimum) return is_certified_ = true;
  report.status = SolveStatus::kStalled;  // it converged, but not with the whole cost
  can_go_on_ = false;
  problem_.cost_root = 1.0;
  problem_.price_factor = factors;
  return false;
}
/// The answer is the point of least violation, with the multipliers of the violation alone: its certificate.
template <HardProblem P, int Capacity, class Arch>
HardReport HardSolver<P, Capacity, Arch>::tell_infeasible(const P& problem, const State& x0,
                                                          Trajectory& trajectory,
                                                          HardReport report) noexcept {
  weigh_misses(0.0, least_unit_);
  prices_ = least_prices_;
  put_prices(trajectory.horizon);
  trajectory = least_;
  HardReport seen;
  downhill_ = least_;  // which finish() may change
  assess(x0, downhill_, true, seen);
  const Misses now = measure(problem, trajectory, &report);
  problem_.violation_price = 0.0;
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
/// The cost by `share`; misses cost their multiples of `unit`.
template <HardProblem P, int Capacity, class Arch>
void HardSolver<P, Capacity, Arch>::weigh_misses(double share, double unit) noexcept {
  problem_.cost_root = std::sqrt(share);
  problem_.price_factor.fill(share);
  problem_.violation_price = 1.0 / unit;
}

}  // namespace chicane::solver
