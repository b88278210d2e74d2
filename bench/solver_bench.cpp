// SPDX-License-Identifier: MIT
// How long the solver takes: whole solves of the described problem and of the same with a soft corridor, and
// its three passes alone. Every iteration of a benchmark solves the next of 64 fixed random instances.
#include <benchmark/benchmark.h>

#include <memory>
#include <vector>

#include "chicane/solver/ocp_solver.hpp"
#include "problems/corridor_problem.hpp"
#include "problems/described_problem.hpp"

namespace {

using namespace chicane;
using bench::CorridorProblem;
using bench::DescribedProblem;

constexpr int kCapacity = 200;
constexpr int kInstances = 64;
using Trajectory = bench::DescribedTrajectory<kCapacity>;

template <class Problem>
struct Instance {
  Problem problem;
  std::array<double, 8> start{};
  Trajectory guess;
};

enum Start { kCold, kPathLaw, kWarm };

template <class Problem>
std::vector<Instance<Problem>> make_instances(int horizon, Start start) {
  Random random{1};
  const auto ocp = std::make_unique<solver::OcpSolver<Problem, kCapacity>>();
  std::vector<Instance<Problem>> instances(kInstances);
  for (auto& instance : instances) {
    if constexpr (Problem::kNc > 0) {
      const auto corridor = bench::random_corridor(random, horizon);
      instance.problem = corridor.problem;
      instance.start = corridor.start;
    } else {
      const auto plain = bench::random_instance(random, horizon);
      instance.problem = plain.problem;
      instance.start = plain.start;
    }
    instance.guess.horizon = horizon;
    bench::DescribedInstance plain;
    plain.problem = static_cast<const DescribedProblem&>(instance.problem);
    plain.start = instance.start;
    if (start != kCold) bench::guess_by_path_law(plain, instance.guess);
    if (start != kWarm) continue;
    Problem before = instance.problem;  // the cycle before: a step earlier, another speed wanted
    before.speed_reference -= 0.5;
    auto x0 = instance.start;
    x0[1] -= 0.05;
    x0[4] += 0.05;
    ocp->solve(before, x0, instance.guess);
  }
  return instances;
}

template <class Problem, Start start>
void Solve(benchmark::State& state) {
  const auto instances = make_instances<Problem>(static_cast<int>(state.range(0)), start);
  const auto ocp = std::make_unique<solver::OcpSolver<Problem, kCapacity>>();
  const auto trajectory = std::make_unique<Trajectory>();
  std::size_t next = 0;
  std::int64_t turns = 0;
  std::int64_t sweeps = 0;
  std::int64_t unsolved = 0;
  for (auto _ : state) {
    const auto& instance = instances[next];
    next = (next + 1) % instances.size();
    *trajectory = instance.guess;
    const auto report = ocp->solve(instance.problem, instance.start, *trajectory);
    turns += report.iterations;
    sweeps += report.sweeps;
    unsolved += report.status == solver::SolveStatus::kOptimal ? 0 : 1;
  }
  state.counters["turns"] =
      benchmark::Counter(static_cast<double>(turns), benchmark::Counter::kAvgIterations);
  state.counters["unsolved"] =
      benchmark::Counter(static_cast<double>(unsolved), benchmark::Counter::kAvgIterations);
  state.counters["sweeps"] =
      benchmark::Counter(static_cast<double>(sweeps), benchmark::Counter::kAvgIterations);
}
BENCHMARK(Solve<DescribedProblem, kCold>)
    ->Arg(10)
    ->Arg(20)
    ->Arg(50)
    ->Arg(100)
    ->Arg(200)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(Solve<DescribedProblem, kPathLaw>)
    ->Arg(10)
    ->Arg(20)
    ->Arg(50)
    ->Arg(100)
    ->Arg(200)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(Solve<DescribedProblem, kWarm>)
    ->Arg(10)
    ->Arg(20)
    ->Arg(50)
    ->Arg(100)
    ->Arg(200)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(Solve<CorridorProblem, kPathLaw>)->Arg(10)->Arg(20)->Arg(40)->Unit(benchmark::kMicrosecond);
BENCHMARK(Solve<CorridorProblem, kWarm>)->Arg(10)->Arg(20)->Arg(40)->Unit(benchmark::kMicrosecond);

/// One pass over 100 stages; reported as seconds for each stage.
struct Passes {
  static constexpr int kStages = 100;
  using Lin = solver::Linearisation<DescribedProblem, kCapacity>;
  std::vector<Instance<DescribedProblem>> instances = make_instances<DescribedProblem>(kStages, kPathLaw);
  std::unique_ptr<Lin> now = std::make_unique<Lin>();
  std::unique_ptr<Lin::Lq> lq = std::make_unique<Lin::Lq>();
  Trajectory trajectory = instances[0].guess;
  solver::SolveReport report;

  Passes() {
    solver::roll_out(instances[0].problem, instances[0].start, trajectory);
    now->evaluate(instances[0].problem, trajectory, *lq, report);
    now->measure(trajectory, *lq, report);
    lq->backward(kStages, 0.0, true);
  }
};

template <class Pass>
void per_stage(benchmark::State& state, const Pass& pass) {
  for (auto _ : state) {
    pass();
    benchmark::ClobberMemory();
  }
  state.counters["s/stage"] = benchmark::Counter(
      Passes::kStages, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void FirstDerivatives(benchmark::State& state) {
  Passes p;
  per_stage(state, [&] { p.now->evaluate(p.instances[0].problem, p.trajectory, *p.lq, p.report); });
}
void SecondDerivatives(benchmark::State& state) {
  Passes p;
  per_stage(state, [&] { p.now->evaluate_curvature(p.instances[0].problem, p.trajectory); });
}
void Adjoint(benchmark::State& state) {
  Passes p;
  per_stage(state, [&] { p.now->measure(p.trajectory, *p.lq, p.report); });
}
void BackwardSweep(benchmark::State& state) {
  Passes p;
  per_stage(state, [&] { benchmark::DoNotOptimize(p.lq->backward(Passes::kStages, 0.0, false)); });
}
void ForwardSweep(benchmark::State& state) {
  Passes p;
  per_stage(state, [&] {
    benchmark::DoNotOptimize(p.lq->forward(Passes::kStages, Passes::Lin::Lq::Repair::kLast));
  });
}
BENCHMARK(FirstDerivatives);
BENCHMARK(SecondDerivatives);
BENCHMARK(Adjoint);
BENCHMARK(BackwardSweep);
BENCHMARK(ForwardSweep);

}  // namespace
