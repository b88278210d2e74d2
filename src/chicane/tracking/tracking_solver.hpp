// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "chicane/base/deadline.hpp"
#include "chicane/solver/problem.hpp"
#include "chicane/solver/solution.hpp"
#include "chicane/tracking/tracking_problem.hpp"

namespace chicane::tracking {

using TrackingTrajectory =
    solver::Trajectory<TrackingProblem::kNx, TrackingProblem::kNu, TrackingProblem::kCapacity>;

/// The solver of the tracking problem, whatever instruction set it is compiled for
/// (base/instruction_set.hpp).
class TrackingSolver {
 public:
  virtual ~TrackingSolver() = default;
  /// As OcpSolver::solve(), in at most `iterations` iterations.
  virtual solver::SolveReport solve(const TrackingProblem& problem, const TrackingProblem::State& start,
                                    TrackingTrajectory& trajectory, int iterations,
                                    Deadline deadline) noexcept = 0;
  /// One like it: nothing is remembered from solve to solve.
  [[nodiscard]] virtual std::unique_ptr<TrackingSolver> copy() const = 0;
};
[[nodiscard]] inline std::unique_ptr<TrackingSolver> copy_of(const TrackingSolver& solver) {
  return solver.copy();
}

/// For one instruction set; defined in tracking_solver.cpp, which is compiled for each.
template <class Arch>
[[nodiscard]] std::unique_ptr<TrackingSolver> make_tracking_solver(const solver::SolverOptions& options);

/// For the instruction set that was chosen; solves in real time, with at most `most_iterations` in a step.
[[nodiscard]] std::unique_ptr<TrackingSolver> make_tracking_solver(int most_iterations);

}  // namespace chicane::tracking
