// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

#include "chicane/solver/batch_solver.hpp"
#include "chicane/solver/ocp_solver.hpp"

namespace chicane::solver {

/// Solves many problems of one kind, in lanes (BatchSolver) or one after the other. What solves in a few full
/// steps is several times as fast in lanes. What needs the filter method wastes its turns there, and is
/// handed over: ask for lanes where few of the first problems are. One thread at a time; objects share
/// nothing.
template <template <class> class Problem, int Capacity, class Arch = arch::Native>
class ManySolver {
 public:
  using Batch = BatchSolver<Problem, Arch, Capacity>;
  using One = typename Batch::One;
  using State = typename Batch::State;
  using Trajectory = typename Batch::Trajectory;

  explicit ManySolver(const SolverOptions& options) noexcept : batch_{options}, single_{options} {}

  /// As BatchSolver::solve(). Returns how many were handed over.
  std::size_t solve_in_lanes(std::span<const One> problems, std::span<const State> starts,
                             std::span<Trajectory> trajectories, std::span<SolveReport> reports) noexcept {
    std::size_t handed_over = 0;
    batch_.solve(problems, starts, trajectories, reports,
                 [&](const One& problem, const State& start, Trajectory& trajectory) {
                   ++handed_over;
                   return single_.solve(problem, start, trajectory);
                 });
    return handed_over;
  }
  void solve_alone(std::span<const One> problems, std::span<const State> starts,
                   std::span<Trajectory> trajectories, std::span<SolveReport> reports) noexcept {
    for (std::size_t n = 0; n < problems.size(); ++n)
      reports[n] = single_.solve(problems[n], starts[n], trajectories[n]);
  }

 private:
  Batch batch_;
  OcpSolver<One, Capacity, Arch> single_;
};

}  // namespace chicane::solver
