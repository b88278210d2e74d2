// SPDX-License-Identifier: MIT
#include "program/batches.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <type_traits>
#include <vector>

#include "problems/cpu_time.hpp"
#include "problems/families.hpp"
#include "problems/reference.hpp"
#include "problems/structured_batch.hpp"
#include "problems/structured_solver.hpp"

namespace chicane::bench {
namespace {

using solver::SolveReport;
using solver::SolveStatus;

constexpr int kRepeats = 15;

/// One family in the forms that the two solvers take.
template <class Plain>
struct Problems {
  using Many = decltype(for_batch(Plain{}, 0.0, 0));
  using Single = std::conditional_t<(Plain::kNc > 0), StructuredCorridorProblem, StructuredDescribedProblem>;
  std::vector<Many> many;
  std::vector<Single> single;
  std::vector<BatchState> starts;
  std::vector<BatchTrajectory> guesses;

  Problems(Start start, int horizon, int count) {
    const auto ocp = std::make_unique<solver::OcpSolver<Plain, kLongestHorizon>>();
    for (const auto& instance : make_family<Plain, kLongestHorizon>(start, horizon, count, *ocp)) {
      const double cte = instance.start[4];
      many.push_back(for_batch(instance.problem, cte, horizon));
      if constexpr (Plain::kNc > 0) {
        single.emplace_back(instance.problem, cte, horizon);
      } else {
        single.emplace_back(instance.problem, cte);
      }
      starts.push_back(StructuredDescribedProblem::without_cte(instance.start));
      auto& guess = guesses.emplace_back();
      guess.horizon = horizon;
      std::copy_n(instance.guess.u.begin(), horizon, guess.u.begin());
    }
  }
  /// Problem i by the single solver.
  SolveReport solve(std::size_t i, StructuredTrajectory& trajectory) const {
    trajectory.horizon = guesses[i].horizon;
    std::copy_n(guesses[i].u.begin(), trajectory.horizon, trajectory.u.begin());
    return solve_fast(single[i], starts[i], trajectory);
  }
};

template <class Plain>
void measure(Start start, const std::atomic<bool>& stop, BatchRow& row) {
  const Problems<Plain> problems(start, row.horizon, row.problems);
  const std::size_t count = problems.many.size();
  std::vector<BatchTrajectory> answers;
  std::vector<SolveReport> reports(count);
  std::vector<SolveReport> alone(count);
  const auto trajectory = std::make_unique<StructuredTrajectory>();
  double least = std::numeric_limits<double>::infinity();
  double least_alone = least;
  for (int repeat = 0; repeat < kRepeats && (repeat == 0 || !stop); ++repeat) {
    answers = problems.guesses;
    double begin = cpu_time();
    solve_batch_fast<typename Problems<Plain>::Many>(problems.many, problems.starts, answers, reports);
    row.handed_over = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (reports[i].status != SolveStatus::kStalled) continue;
      reports[i] = problems.solve(i, *trajectory);
      ++row.handed_over;
    }
    least = std::min(least, cpu_time() - begin);
    begin = cpu_time();
    for (std::size_t i = 0; i < count; ++i) alone[i] = problems.solve(i, *trajectory);
    least_alone = std::min(least_alone, cpu_time() - begin);
  }
  row.per_second = static_cast<double>(count) / least;
  row.single_per_second = static_cast<double>(count) / least_alone;
  row.worst_excess = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < count; ++i) {
    row.mean_turns += reports[i].iterations / static_cast<double>(count);
    row.unsolved += reports[i].status == SolveStatus::kOptimal ? 0 : 1;
    row.worst_excess = std::max(row.worst_excess, (reports[i].cost - alone[i].cost) / alone[i].cost);
  }
}

}  // namespace

BatchRow time_batch(std::string_view family, int horizon, int problems, const std::atomic<bool>& stop) {
  BatchRow row{.family = family, .horizon = horizon, .problems = problems};
  if (family == "cold0") measure<DescribedProblem>(Start::kCold, stop, row);
  if (family == "coldP") measure<DescribedProblem>(Start::kPathLaw, stop, row);
  if (family == "warm") measure<DescribedProblem>(Start::kWarm, stop, row);
  if (family == "corridor") measure<CorridorProblem>(Start::kPathLaw, stop, row);
  if (family == "corridor-warm") measure<CorridorProblem>(Start::kWarm, stop, row);
  return row;
}

}  // namespace chicane::bench
