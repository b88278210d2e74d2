// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "chicane/base/instruction_set.hpp"
#include "chicane/solver/solution.hpp"
#include "problems/described_problem.hpp"

namespace chicane::bench {

/// Longest horizon that is measured.
inline constexpr int kLongestHorizon = 200;

template <class Problem>
using CompiledTrajectory = solver::Trajectory<Problem::kNx, Problem::kNu, kLongestHorizon>;
using StructuredTrajectory = CompiledTrajectory<StructuredDescribedProblem>;

/// OcpSolver compiled for each instruction set: on both structured problems, and on DescribedProblem as any
/// model is written (level 1).
template <class Arch, class Problem>
solver::SolveReport solve_compiled(const Problem& problem, const std::array<double, Problem::kNx>& x0,
                                   CompiledTrajectory<Problem>& trajectory) noexcept;

/// By the instruction set that is chosen.
template <class Problem>
solver::SolveReport solve_fast(const Problem& problem, const std::array<double, Problem::kNx>& x0,
                               CompiledTrajectory<Problem>& trajectory) noexcept {
  return with_instructions(chosen_instruction_set(), [&](auto arch) {
    return solve_compiled<decltype(arch)>(problem, x0, trajectory);
  });
}

}  // namespace chicane::bench
