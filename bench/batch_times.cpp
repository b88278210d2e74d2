// SPDX-License-Identifier: MIT
// Throughput of batches beside single solves of the same problems, with the instruction set that this program
// is compiled for: whole families of docs/benchmarks.md, least of 25 repeats, the two taking turns.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include "chicane/solver/batch_solver.hpp"
#include "chicane/solver/ocp_solver.hpp"
#include "problems/cpu_time.hpp"
#include "problems/described_batch.hpp"
#include "problems/families.hpp"

namespace {

using namespace chicane;
using bench::Start;

constexpr int kCapacity = 50;
constexpr int kRepeats = 25;

/// Several problems of one family as a batch takes them.
template <class Problem>
struct Family {
  using Trajectory = solver::Trajectory<Problem::kNx, Problem::kNu, kCapacity>;
  std::vector<Problem> problems;
  std::vector<std::array<double, 7>> starts;
  std::vector<Trajectory> guesses;

  template <class Plain>
  Family(Start start, int horizon, int count, solver::OcpSolver<Plain, kCapacity>& ocp) {
    for (const auto& instance : bench::make_family<Plain, kCapacity>(start, horizon, count, ocp)) {
      problems.push_back(bench::for_batch(instance.problem, instance.start[4], horizon));
      starts.push_back(bench::StructuredDescribedProblem::without_cte(instance.start));
      auto& guess = guesses.emplace_back();
      guess.horizon = horizon;
      std::copy_n(instance.guess.u.begin(), horizon, guess.u.begin());
    }
  }
};

/// What became of them.
struct Result {
  double least = 1e9;
  std::vector<solver::SolveReport> reports;

  void print(const char* name) const {
    const auto count = static_cast<double>(reports.size());
    double turns = 0.0;
    double sweeps = 0.0;
    for (const auto& report : reports) {
      turns += report.iterations / count;
      sweeps += report.sweeps / count;
    }
    std::printf("  %s %6.3f us, %.2f turns, %.2f sweeps;", name, 1e6 * least / count, turns, sweeps);
  }
};

template <class Plain, template <class> class Over>
void measure(const char* name, int horizon, Start start, int count = 192) {
  using Batch = solver::BatchSolver<Over, arch::Native, kCapacity>;
  using Single = solver::OcpSolver<Over<double>, kCapacity>;
  const auto plain = std::make_unique<solver::OcpSolver<Plain, kCapacity>>();
  const Family<Over<double>> family(start, horizon, count, *plain);
  const auto size = static_cast<std::size_t>(count);
  const auto batch = std::make_unique<Batch>();
  const auto single = std::make_unique<Single>();
  auto answers = family.guesses;
  Result lanes{.reports = std::vector<solver::SolveReport>(size)};
  Result one = lanes;
  int given_up = 0;
  const auto fallback = [&](const auto& problem, const auto& x0, auto& trajectory) {
    ++given_up;
    return single->solve(problem, x0, trajectory);
  };
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    given_up = 0;
    answers = family.guesses;
    double begin = bench::cpu_time();
    batch->solve(family.problems, family.starts, answers, lanes.reports, fallback);
    lanes.least = std::min(lanes.least, bench::cpu_time() - begin);
    answers = family.guesses;
    begin = bench::cpu_time();
    for (std::size_t i = 0; i < size; ++i)
      one.reports[i] = single->solve(family.problems[i], family.starts[i], answers[i]);
    one.least = std::min(one.least, bench::cpu_time() - begin);
  }
  int elsewhere = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const double cost = one.reports[i].cost;
    elsewhere += std::fabs(lanes.reports[i].cost - cost) > 1e-6 * cost ? 1 : 0;
  }
  std::printf("%-14s N = %2d: %5.0f thousand/s, %.2f times as many;", name, horizon,
              1e-3 * count / lanes.least, one.least / lanes.least);
  lanes.print("lanes");
  one.print("single");
  std::printf("  %d given up, %d other optima\n", given_up, elsewhere);
}

}  // namespace

int main() {
  using bench::CorridorOver;
  using bench::CorridorProblem;
  using bench::DescribedOver;
  using bench::DescribedProblem;
  for (const int horizon : {10, 20, 50}) {
    measure<DescribedProblem, DescribedOver>("cold0", horizon, Start::kCold);
    measure<DescribedProblem, DescribedOver>("coldP", horizon, Start::kPathLaw);
    measure<DescribedProblem, DescribedOver>("warm", horizon, Start::kWarm);
    measure<CorridorProblem, CorridorOver>("corridor", horizon, Start::kPathLaw);
    measure<CorridorProblem, CorridorOver>("corridor-warm", horizon, Start::kWarm);
  }
}
