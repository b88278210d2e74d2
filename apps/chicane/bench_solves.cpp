// SPDX-License-Identifier: MIT
#include "bench_solves.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>

#include "problems/cpu_time.hpp"
#include "problems/families.hpp"
#include "problems/optimality.hpp"

#ifdef CHICANE_HAVE_IPOPT
#include "problems/ipopt_solver.hpp"
#endif

namespace chicane::apps {
namespace {

using bench::Start;

constexpr int kCapacity = kLongestHorizon;
constexpr int kRepeats = 3;
constexpr double kMicroseconds = 1e6;

template <class Problem>
using Instance = bench::FamilyInstance<Problem, kCapacity>;
using Trajectory = bench::DescribedTrajectory<kCapacity>;

/// What one solver did with one instance.
struct Sample {
  double time = std::numeric_limits<double>::infinity();    // [s]
  double linear = std::numeric_limits<double>::infinity();  // [s]
  bool is_solved = true;
  int turns = 0;
  double gradient = std::nan("");
  double cost = 0.0;
};

template <class Problem>
void judge(const Instance<Problem>& instance, const Trajectory& answer, Sample& sample) {
  sample.cost = bench::simulated_cost(instance.problem, instance.start, answer);
  if constexpr (Problem::kNc == 0) {
    sample.gradient = bench::projected_gradient(instance.problem, instance.start, answer);
  }
}

template <class Problem>
Sample solve_own(const Instance<Problem>& instance, solver::OcpSolver<Problem, kCapacity>& ocp,
                 Trajectory& answer) {
  Sample sample;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    answer = instance.guess;
    const double begin = bench::cpu_time();
    const solver::SolveReport report = ocp.solve(instance.problem, instance.start, answer);
    sample.time = std::min(sample.time, bench::cpu_time() - begin);
    sample.is_solved = report.status == solver::SolveStatus::kOptimal;
    sample.turns = report.iterations;
  }
  judge(instance, answer, sample);
  return sample;
}

#ifdef CHICANE_HAVE_IPOPT
template <class Problem>
Sample solve_ipopt(const Instance<Problem>& instance, bench::IpoptSolver<Problem>& ipopt, bool is_warm,
                   Trajectory& answer) {
  Sample sample;
  if (is_warm) {
    answer = instance.guess_before;
    ipopt.solve(instance.before, instance.start_before, answer);
    ipopt.remember();
  }
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    answer = instance.guess;
    const bench::IpoptReport report = is_warm ? ipopt.solve_warm(instance.problem, instance.start, answer)
                                              : ipopt.solve(instance.problem, instance.start, answer);
    sample.time = std::min(sample.time, report.time);
    sample.linear = std::min(sample.linear, report.time - report.time_in_functions);
    sample.is_solved = report.is_solved;
    sample.turns = report.iterations;
  }
  judge(instance, answer, sample);
  return sample;
}
#endif

template <class Value>
std::vector<double> column(const std::vector<Sample>& samples, const Value& value) {
  std::vector<double> values;
  for (const Sample& sample : samples) values.push_back(value(sample));
  return values;
}

SolverColumn summarize(const std::vector<Sample>& samples, const std::vector<Sample>& other) {
  SolverColumn result;
  if (samples.empty()) return result;
  result.time_us = spread_of(column(samples, [](const Sample& s) { return s.time * kMicroseconds; }));
  if (std::isfinite(samples.front().linear)) {
    result.linear_us = spread_of(column(samples, [](const Sample& s) { return s.linear * kMicroseconds; }));
  }
  for (const Sample& sample : samples) {
    result.unsolved += sample.is_solved ? 0 : 1;
    result.mean_turns += static_cast<double>(sample.turns) / static_cast<double>(samples.size());
  }
  std::vector<double> gradients = column(samples, [](const Sample& s) { return s.gradient; });
  result.median_gradient = result.worst_gradient = std::nan("");
  if (!std::isnan(gradients.front())) {
    result.worst_gradient = *std::max_element(gradients.begin(), gradients.end());
    result.median_gradient = spread_of(std::move(gradients)).median;
  }
  result.worst_excess = other.empty() ? std::nan("") : -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < other.size(); ++i) {
    result.worst_excess =
        std::max(result.worst_excess, (samples[i].cost - other[i].cost) / std::fabs(other[i].cost));
  }
  return result;
}

template <class Problem>
void measure(Start start, int instances, [[maybe_unused]] bool with_ipopt, const std::atomic<bool>& stop,
             SolveRow& row) {
  const auto ocp = std::make_unique<solver::OcpSolver<Problem, kCapacity>>();
  const auto answer = std::make_unique<Trajectory>();
  std::vector<Sample> own;
  std::vector<Sample> ipopt;
  std::vector<Sample> ipopt_warm;
#ifdef CHICANE_HAVE_IPOPT
  bench::IpoptSolver<Problem> reference;
#endif
  Random random{static_cast<std::uint64_t>(7000 + row.horizon)};
  for (int i = 0; i < instances && !stop; ++i) {
    const auto instance =
        std::make_unique<const Instance<Problem>>(bench::next_instance(random, row.horizon, start, *ocp));
    own.push_back(solve_own(*instance, *ocp, *answer));
#ifdef CHICANE_HAVE_IPOPT
    if (!with_ipopt) continue;
    ipopt.push_back(solve_ipopt(*instance, reference, false, *answer));
    if (start == Start::kWarm) ipopt_warm.push_back(solve_ipopt(*instance, reference, true, *answer));
#endif
  }
  row.instances = static_cast<int>(own.size());
  row.own = summarize(own, ipopt);
  if (!ipopt.empty()) row.ipopt = summarize(ipopt, own);
  if (!ipopt_warm.empty()) row.ipopt_warm = summarize(ipopt_warm, own);
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

const std::vector<std::string_view>& families() {
  static const std::vector<std::string_view> names{"cold0", "coldP", "warm", "corridor", "corridor-warm"};
  return names;
}

std::string ipopt_version() {
#ifdef CHICANE_HAVE_IPOPT
  return IPOPT_VERSION;
#else
  return "";
#endif
}

SolveRow time_solves(std::string_view family, int horizon, int instances, bool with_ipopt,
                     const std::atomic<bool>& stop) {
  SolveRow row{.family = family, .horizon = horizon};
  if (family == "cold0") measure<bench::DescribedProblem>(Start::kCold, instances, with_ipopt, stop, row);
  if (family == "coldP") measure<bench::DescribedProblem>(Start::kPathLaw, instances, with_ipopt, stop, row);
  if (family == "warm") measure<bench::DescribedProblem>(Start::kWarm, instances, with_ipopt, stop, row);
  if (family == "corridor") {
    measure<bench::CorridorProblem>(Start::kPathLaw, instances, with_ipopt, stop, row);
  }
  if (family == "corridor-warm") {
    measure<bench::CorridorProblem>(Start::kWarm, instances, with_ipopt, stop, row);
  }
  return row;
}

}  // namespace chicane::apps
