// SPDX-License-Identifier: MIT
// Solver of the problem of `cubic-mpc`. This file is compiled once for each instruction set
// (base/instruction_set.hpp).
#include "chicane/controller/cubic_solver.hpp"

#include "chicane/solver/ocp_solver.hpp"

namespace chicane::controller {
namespace {

/// Solver with the instruction set `Arch`.
template <class Arch>
class ArchSolver final : public CubicSolver {
 public:
  explicit ArchSolver(const solver::SolverOptions& options) : options_{options}, solver_{options} {}

  solver::SolveReport solve(const CubicProblem& problem, const CubicProblem::State& start,
                            CubicTrajectory& trajectory, Deadline deadline) noexcept override {
    return solver_.solve(problem, start, trajectory, deadline);
  }
  [[nodiscard]] std::unique_ptr<CubicSolver> copy() const override {
    return std::make_unique<ArchSolver>(options_);
  }

 private:
  solver::SolverOptions options_;
  solver::OcpSolver<CubicProblem, CubicProblem::kCapacity, Arch> solver_;
};

}  // namespace

template <class Arch>
std::unique_ptr<CubicSolver> make_cubic_solver(const solver::SolverOptions& options) {
  return std::make_unique<ArchSolver<Arch>>(options);
}

template std::unique_ptr<CubicSolver> make_cubic_solver<arch::Native>(const solver::SolverOptions&);

}  // namespace chicane::controller
