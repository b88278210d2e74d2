// SPDX-License-Identifier: MIT
// Times of converged solves of the described problem, structured and dense, with the instruction set that
// this program is compiled for: medians over 64 fixed random instances, each the least of 40 repeats.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <type_traits>
#include <vector>

#include "chicane/solver/ocp_solver.hpp"
#include "problems/cpu_time.hpp"
#include "problems/described_problem.hpp"

namespace {

using namespace chicane;
using bench::DescribedInstance;
using bench::DescribedProblem;
using bench::StructuredDescribedProblem;

constexpr int kCapacity = 200;
constexpr int kInstances = 64;
constexpr int kRepeats = 40;
enum Start { kCold, kPathLaw, kWarm };

template <class P>
P problem_of(const DescribedInstance& instance) {
  if constexpr (std::is_same_v<P, DescribedProblem>) {
    return instance.problem;
  } else {
    return P{instance.problem, instance.start[4]};
  }
}
template <class P>
auto start_of(const DescribedInstance& instance) {
  if constexpr (std::is_same_v<P, DescribedProblem>) {
    return instance.start;
  } else {
    return P::without_cte(instance.start);
  }
}

/// The car one interval later: pushed aside, with another speed wanted; measured anew.
void drive_on(Random& random, const std::array<double, 2>& input, DescribedInstance& instance) {
  auto x = instance.problem.dynamics(0, instance.start, input);
  x[1] += random.uniform(-0.1, 0.1);
  x[3] += random.uniform(-0.1, 0.1);
  instance.problem.speed_reference += random.uniform(-0.5, 0.5);
  const auto& p = instance.problem.path;
  x[4] = p[0] + x[0] * (p[1] + x[0] * (p[2] + x[0] * p[3])) - x[1];
  x[5] = x[2] - chicane::atan(p[1] + x[0] * (2.0 * p[2] + x[0] * 3.0 * p[3]));
  instance.start = x;
}

template <class P>
void measure(const char* name, int horizon, Start start) {
  const auto ocp = std::make_unique<solver::OcpSolver<P, kCapacity>>();
  const auto answer = std::make_unique<solver::Trajectory<P::kNx, 2, kCapacity>>();
  const auto guess = std::make_unique<bench::DescribedTrajectory<kCapacity>>();
  Random random{1};
  std::vector<double> times;
  double iterations = 0.0;
  double sweeps = 0.0;
  int unsolved = 0;
  for (int i = 0; i < kInstances; ++i) {
    DescribedInstance instance = bench::random_instance(random, horizon);
    *guess = {};
    guess->horizon = horizon;
    if (start != kCold) bench::guess_by_path_law(instance, *guess);
    if (start == kWarm) {
      answer->horizon = horizon;
      answer->u = guess->u;
      ocp->solve(problem_of<P>(instance), start_of<P>(instance), *answer);
      drive_on(random, answer->u[0], instance);
      solver::shift(*answer, 1.0);
      guess->u = answer->u;
    }
    double least = 1e9;
    solver::SolveReport report;
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
      answer->horizon = horizon;
      answer->u = guess->u;
      const P problem = problem_of<P>(instance);
      const auto x0 = start_of<P>(instance);
      const double begin = bench::cpu_time();
      report = ocp->solve(problem, x0, *answer);
      least = std::min(least, bench::cpu_time() - begin);
    }
    times.push_back(1e6 * least);
    iterations += static_cast<double>(report.iterations) / kInstances;
    sweeps += static_cast<double>(report.sweeps) / kInstances;
    unsolved += report.status == solver::SolveStatus::kOptimal ? 0 : 1;
  }
  std::sort(times.begin(), times.end());
  constexpr const char* kNames[] = {"cold", "path law", "warm"};
  std::printf(
      "%-10s %-8s N = %3d: median %7.2f us, largest %7.2f us, %.1f iterations, %.1f sweeps, %d unsolved\n",
      name, kNames[start], horizon, times[times.size() / 2], times.back(), iterations, sweeps, unsolved);
}

}  // namespace

int main() {
  for (const Start start : {kCold, kPathLaw, kWarm}) {
    for (const int horizon : {10, 20, 50, 100, 200})
      measure<StructuredDescribedProblem>("structured", horizon, start);
  }
  for (const Start start : {kCold, kPathLaw, kWarm}) measure<DescribedProblem>("dense", 20, start);
}
