// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "problems/cpu_time.hpp"
#include "problems/optimality.hpp"

namespace chicane::bench {

/// A problem as the stages of other solvers: rows that are dynamics, equations or limits (<= 0), soft ones
/// with a number for their slack; derivatives by dual numbers.
template <solver::OcpProblem P, int Capacity>
struct StageRows {
  using Problem = OverArrays<P>;
  using Trajectory = solver::Trajectory<P::kNx, P::kNu, Capacity>;
  static constexpr int kNx = P::kNx, kNu = P::kNu, kNz = kNx + kNu, kNc = P::kNc;
  using First = Dual<kNz>;
  using Second = Dual<kNz, First>;
  enum Kind { kDynamics, kEquation, kLimit };

  Problem problem;
  Trajectory at;                   ///< where functions are evaluated
  std::vector<int> slack_of;       ///< of each constraint; −1: it must hold
  int slacks = 0;                  ///< in each stage
  double time_in_functions = 0.0;  ///< CPU time [s]

  void pose(const P& of, const std::array<double, P::kNx>& x0, const Trajectory& start) {
    problem = Problem{of};
    at = start;
    at.x[0] = x0;
    slack_of.clear();
    slacks = 0;
    for (int c = 0; c < kNc; ++c) slack_of.push_back(is_hard(of, c) ? -1 : slacks++);
    time_in_functions = 0.0;
  }
  [[nodiscard]] static constexpr int equations(bool is_end) { return is_end ? Problem::kNeh : Problem::kNh; }
  [[nodiscard]] static constexpr int limits(bool is_end) { return is_end ? Problem::kNec : kNc; }

  /// Calls visit(kind, number within it, value) for each row of stage k; of the end where k is the horizon.
  template <class T, class Visit>
  void each_row(int k, const Visit& visit) const {
    const auto all = [&](Kind kind, const auto& values) {
      for (std::size_t n = 0; n < values.size(); ++n) visit(kind, static_cast<int>(n), values[n]);
    };
    const auto x = variables_at<T>(at.x[static_cast<std::size_t>(k)], 0);
    if (k == at.horizon) {
      all(kEquation, problem.template terminal_equality<T>(x));
      all(kLimit, problem.template terminal_constraint<T>(x));
      return;
    }
    const auto u = variables_at<T>(at.u[static_cast<std::size_t>(k)], kNx);
    all(kDynamics, problem.template dynamics<T>(k, x, u));
    all(kLimit, problem.template constraint<T>(k, x, u));
    all(kEquation, problem.template equality<T>(k, x, u));
  }
  template <class T, class Visit>
  void each_residual(int k, const Visit& visit) const {
    const auto x = variables_at<T>(at.x[static_cast<std::size_t>(k)], 0);
    if (k == at.horizon) {
      for (const T& r : problem.template terminal_residual<T>(x)) visit(r);
      return;
    }
    const auto u = variables_at<T>(at.u[static_cast<std::size_t>(k)], kNx);
    for (const T& r : problem.template residual<T>(k, x, u)) visit(r);
  }
};

}  // namespace chicane::bench
