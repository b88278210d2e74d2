// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "chicane/base/compiler.hpp"
#include "chicane/solver/ocp_solver.hpp"
#include "problems/structured_solver.hpp"

namespace chicane::bench {

/// A problem by reference, under a name that carries the instruction set.
template <class Arch, class P>
struct Tagged {
  static constexpr int kNx = P::kNx, kNu = P::kNu, kNr = P::kNr, kNe = P::kNe, kNc = P::kNc;
  static constexpr bool kRealTime = P::kRealTime;
  const P* problem = nullptr;

  template <class K, class X, class U>
  requires requires(const P& p, K k, const X& x, const U& u) { p.dynamics(k, x, u); }
  CHICANE_INLINE auto dynamics(K k, const X& x, const U& u) const { return problem->dynamics(k, x, u); }
  template <class K, class X, class U>
  requires requires(const P& p, K k, const X& x, const U& u) { p.residual(k, x, u); }
  CHICANE_INLINE auto residual(K k, const X& x, const U& u) const { return problem->residual(k, x, u); }
  template <class X>
  requires requires(const P& p, const X& x) { p.terminal_residual(x); }
  CHICANE_INLINE auto terminal_residual(const X& x) const { return problem->terminal_residual(x); }
  template <class K, class X, class U>
  requires requires(const P& p, K k, const X& x, const U& u) { p.constraint(k, x, u); }
  CHICANE_INLINE auto constraint(K k, const X& x, const U& u) const { return problem->constraint(k, x, u); }
  [[nodiscard]] std::array<double, kNu> input_lower(int k) const { return problem->input_lower(k); }
  [[nodiscard]] std::array<double, kNu> input_upper(int k) const { return problem->input_upper(k); }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int c) const requires(kNc > 0) {
    return problem->soft_penalty(c);
  }
};

template <class Arch, class Problem>
solver::SolveReport solve_compiled(const Problem& problem, const std::array<double, Problem::kNx>& x0,
                                   CompiledTrajectory<Problem>& trajectory) noexcept {
  static solver::OcpSolver<Tagged<Arch, Problem>, kLongestHorizon, Arch> ocp;
  return ocp.solve(Tagged<Arch, Problem>{&problem}, x0, trajectory);
}

}  // namespace chicane::bench
