// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "chicane/base/instruction_set.hpp"
#include "chicane/solver/solution.hpp"
#include "problems/corridor_problem.hpp"

namespace chicane::bench {

using StructuredTrajectory = solver::Trajectory<7, 2, 200>;

/// OcpSolver compiled for each instruction set: on the structured problems, and on the described one as any
/// model is written (level 1).
template <class Arch>
solver::SolveReport solve_structured(const StructuredDescribedProblem& problem,
                                     const std::array<double, 7>& x0,
                                     StructuredTrajectory& trajectory) noexcept;
template <class Arch>
solver::SolveReport solve_structured(const StructuredCorridorProblem& problem,
                                     const std::array<double, 7>& x0,
                                     StructuredTrajectory& trajectory) noexcept;
template <class Arch>
solver::SolveReport solve_dense(const DescribedProblem& problem,
                                const std::array<double, DescribedProblem::kNx>& x0,
                                DescribedTrajectory<200>& trajectory) noexcept;

/// By the instruction set that is chosen.
template <class Problem>
solver::SolveReport solve_fast(const Problem& problem, const std::array<double, 7>& x0,
                               StructuredTrajectory& trajectory) noexcept {
  return with_instructions(chosen_instruction_set(), [&](auto arch) {
    return solve_structured<decltype(arch)>(problem, x0, trajectory);
  });
}

}  // namespace chicane::bench
