// SPDX-License-Identifier: MIT
#include "solver/batch_cases.hpp"

#include "chicane/solver/batch_solver.hpp"

namespace chicane::test {

template <class Arch, template <class> class Problem>
void solve_batch(std::span<const Problem<double>> problems, std::span<const BatchState> starts,
                 std::span<BatchTrajectory> trajectories, std::span<solver::SolveReport> reports,
                 BatchFallback<Problem<double>> fallback) noexcept {
  static solver::BatchSolver<Problem, Arch, kBatchCapacity> batch;
  batch.solve(problems, starts, trajectories, reports, fallback);
}

template void solve_batch<arch::Native, bench::DescribedOver>(
    std::span<const bench::DescribedOver<double>>, std::span<const BatchState>, std::span<BatchTrajectory>,
    std::span<solver::SolveReport>, BatchFallback<bench::DescribedOver<double>>) noexcept;
template void solve_batch<arch::Native, CappedCorridor>(std::span<const CappedCorridor<double>>,
                                                        std::span<const BatchState>,
                                                        std::span<BatchTrajectory>,
                                                        std::span<solver::SolveReport>,
                                                        BatchFallback<CappedCorridor<double>>) noexcept;

}  // namespace chicane::test
