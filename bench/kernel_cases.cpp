// SPDX-License-Identifier: MIT
#include "kernel_cases.hpp"

#include <array>
#include <memory>

#include "chicane/base/random.hpp"
#include "chicane/solver/detail/linearisation.hpp"
#include "chicane/solver/detail/lq_solver.hpp"
#include "chicane/solver/detail/roll_out.hpp"
#include "chicane/solver/detail/stage_entries.hpp"
#include "problems/described_problem.hpp"

namespace chicane::bench {
namespace {

constexpr int kCapacity = 200;

template <class Arch, class Pattern>
struct Passes {
  using Solver = solver::LqSolver<Arch, Pattern, kCapacity>;
  using Layout = solver::Layout<Pattern>;
  Solver qp;

  Passes() noexcept {
    Random random{1};
    for (std::size_t k = 0; k < kKernelStages; ++k) {
      for (std::size_t i = 0; i < Layout::kNz; ++i) {
        for (std::size_t j = 0; j < Layout::kNz; ++j) {
          const double noise = random.uniform(-0.1, 0.1);
          if (i < Layout::kNx && Layout::kF[i][j] != Layout::kNone)
            qp.lq.set_jacobian(k, i, j, noise + (i == j ? 0.9 : 0.0));
          if (j <= i && Layout::kL[i][j] != Layout::kNone)
            qp.lq.set_cost(k, i, j, noise + (i == j ? 2.0 : 0.0));
        }
      }
      for (std::size_t m = 0; m < Layout::kNu; ++m) {
        qp.lq.low[m][k] = -10.0;
        qp.lq.high[m][k] = 10.0;
      }
    }
    for (std::size_t i = 0; i < Layout::kNx; ++i) qp.lq.terminal[i][i] = 1.0;
    qp.backward(kKernelStages);
  }
};

template <class Arch, class Pattern, bool IsBackward>
void sweep() noexcept {
  static Passes<Arch, Pattern> passes;
  if constexpr (IsBackward) {
    passes.qp.backward(kKernelStages);
  } else {
    passes.qp.forward(kKernelStages, Passes<Arch, Pattern>::Solver::Repair::kLast);
  }
}

/// Parts of an iteration.
enum class Part { kRollOut, kFirstOrder, kSecondOrder, kSetStages };

template <class Arch>
struct Parts {
  using Problem = StructuredDescribedProblem;
  using Linearisation = solver::Linearisation<Problem, kCapacity, Arch>;
  using Layout = typename Linearisation::Layout;
  using Stages = solver::Stages<Arch>;
  Problem problem;
  typename Linearisation::Point point;
  Linearisation now;
  typename Linearisation::Slacks slacks;
  typename Linearisation::Lq lq;
  std::array<Stages, Layout::kFCount> f;
  std::array<Stages, Layout::kLCount> l;
  solver::SolveReport report;

  Parts() noexcept {
    Random random{1};
    const DescribedInstance instance = random_instance(random, kKernelStages);
    problem = Problem{instance.problem, instance.start[4]};
    point.horizon = kKernelStages;
    const auto start = Problem::without_cte(instance.start);
    for (std::size_t i = 0; i < start.size(); ++i) point.x[i][0] = start[i];
    for (std::size_t k = 0; k < kKernelStages; ++k) {
      for (std::size_t m = 0; m < 2; ++m) {
        point.u[m][k] = random.uniform(-0.1, 0.1);
        now.lower[m][k] = problem.input_lower(0)[m];
        now.upper[m][k] = problem.input_upper(0)[m];
      }
    }
    f.fill(Stages(0.5));
    l.fill(Stages(0.5));
    run(Part::kRollOut);
  }
  void run(Part part) noexcept {
    if (part == Part::kRollOut) solver::RollOut<Problem, Arch>::run(problem, point);
    if (part == Part::kFirstOrder)
      now.template linearise<1>(problem, point, false, 1e-13, slacks, lq, report);
    if (part == Part::kSecondOrder)
      now.template linearise<2>(problem, point, false, 1e-13, slacks, lq, report);
    if (part == Part::kSetStages) {
      for (std::size_t k = 0; k < kKernelStages; k += 8) lq.set(k, f, l);
    }
  }
};

template <class Arch, Part part>
void run_part() noexcept {
  static Parts<Arch> parts;
  parts.run(part);
}

}  // namespace

template <class Arch>
std::span<const KernelCase> kernel_cases() noexcept {
  static constexpr KernelCase kCases[] = {
      {"Backward/described", &sweep<Arch, solver::ProblemPattern<StructuredDescribedProblem>, true>},
      {"Forward/described", &sweep<Arch, solver::ProblemPattern<StructuredDescribedProblem>, false>},
      {"Backward/full4", &sweep<Arch, solver::FullPattern<4, 2>, true>},
      {"Forward/full4", &sweep<Arch, solver::FullPattern<4, 2>, false>},
      {"Backward/full6", &sweep<Arch, solver::FullPattern<6, 2>, true>},
      {"Forward/full6", &sweep<Arch, solver::FullPattern<6, 2>, false>},
      {"Backward/full8", &sweep<Arch, solver::FullPattern<8, 2>, true>},
      {"Forward/full8", &sweep<Arch, solver::FullPattern<8, 2>, false>},
      {"Backward/full10", &sweep<Arch, solver::FullPattern<10, 2>, true>},
      {"Forward/full10", &sweep<Arch, solver::FullPattern<10, 2>, false>},
      {"Backward/full12", &sweep<Arch, solver::FullPattern<12, 2>, true>},
      {"Forward/full12", &sweep<Arch, solver::FullPattern<12, 2>, false>},
      {"RollOut/described", &run_part<Arch, Part::kRollOut>},
      {"LineariseFirstOrder/described", &run_part<Arch, Part::kFirstOrder>},
      {"LineariseSecondOrder/described", &run_part<Arch, Part::kSecondOrder>},
      {"SetStages/described", &run_part<Arch, Part::kSetStages>},
  };
  return kCases;
}

template std::span<const KernelCase> kernel_cases<arch::Native>() noexcept;

}  // namespace chicane::bench
