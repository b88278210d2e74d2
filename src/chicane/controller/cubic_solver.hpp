// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "chicane/base/deadline.hpp"
#include "chicane/controller/cubic_problem.hpp"
#include "chicane/solver/problem.hpp"
#include "chicane/solver/solution.hpp"

namespace chicane::controller {

using CubicTrajectory = solver::Trajectory<CubicProblem::kNx, CubicProblem::kNu, CubicProblem::kCapacity>;

/// The solver of the described problem, whatever instruction set it is compiled for
/// (base/instruction_set.hpp).
class CubicSolver {
 public:
  virtual ~CubicSolver() = default;
  /// As OcpSolver::solve().
  virtual solver::SolveReport solve(const CubicProblem& problem, const CubicProblem::State& start,
                                    CubicTrajectory& trajectory, Deadline deadline) noexcept = 0;
  /// One like it: nothing is remembered from solve to solve.
  [[nodiscard]] virtual std::unique_ptr<CubicSolver> copy() const = 0;
};
[[nodiscard]] inline std::unique_ptr<CubicSolver> copy_of(const CubicSolver& solver) { return solver.copy(); }

/// For one instruction set; defined in cubic_solver.cpp, which is compiled for each.
template <class Arch>
[[nodiscard]] std::unique_ptr<CubicSolver> make_cubic_solver(const solver::SolverOptions& options);

/// For the instruction set of this machine (chosen_instruction_set()), with the options of `cubic-mpc`.
[[nodiscard]] std::unique_ptr<CubicSolver> make_cubic_solver();

/// The controller `cubic-mpc` with another solver of its problem, to compare solvers on the road. Pre:
/// `solver` is not null.
[[nodiscard]] Result<std::unique_ptr<Controller>> make_cubic_mpc_with(const CubicMpcOptions& options,
                                                                      const model::VehicleParams& vehicle,
                                                                      std::unique_ptr<CubicSolver> solver);

}  // namespace chicane::controller
