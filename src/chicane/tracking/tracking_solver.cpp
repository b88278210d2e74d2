// SPDX-License-Identifier: MIT
// Solver of the tracking problem. This file is compiled once for each instruction set
// (base/instruction_set.hpp).
#include "chicane/tracking/tracking_solver.hpp"

#include "chicane/solver/ocp_solver.hpp"

namespace chicane::tracking {
namespace {

/// OcpSolver behind the interface that all instruction sets share.
template <class Arch>
class ArchSolver final : public TrackingSolver {
 public:
  explicit ArchSolver(const solver::SolverOptions& options) : options_{options}, solver_{options} {}

  solver::SolveReport solve(const TrackingProblem& problem, const TrackingProblem::State& start,
                            TrackingTrajectory& trajectory, int iterations,
                            Deadline deadline) noexcept override {
    solver_.allow_iterations(iterations);
    return solver_.solve(problem, start, trajectory, deadline);
  }
  [[nodiscard]] std::unique_ptr<TrackingSolver> copy() const override {
    return std::make_unique<ArchSolver>(options_);
  }

 private:
  solver::SolverOptions options_;
  solver::OcpSolver<TrackingProblem, TrackingProblem::kCapacity, Arch> solver_;
};

}  // namespace

template <class Arch>
std::unique_ptr<TrackingSolver> make_tracking_solver(const solver::SolverOptions& options) {
  return std::make_unique<ArchSolver<Arch>>(options);
}

template std::unique_ptr<TrackingSolver> make_tracking_solver<arch::Native>(const solver::SolverOptions&);

}  // namespace chicane::tracking
