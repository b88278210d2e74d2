// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>

#include "chicane/solver/ocp_solver.hpp"

namespace chicane::solver {

// Preparation and feedback of OcpSolver (docs/solver.md, "Preparation and feedback").

template <OcpProblem P, int Capacity, class Arch>
bool OcpSolver<P, Capacity, Arch>::prepare(const P& problem) noexcept {
  full_steps_ = true;
  is_fresh_ = false;
  is_exact_ = options_.second_order;
  SolveReport seen;
  linearise(problem, seen);
  const double extra = lq_.backward(t_.horizon);
  if (extra > 0.0 && is_exact_) {  // indefinite: Gauss–Newton is not
    take_gauss_newton(problem);
    lq_.backward(t_.horizon);
  }
  return is_finite(seen);
}

template <OcpProblem P, int Capacity, class Arch>
FeedbackReport OcpSolver<P, Capacity, Arch>::feedback(const State& x0, Trajectory& trajectory) noexcept {
  constexpr int kMaxSweeps = 20;
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
  best_.write(trajectory);
  for (std::size_t k = 0; k < t_.horizon; ++k) {  // u + (bound − u) may miss the bound by one rounding
    for (std::size_t m = 0; m < kNu; ++m)
      trajectory.u[k][m] = nearest(trajectory.u[k][m], now_.lower[m][k], now_.upper[m][k]);
  }
  return done;
}

}  // namespace chicane::solver
