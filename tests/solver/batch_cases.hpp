// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "chicane/solver/problem.hpp"
#include "chicane/solver/solution.hpp"
#include "problems/described_batch.hpp"

namespace chicane::test {

constexpr int kBatchCapacity = 30;
using BatchProblem = bench::DescribedOver<double>;
using BatchTrajectory = solver::Trajectory<BatchProblem::kNx, BatchProblem::kNu, kBatchCapacity>;

template <class Arch>
void solve_batch(std::span<const BatchProblem> problems, std::span<const std::array<double, 7>> starts,
                 std::span<BatchTrajectory> trajectories, std::span<solver::SolveReport> reports) noexcept;

}  // namespace chicane::test
