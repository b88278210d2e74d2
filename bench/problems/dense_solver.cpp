// SPDX-License-Identifier: MIT
// In a file of its own, as a user's model is: beside other problems the compiler would inline less of it.
#include "chicane/base/inlining.hpp"
#include "chicane/solver/ocp_solver.hpp"
#include "problems/structured_solver.hpp"

namespace chicane::bench {
namespace {

/// The problem by reference, under a name that carries the instruction set; level 1.
template <class Arch>
struct TaggedDense {
  using P = DescribedProblem;
  static constexpr int kNx = P::kNx;
  static constexpr int kNu = P::kNu;
  static constexpr int kNr = P::kNr;
  static constexpr int kNe = P::kNe;
  static constexpr int kNc = P::kNc;
  static constexpr bool kRealTime = P::kRealTime;
  const P* problem = nullptr;

  template <class K, class T>
  CHICANE_INLINE std::array<T, kNx> dynamics(K k, const std::array<T, kNx>& x,
                                             const std::array<T, kNu>& u) const {
    return problem->dynamics(k, x, u);
  }
  template <class K, class T>
  CHICANE_INLINE std::array<T, kNr> residual(K k, const std::array<T, kNx>& x,
                                             const std::array<T, kNu>& u) const {
    return problem->residual(k, x, u);
  }
  template <class T>
  CHICANE_INLINE std::array<T, kNe> terminal_residual(const std::array<T, kNx>& x) const {
    return problem->terminal_residual(x);
  }
  [[nodiscard]] std::array<double, kNu> input_lower(int k) const { return problem->input_lower(k); }
  [[nodiscard]] std::array<double, kNu> input_upper(int k) const { return problem->input_upper(k); }
};

}  // namespace

template <class Arch>
solver::SolveReport solve_dense(const DescribedProblem& problem,
                                const std::array<double, DescribedProblem::kNx>& x0,
                                DescribedTrajectory<200>& trajectory) noexcept {
  static solver::OcpSolver<TaggedDense<Arch>, 200, Arch> ocp;
  return ocp.solve(TaggedDense<Arch>{&problem}, x0, trajectory);
}

template solver::SolveReport solve_dense<arch::Native>(const DescribedProblem&,
                                                       const std::array<double, DescribedProblem::kNx>&,
                                                       DescribedTrajectory<200>&) noexcept;

}  // namespace chicane::bench
