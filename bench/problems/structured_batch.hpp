// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>

#include "chicane/base/instruction_set.hpp"
#include "chicane/solver/problem.hpp"
#include "chicane/solver/solution.hpp"
#include "problems/described_batch.hpp"

namespace chicane::bench {

inline constexpr int kBatchCapacity = 50;
using BatchTrajectory = solver::Trajectory<7, 2, kBatchCapacity>;
using BatchState = std::array<double, 7>;

/// BatchSolver on the structured problems, compiled for each instruction set. What a lane gives up is
/// reported as kStalled, its trajectory untouched.
template <class Arch>
void solve_batch(std::span<const DescribedOver<double>> problems, std::span<const BatchState> starts,
                 std::span<BatchTrajectory> trajectories, std::span<solver::SolveReport> reports) noexcept;
template <class Arch>
void solve_batch(std::span<const CorridorOver<double>> problems, std::span<const BatchState> starts,
                 std::span<BatchTrajectory> trajectories, std::span<solver::SolveReport> reports) noexcept;

/// By the instruction set that is chosen.
template <class Problem>
void solve_batch_fast(std::span<const Problem> problems, std::span<const BatchState> starts,
                      std::span<BatchTrajectory> trajectories,
                      std::span<solver::SolveReport> reports) noexcept {
  with_instructions(chosen_instruction_set(),
                    [&](auto arch) { solve_batch<decltype(arch)>(problems, starts, trajectories, reports); });
}

}  // namespace chicane::bench
