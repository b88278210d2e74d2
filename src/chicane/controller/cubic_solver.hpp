// SPDX-License-Identifier: MIT
// Solver of the optimal control problem of `cubic-mpc`, behind an interface that hides the instruction set.
#pragma once

#include <memory>

#include "chicane/base/deadline.hpp"
#include "chicane/controller/cubic_problem.hpp"
#include "chicane/solver/problem.hpp"
#include "chicane/solver/solution.hpp"

namespace chicane::controller {

using CubicTrajectory = solver::Trajectory<CubicProblem::kNx, CubicProblem::kNu, CubicProblem::kCapacity>;

/// Solver of the problem of `cubic-mpc` (cubic_problem.hpp), compiled for each instruction set
/// (base/instruction_set.hpp) behind this interface.
class CubicSolver {
 public:
  virtual ~CubicSolver() = default;
  /// Solves from `start`, with `trajectory` as the guess and the answer, as OcpSolver::solve() does.
  virtual solver::SolveReport solve(const CubicProblem& problem, const CubicProblem::State& start,
                                    CubicTrajectory& trajectory, Deadline deadline) noexcept = 0;
  /// Solver with the same options. There is no other state between solves.
  [[nodiscard]] virtual std::unique_ptr<CubicSolver> copy() const = 0;
};

/// Makes the solver for one instruction set; defined in cubic_solver.cpp, which is compiled for each.
template <class Arch>
[[nodiscard]] std::unique_ptr<CubicSolver> make_cubic_solver(const solver::SolverOptions& options);

/// Makes the solver for the instruction set of this machine (chosen_instruction_set()), with the options of
/// `cubic-mpc`.
[[nodiscard]] std::unique_ptr<CubicSolver> make_cubic_solver();

/// Makes the controller `cubic-mpc` with another solver, to compare solvers on the road. Pre: `solver` is not
/// null. Fails as make_cubic_mpc().
[[nodiscard]] Result<std::unique_ptr<Controller>> make_cubic_mpc_with(const CubicMpcOptions& options,
                                                                      const model::VehicleParams& vehicle,
                                                                      std::unique_ptr<CubicSolver> solver);

}  // namespace chicane::controller
