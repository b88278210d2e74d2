// SPDX-License-Identifier: MIT
#include "solver/batch_cases.hpp"

#include <memory>

#include "chicane/solver/batch_solver.hpp"

namespace chicane::test {

template <class Arch>
void solve_batch(std::span<const BatchProblem> problems, std::span<const std::array<double, 7>> starts,
                 std::span<BatchTrajectory> trajectories, std::span<solver::SolveReport> reports) noexcept {
  struct GiveUp {
    solver::SolveReport operator()(const BatchProblem&, const std::array<double, 7>&,
                                   BatchTrajectory&) const noexcept {
      solver::SolveReport report;
      report.status = solver::SolveStatus::kStalled;
      return report;
    }
  };
  using Batch = solver::BatchSolver<bench::DescribedOver, Arch, kBatchCapacity>;
  const auto batch = std::make_unique<Batch>();
  batch->solve(problems, starts, trajectories, reports, GiveUp{});
}

template void solve_batch<arch::Native>(std::span<const BatchProblem>, std::span<const std::array<double, 7>>,
                                        std::span<BatchTrajectory>, std::span<solver::SolveReport>) noexcept;

}  // namespace chicane::test
