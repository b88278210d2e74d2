// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <limits>

#include "problems/cpu_time.hpp"
#include "problems/reference.hpp"
#include "problems/structured_solver.hpp"

namespace chicane::bench {

/// Our own solver on the described problem as any model is written: one scalar type, dense derivatives.
class DenseReference final : public Reference<DescribedProblem> {
 public:
  [[nodiscard]] std::string_view name() const override { return "dense"; }

  [[nodiscard]] Outcome solve(const Instance& now, const Instance*, Trajectory& answer) override {
    constexpr int kRepeats = 12;  // as many as of the structured form
    Outcome outcome;
    const double begin = cpu_time();
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
      answer.horizon = now.guess.horizon;
      std::copy_n(now.guess.u.begin(), now.guess.horizon, answer.u.begin());
      const solver::SolveReport report = with_instructions(chosen_instruction_set(), [&](auto arch) {
        return solve_dense<decltype(arch)>(now.problem, now.start, answer);
      });
      outcome.is_solved = report.status == solver::SolveStatus::kOptimal;
      outcome.iterations = report.iterations;
    }
    outcome.time = (cpu_time() - begin) / kRepeats;
    return outcome;
  }
};

}  // namespace chicane::bench
