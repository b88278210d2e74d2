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
  std::int64_t iterations = 0;
  std::int64_t sweeps = 0;
  std::int64_t unsolved = 0;
  for (auto _ : state) {
    const auto& instance = instances[next];
    next = (next + 1) % instances.size();
    *trajectory = instance.guess;
    const auto report = ocp->solve(instance.problem, instance.start, *trajectory);
    iterations += report.iterations;
    sweeps += report.sweeps;
    unsolved += report.status == solver::SolveStatus::kOptimal ? 0 : 1;
  }
  state.counters["iterations"] =
      benchmark::Counter(static_cast<double>(iterations), benchmark::Counter::kAvgIterations);
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
  using Problem = bench::StructuredDescribedProblem;
  using Arch = arch::Native;
  using Lq = solver::LqSolver<Arch, solver::ProblemPattern<Problem>, kCapacity>;
  Instance<DescribedProblem> instance = make_instances<DescribedProblem>(kStages, kPathLaw)[0];
  Problem problem{instance.problem, instance.start[4]};
  std::unique_ptr<solver::Linearisation<Problem, kCapacity, Arch>> now =
      std::make_unique<solver::Linearisation<Problem, kCapacity, Arch>>();
  std::unique_ptr<Lq> lq = std::make_unique<Lq>();
  std::unique_ptr<solver::Barrier<Problem, kCapacity, Arch>> slacks =
      std::make_unique<solver::Barrier<Problem, kCapacity, Arch>>();
  solver::Iterate<7, 2, kCapacity> point;
  solver::SolveReport report;

  Passes() {
    solver::Trajectory<7, 2, kCapacity> trajectory;
    trajectory.horizon = kStages;
    trajectory.u = instance.guess.u;
    solver::roll_out(problem, Problem::without_cte(instance.start), trajectory);
    point.horizon = kStages;
    for (std::size_t k = 0; k <= kStages; ++k) {
      for (std::size_t i = 0; i < 7; ++i) point.x[i][k] = trajectory.x[k][i];
      for (std::size_t m = 0; m < 2; ++m) {
        point.u[m][k] = trajectory.u[k][m];
        now->lower[m][k] = problem.input_lower(0)[m];
        now->upper[m][k] = problem.input_upper(0)[m];
      }
    }
    linearise<1>();
    lq->backward(kStages, 0.0, true);
  }
  template <int Order>
  void linearise() {
    now->linearise<Order>(problem, point, false, 1e-13, *slacks, lq->lq, report);
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

/// Values, derivatives, adjoint, optimality and the stages of the quadratic program.
void LineariseFirstOrder(benchmark::State& state) {
  Passes p;
  per_stage(state, [&] { p.linearise<1>(); });
}
void LineariseSecondOrder(benchmark::State& state) {
  Passes p;
  per_stage(state, [&] { p.linearise<2>(); });
}
void BackwardSweep(benchmark::State& state) {
  Passes p;
  per_stage(state, [&] { benchmark::DoNotOptimize(p.lq->backward(Passes::kStages, 0.0, false)); });
}
void ForwardSweep(benchmark::State& state) {
  Passes p;
  per_stage(state,
            [&] { benchmark::DoNotOptimize(p.lq->forward(Passes::kStages, Passes::Lq::Repair::kLast)); });
}
BENCHMARK(LineariseFirstOrder);
BENCHMARK(LineariseSecondOrder);
BENCHMARK(BackwardSweep);
BENCHMARK(ForwardSweep);

}  // namespace
