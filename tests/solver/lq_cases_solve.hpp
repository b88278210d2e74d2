// SPDX-License-Identifier: MIT
#pragma once

#include <cstring>
#include <memory>

#include "chicane/solver/detail/lq_solver.hpp"
#include "solver/lq_cases.hpp"

/// How lq_cases.cpp and lq_cases_dense.cpp solve: what they instantiate differs, and how they are compiled.
namespace chicane::test {

template <class Arch, class Pattern>
void load(const LqData& data, solver::LqProblem<Pattern, LqData::kMostStages>& lq) noexcept {
  using Layout = solver::Layout<Pattern>;
  using Stages = Pack<Arch, 8>;
  // Eight stages at once, as the linearisation does it.
  for (std::size_t k = 0; k < data.horizon; k += 8) {
    std::array<Stages, Layout::kFCount> f;
    std::array<Stages, Layout::kLCount> l;
    for (std::size_t lane = 0; lane < 8; ++lane) {
      const std::size_t stage = k + lane < data.horizon ? k + lane : data.horizon - 1;
      for (std::size_t i = 0; i < Layout::kNz; ++i) {
        for (std::size_t j = 0; j < Layout::kNz; ++j) {
          if (i < Layout::kNx && Layout::kF[i][j] != Layout::kNone)
            f[Layout::kF[i][j]].set(lane, data.F[stage][i][j]);
          if (Layout::kL[i][j] != Layout::kNone) l[Layout::kL[i][j]].set(lane, data.L[stage][i][j]);
        }
      }
    }
    lq.template set<Arch>(k, f, l);
  }
  for (std::size_t k = 0; k < data.horizon; ++k) {
    for (std::size_t m = 0; m < Layout::kNu; ++m) {
      lq.low[m][k] = data.low[k][m];
      lq.high[m][k] = data.high[k][m];
    }
  }
  for (std::size_t i = 0; i <= Layout::kNx; ++i) {
    for (std::size_t j = 0; j < Layout::kNx; ++j) lq.terminal[i][j] = data.terminal[i][j];
  }
}

template <class Arch, class Pattern>
void solve_lq(const LqData& data, LqAnswer& answer) noexcept {
  using Solver = solver::LqSolver<Arch, Pattern, LqData::kMostStages>;
  constexpr std::size_t kNx = Pattern::kNx;
  constexpr std::size_t kNu = Pattern::kNu;
  const auto qp = std::make_unique<Solver>();
  const auto check = std::make_unique<Solver>();
  load<Arch>(data, qp->lq);
  load<Arch>(data, check->lq);
  answer.shift = qp->backward(data.horizon);
  int fewest = 1000;
  int chances = 3;
  for (answer.sweeps = 1; answer.sweeps < 100; ++answer.sweeps) {
    const int contradictions =
        qp->forward(data.horizon, chances > 0 ? Solver::Repair::kAll : Solver::Repair::kLast);
    if (contradictions == 0) break;
    chances = contradictions < fewest ? 3 : chances - 1;
    fewest = contradictions < fewest ? contradictions : fewest;
    qp->backward_again();
    std::memcpy(check->hold, qp->hold, sizeof qp->hold);
    check->backward(data.horizon);
    answer.again_is_same =
        answer.again_is_same && std::memcmp(check->feedback, qp->feedback, sizeof qp->feedback) == 0;
  }
  for (std::size_t k = 0; k < data.horizon; ++k) {
    for (std::size_t i = 0; i < kNx; ++i) answer.dx[k + 1][i] = qp->dx[k + 1][i];
    for (std::size_t m = 0; m < kNu; ++m) answer.du[k][m] = qp->du[k][m];
  }
}

}  // namespace chicane::test
