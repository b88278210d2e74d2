// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>

#include "chicane/solver/problem.hpp"
#include "chicane/solver/solution.hpp"
#include "problems/described_batch.hpp"

namespace chicane::test {

/// The corridor problem where being half a metre outside is being infeasible.
template <class Real>
struct CappedCorridor : bench::CorridorOver<Real> {
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const {
    return {.linear = 500.0, .quadratic = 100.0, .cap = 0.5};
  }
};

constexpr int kBatchCapacity = 30;
using BatchState = std::array<double, 7>;
using BatchTrajectory = solver::Trajectory<7, 2, kBatchCapacity>;
template <class Problem>
using BatchFallback = solver::SolveReport (*)(const Problem&, const BatchState&, BatchTrajectory&);

/// A BatchSolver of each kind that lives as long as the program.
template <class Arch, template <class> class Problem>
void solve_batch(std::span<const Problem<double>> problems, std::span<const BatchState> starts,
                 std::span<BatchTrajectory> trajectories, std::span<solver::SolveReport> reports,
                 BatchFallback<Problem<double>> fallback) noexcept;

}  // namespace chicane::test
