// SPDX-License-Identifier: MIT
#include "problems/structured_solver.hpp"

#include "chicane/base/inlining.hpp"
#include "chicane/solver/ocp_solver.hpp"

namespace chicane::bench {
namespace {

/// The problem by reference, under a name that carries the instruction set.
template <class Arch, class P>
struct Tagged {
  static constexpr int kNx = P::kNx;
  static constexpr int kNu = P::kNu;
  static constexpr int kNr = P::kNr;
  static constexpr int kNe = P::kNe;
  static constexpr int kNc = P::kNc;
  static constexpr bool kRealTime = P::kRealTime;
  const P* problem = nullptr;

  template <class K, class X, class U>
  CHICANE_INLINE auto dynamics(K k, const X& x, const U& u) const {
    return problem->dynamics(k, x, u);
  }
  template <class K, class X, class U>
  CHICANE_INLINE auto residual(K k, const X& x, const U& u) const {
    return problem->residual(k, x, u);
  }
  template <class X>
  CHICANE_INLINE auto terminal_residual(const X& x) const {
    return problem->terminal_residual(x);
  }
  template <class K, class X, class U>
  CHICANE_INLINE auto constraint(K k, const X& x, const U& u) const {
    return problem->constraint(k, x, u);
  }
  [[nodiscard]] std::array<double, kNu> input_lower(int k) const { return problem->input_lower(k); }
  [[nodiscard]] std::array<double, kNu> input_upper(int k) const { return problem->input_upper(k); }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int c) const requires(kNc > 0) {
    return problem->soft_penalty(c);
  }
};

template <class Arch, class P>
solver::SolveReport solve(const P& problem, const std::array<double, 7>& x0,
                          StructuredTrajectory& trajectory) noexcept {
  static solver::OcpSolver<Tagged<Arch, P>, 200, Arch> ocp;
  return ocp.solve(Tagged<Arch, P>{&problem}, x0, trajectory);
}

}  // namespace

template <class Arch>
solver::SolveReport solve_structured(const StructuredDescribedProblem& problem,
                                     const std::array<double, 7>& x0,
                                     StructuredTrajectory& trajectory) noexcept {
  return solve<Arch>(problem, x0, trajectory);
}
template <class Arch>
solver::SolveReport solve_structured(const StructuredCorridorProblem& problem,
                                     const std::array<double, 7>& x0,
                                     StructuredTrajectory& trajectory) noexcept {
  return solve<Arch>(problem, x0, trajectory);
}

template solver::SolveReport solve_structured<arch::Native>(const StructuredDescribedProblem&,
                                                            const std::array<double, 7>&,
                                                            StructuredTrajectory&) noexcept;
template solver::SolveReport solve_structured<arch::Native>(const StructuredCorridorProblem&,
                                                            const std::array<double, 7>&,
                                                            StructuredTrajectory&) noexcept;

}  // namespace chicane::bench
