// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "chicane/base/deadline.hpp"
#include "chicane/lap_time/detail/limit_problem.hpp"
#include "chicane/solver/problem.hpp"
#include "chicane/solver/solution.hpp"

namespace chicane::lap_time {

using LimitTrajectory = solver::Trajectory<LimitProblem::kNx, LimitProblem::kNu, LimitProblem::kCapacity>;

/// The solver of the minimum-time problem: OcpSolver, compiled once for this problem. About 60 MB.
class LimitSolver {
 public:
  explicit LimitSolver(const solver::SolverOptions& options);
  ~LimitSolver();
  LimitSolver(const LimitSolver&) = delete;
  LimitSolver& operator=(const LimitSolver&) = delete;

  /// As OcpSolver::solve().
  [[nodiscard]] solver::SolveReport solve(const LimitProblem& problem, const LimitProblem::State& start,
                                          LimitTrajectory& trajectory,
                                          Deadline deadline = Deadline::never()) noexcept;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace chicane::lap_time
