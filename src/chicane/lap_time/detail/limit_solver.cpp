// SPDX-License-Identifier: MIT
#include "chicane/lap_time/detail/limit_solver.hpp"

#include "chicane/solver/ocp_solver.hpp"

namespace chicane::lap_time {

struct LimitSolver::Implementation {
  explicit Implementation(const solver::SolverOptions& options) : ocp{options} {}
  solver::OcpSolver<LimitProblem, LimitProblem::kCapacity> ocp;
};

LimitSolver::LimitSolver(const solver::SolverOptions& options)
    : implementation_{std::make_unique<Implementation>(options)} {}
LimitSolver::~LimitSolver() = default;

solver::SolveReport LimitSolver::solve(const LimitProblem& problem, const LimitProblem::State& start,
                                       LimitTrajectory& trajectory, Deadline deadline) noexcept {
  return implementation_->ocp.solve(problem, start, trajectory, deadline);
}

}  // namespace chicane::lap_time
