// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "chicane/solver/ocp_solver.hpp"
#include "problems/structured_solver.hpp"

namespace chicane::bench {

/// A problem under a name that carries the instruction set. Its own functions are all inlined.
template <class Arch, class P>
struct Tagged : P {};

template <class Arch, class Problem>
solver::SolveReport solve_compiled(const Problem& problem, const std::array<double, Problem::kNx>& x0,
                                   CompiledTrajectory<Problem>& trajectory) noexcept {
  static solver::OcpSolver<Tagged<Arch, Problem>, kLongestHorizon, Arch> ocp;
  return ocp.solve(Tagged<Arch, Problem>{problem}, x0, trajectory);
}

}  // namespace chicane::bench
