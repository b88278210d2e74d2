// SPDX-License-Identifier: MIT
#include "program/solves.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "problems/cpu_time.hpp"
#include "problems/families.hpp"
#include "problems/optimality.hpp"
#include "problems/structured_solver.hpp"

namespace chicane::bench {
namespace {

constexpr int kCapacity = kLongestHorizon;
constexpr int kTrials = 3;
constexpr double kLeastTime = 50e-6;  ///< of one trial: the clock itself takes some 0.2 µs [s]
constexpr double kMicroseconds = 1e6;

using Trajectory = DescribedTrajectory<kCapacity>;
template <class Problem>
using Case = Instance<Problem, kCapacity>;

/// What one solver did with one instance.
struct Sample {
  Outcome outcome;
  double sweeps = 0.0;
  double gradient = std::nan("");
  double cost = 0.0;
};

template <class Problem>
void judge(const Case<Problem>& instance, const Trajectory& answer, Sample& sample) {
  sample.cost = simulated_cost(instance.problem, instance.start, answer);
  if constexpr (Problem::kNc == 0) {
    sample.gradient = projected_gradient(instance.problem, instance.start, answer);
  }
}

/// Our solver on the structured form of the problem, with the instruction set that is chosen: the best of
/// some trials, each long enough for the clock.
template <class Problem>
Sample solve_own(const Case<Problem>& instance, Trajectory& answer) {
  Sample sample;
  const auto problem = structured(instance);
  const auto start = StructuredDescribedProblem::without_cte(instance.start);
  StructuredTrajectory own;
  own.horizon = instance.guess.horizon;
  const auto solve = [&] {
    std::copy_n(instance.guess.u.begin(), instance.guess.horizon, own.u.begin());
    return solve_fast(problem, start, own);
  };
  double begin = cpu_time();
  const solver::SolveReport report = solve();
  const int repeats = static_cast<int>(kLeastTime / std::max(cpu_time() - begin, 1e-6)) + 1;
  sample.outcome.time = std::numeric_limits<double>::infinity();
  for (int trial = 0; trial < kTrials; ++trial) {
    begin = cpu_time();
    for (int repeat = 0; repeat < repeats; ++repeat) solve();
    sample.outcome.time = std::min(sample.outcome.time, (cpu_time() - begin) / repeats);
  }
  sample.outcome.is_solved = report.status == solver::SolveStatus::kOptimal;
  sample.outcome.iterations = report.iterations;
  sample.sweeps = report.sweeps;
  answer = instance.guess;
  std::copy_n(own.u.begin(), own.horizon, answer.u.begin());
  judge(instance, answer, sample);
  return sample;
}

template <class Problem>
Sample solve_reference(const Case<Problem>& instance, const Case<Problem>* before,
                       Reference<Problem>& reference, Trajectory& answer) {
  Sample sample;
  sample.outcome = reference.solve(instance, before, answer);
  for (int trial = 1; trial < kTrials; ++trial) {
    const Outcome again = reference.solve(instance, before, answer);
    if (again.time < sample.outcome.time) sample.outcome = again;
  }
  judge(instance, answer, sample);
  return sample;
}

template <class Value>
std::vector<double> column(const std::vector<Sample>& samples, const Value& value) {
  std::vector<double> values;
  values.reserve(samples.size());
  for (const Sample& sample : samples) values.push_back(value(sample));
  return values;
}

SolverColumn summarize(std::string_view name, const std::vector<Sample>& samples,
                       const std::vector<Sample>& own) {
  SolverColumn result{.name = std::string(name)};
  if (samples.empty()) return result;
  result.time_us = spread_of(column(samples, [](const Sample& s) { return s.outcome.time * kMicroseconds; }));
  if (samples.front().outcome.time_in_functions > 0.0) {
    result.without_functions_us = spread_of(column(samples, [](const Sample& s) {
                                    return (s.outcome.time - s.outcome.time_in_functions) * kMicroseconds;
                                  })).median;
  }
  const auto count = static_cast<double>(samples.size());
  for (const Sample& sample : samples) {
    result.unsolved += sample.outcome.is_solved ? 0 : 1;
    result.mean_iterations += sample.outcome.iterations / count;
    result.mean_sweeps += sample.sweeps / count;
  }
  std::vector<double> gradients = column(samples, [](const Sample& s) { return s.gradient; });
  result.median_gradient = result.worst_gradient = std::nan("");
  if (!std::isnan(gradients.front())) {
    result.worst_gradient = *std::max_element(gradients.begin(), gradients.end());
    result.median_gradient = spread_of(std::move(gradients)).median;
  }
  result.worst_excess = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    result.worst_excess =
        std::max(result.worst_excess, (own[i].cost - samples[i].cost) / std::fabs(samples[i].cost));
  }
  return result;
}

template <class Problem>
void measure(Start start, int instances, References& references, const std::atomic<bool>& stop,
             SolveRow& row) {
  const auto ocp = std::make_unique<solver::OcpSolver<Problem, kCapacity>>();
  const auto answer = std::make_unique<Trajectory>();
  auto& others = references.of<Problem>();
  std::vector<Sample> own;
  std::vector<std::vector<Sample>> theirs(others.size());
  if (stop) return;
  // One more than is measured: the cycle before the first.
  const int count = kOwnInstances * instances + 1;
  const auto family = make_family<Problem, kCapacity>(start, row.horizon, count, *ocp);
  for (std::size_t i = 1; i < family.size() && !stop; ++i) {
    own.push_back(solve_own(family[i], *answer));
    if (i > static_cast<std::size_t>(instances)) continue;
    row.instances = static_cast<int>(i);
    for (std::size_t other = 0; other < others.size(); ++other) {
      if (others[other]->is_hot() && start != Start::kWarm) continue;
      theirs[other].push_back(solve_reference(family[i], &family[i - 1], *others[other], *answer));
    }
  }
  row.own_instances = static_cast<int>(own.size());
  row.own = summarize("own", own, own);
  own.resize(static_cast<std::size_t>(row.instances));
  row.own_shared = summarize("own", own, own);
  for (std::size_t other = 0; other < others.size(); ++other) {
    if (theirs[other].empty()) continue;
    row.references.push_back(summarize(others[other]->name(), theirs[other], own));
  }
}

}  // namespace

Spread spread_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    const double rank = std::ceil(share * static_cast<double>(values.size()));
    return values[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
  };
  return {at(0.5), at(0.99), at(0.999)};
}

const SolverColumn* SolveRow::reference(std::string_view name) const {
  for (const SolverColumn& column : references) {
    if (column.name == name) return &column;
  }
  return nullptr;
}

const std::vector<std::string_view>& families() {
  static const std::vector<std::string_view> names{"cold0", "coldP", "warm", "corridor", "corridor-warm"};
  return names;
}

SolveRow time_solves(std::string_view family, int horizon, int instances, References& references,
                     const std::atomic<bool>& stop) {
  SolveRow row{.family = family, .horizon = horizon};
  if (family == "cold0") measure<DescribedProblem>(Start::kCold, instances, references, stop, row);
  if (family == "coldP") measure<DescribedProblem>(Start::kPathLaw, instances, references, stop, row);
  if (family == "warm") measure<DescribedProblem>(Start::kWarm, instances, references, stop, row);
  if (family == "corridor") {
    measure<CorridorProblem>(Start::kPathLaw, instances, references, stop, row);
  }
  if (family == "corridor-warm") {
    measure<CorridorProblem>(Start::kWarm, instances, references, stop, row);
  }
  return row;
}

}  // namespace chicane::bench
