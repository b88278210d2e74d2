// SPDX-License-Identifier: MIT
#include "bench_batches.hpp"

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

namespace chicane::apps {
namespace {

using bench::Start;
using solver::SolveReport;
using solver::SolveStatus;

constexpr int kRepeats = 15;

/// One family in the forms that the two solvers take.
template <class Plain>
struct Problems {
  using Many = decltype(bench::for_batch(Plain{}, 0.0, 0));
  using Single = std::conditional_t<(Plain::kNc > 0), bench::StructuredCorridorProblem,
                                    bench::StructuredDescribedProblem>;
  std::vector<Many> many;
  std::vector<Single> single;
  std::vector<bench::BatchState> starts;
  std::vector<bench::BatchTrajectory> guesses;

  Problems(Start start, int horizon, int count) {
    const auto ocp = std::make_unique<solver::OcpSolver<Plain, bench::kLongestHorizon>>();
    for (const auto& instance :
         bench::make_family<Plain, bench::kLongestHorizon>(start, horizon, count, *ocp)) {
      const double cte = instance.start[4];
      many.push_back(bench::for_batch(instance.problem, cte, horizon));
      if constexpr (Plain::kNc > 0) {
        single.emplace_back(instance.problem, cte, horizon);
      } else {
        single.emplace_back(instance.problem, cte);
      }
      starts.push_back(bench::StructuredDescribedProblem::without_cte(instance.start));
      auto& guess = guesses.emplace_back();
      guess.horizon = horizon;
      std::copy_n(instance.guess.u.begin(), horizon, guess.u.begin());
    }
  }
  /// Problem i by the single solver.
  SolveReport solve(std::size_t i, bench::StructuredTrajectory& trajectory) const {
    trajectory.horizon = guesses[i].horizon;
    std::copy_n(guesses[i].u.begin(), trajectory.horizon, trajectory.u.begin());
    return bench::solve_fast(single[i], starts[i], trajectory);
  }
};

template <class Plain>
void measure(Start start, const std::atomic<bool>& stop, BatchRow& row) {
  const Problems<Plain> problems(start, row.horizon, row.problems);
  const std::size_t count = problems.many.size();
  std::vector<bench::BatchTrajectory> answers;
  std::vector<SolveReport> reports(count);
  std::vector<SolveReport> alone(count);
  const auto trajectory = std::make_unique<bench::StructuredTrajectory>();
  double least = std::numeric_limits<double>::infinity();
  double least_alone = least;
  for (int repeat = 0; repeat < kRepeats && (repeat == 0 || !stop); ++repeat) {
    answers = problems.guesses;
    double begin = bench::cpu_time();
    bench::solve_batch_fast<typename Problems<Plain>::Many>(problems.many, problems.starts, answers, reports);
    row.handed_over = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (reports[i].status != SolveStatus::kStalled) continue;
      reports[i] = problems.solve(i, *trajectory);
      ++row.handed_over;
    }
    least = std::min(least, bench::cpu_time() - begin);
    begin = bench::cpu_time();
    for (std::size_t i = 0; i < count; ++i) alone[i] = problems.solve(i, *trajectory);
    least_alone = std::min(least_alone, bench::cpu_time() - begin);
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
  if (family == "cold0") measure<bench::DescribedProblem>(Start::kCold, stop, row);
  if (family == "coldP") measure<bench::DescribedProblem>(Start::kPathLaw, stop, row);
  if (family == "warm") measure<bench::DescribedProblem>(Start::kWarm, stop, row);
  if (family == "corridor") measure<bench::CorridorProblem>(Start::kPathLaw, stop, row);
  if (family == "corridor-warm") measure<bench::CorridorProblem>(Start::kWarm, stop, row);
  return row;
}

}  // namespace chicane::apps
