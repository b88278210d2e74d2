// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "chicane/base/inlining.hpp"
#include "chicane/solver/detail/barrier.hpp"
#include "chicane/solver/problem.hpp"
#include "chicane/solver/solution.hpp"
#include "chicane/solver/warm_start.hpp"

namespace chicane::solver {

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

}  // namespace chicane::solver
