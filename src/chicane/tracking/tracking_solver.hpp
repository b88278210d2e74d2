// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "chicane/base/deadline.hpp"
#include "chicane/solver/problem.hpp"
#include "chicane/solver/solution.hpp"
#include "chicane/tracking/tracking_problem.hpp"

/// Solver of the tracking problem behind an interface, so that one program holds a version for each
/// instruction set (base/instruction_set.hpp) and chooses one at the start.

namespace chicane::tracking {

/// States and inputs of the tracking problem along its horizon.
using TrackingTrajectory =
    solver::Trajectory<TrackingProblem::kNx, TrackingProblem::kNu, TrackingProblem::kCapacity>;

/// Solver of the tracking problem, compiled for one instruction set.
class TrackingSolver {
 public:
  virtual ~TrackingSolver() = default;
  /// Solves like OcpSolver::solve(), in at most `iterations` iterations.
  virtual solver::SolveReport solve(const TrackingProblem& problem, const TrackingProblem::State& start,
                                    TrackingTrajectory& trajectory, int iterations,
                                    Deadline deadline) noexcept = 0;
  /// Another solver with the same options. It solves alike: nothing is remembered from solve to solve.
  [[nodiscard]] virtual std::unique_ptr<TrackingSolver> copy() const = 0;
};

/// Makes a solver for the instruction set `Arch`. Defined in tracking_solver.cpp, which is compiled for each.
template <class Arch>
[[nodiscard]] std::unique_ptr<TrackingSolver> make_tracking_solver(const solver::SolverOptions& options);

/// Makes a solver for the chosen instruction set, with at most `most_iterations` in a step.
[[nodiscard]] std::unique_ptr<TrackingSolver> make_tracking_solver(int most_iterations);

}  // namespace chicane::tracking
