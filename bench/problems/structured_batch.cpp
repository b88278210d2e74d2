// SPDX-License-Identifier: MIT
#include "problems/structured_batch.hpp"

#include "chicane/solver/batch_solver.hpp"

namespace chicane::bench {
namespace {

template <template <class> class Problem, class Arch>
void solve(std::span<const Problem<double>> problems, std::span<const BatchState> starts,
           std::span<BatchTrajectory> trajectories, std::span<solver::SolveReport> reports) noexcept {
  static solver::BatchSolver<Problem, Arch, kBatchCapacity> batch;
  batch.solve(problems, starts, trajectories, reports, [](const auto&, const auto&, const auto&) {
    solver::SolveReport report;
    report.status = solver::SolveStatus::kStalled;
    return report;
  });
}

}  // namespace

template <class Arch>
void solve_batch(std::span<const DescribedOver<double>> problems, std::span<const BatchState> starts,
                 std::span<BatchTrajectory> trajectories, std::span<solver::SolveReport> reports) noexcept {
  solve<DescribedOver, Arch>(problems, starts, trajectories, reports);
}
template <class Arch>
void solve_batch(std::span<const CorridorOver<double>> problems, std::span<const BatchState> starts,
                 std::span<BatchTrajectory> trajectories, std::span<solver::SolveReport> reports) noexcept {
  solve<CorridorOver, Arch>(problems, starts, trajectories, reports);
}

template void solve_batch<arch::Native>(std::span<const DescribedOver<double>>, std::span<const BatchState>,
                                        std::span<BatchTrajectory>, std::span<solver::SolveReport>) noexcept;
template void solve_batch<arch::Native>(std::span<const CorridorOver<double>>, std::span<const BatchState>,
                                        std::span<BatchTrajectory>, std::span<solver::SolveReport>) noexcept;

}  // namespace chicane::bench
