// SPDX-License-Identifier: MIT
#include "stack/cppad_solver.hpp"

#include <algorithm>

#include "references/cppad_nlp.hpp"

namespace chicane::bench {
namespace {

using controller::CubicProblem;
using controller::CubicTrajectory;

DescribedTerms terms_of(const CubicProblem& problem, const CubicProblem::State& begin) {
  DescribedTerms terms{.dt = problem.dt,
                       .turn_per_metre = problem.turn_per_metre,
                       .speed_reference = problem.speed_reference,
                       .error_sign = problem.error_sign,
                       .heading_reach = problem.heading_reach,
                       .is_lateral_recursive = problem.is_lateral_recursive,
                       .line = problem.line.c,
                       .acts_late = problem.acts_late,
                       .last = {begin[5], begin[6]}};
  // The residuals of CubicProblem carry √(2 weight).
  for (std::size_t i = 0; i < terms.weights.size(); ++i)
    terms.weights[i] = 0.5 * problem.root[i] * problem.root[i];
  return terms;
}

class CppadSolver final : public controller::CubicSolver {
 public:
  /// From zeros, as the template does.
  solver::SolveReport solve(const CubicProblem& problem, const CubicProblem::State& begin,
                            CubicTrajectory& answer, Deadline /*deadline*/) noexcept override {
    const CppadLayout at{static_cast<std::size_t>(answer.horizon) + 1};
    CppadVector start(at.size());
    for (std::size_t i = 0; i < at.size(); ++i) start[i] = 0.0;
    const double first[6] = {begin[0], begin[1], begin[2], begin[3], problem.first_lateral_error, begin[4]};
    for (std::size_t i = 0; i < 6; ++i) start[at.state(i, 0)] = first[i];
    const CppadSolution solution = solve_with_cppad(terms_of(problem, begin), at, start, problem.steer_limit,
                                                    "Numeric max_cpu_time 10\n");
    solver::SolveReport report;
    report.status = is_solved(solution) ? solver::SolveStatus::kOptimal : solver::SolveStatus::kStalled;
    if (!is_solved(solution)) return report;
    report.cost = solution.obj_value;
    read(solution, at, begin, answer);
    return report;
  }
  [[nodiscard]] std::unique_ptr<controller::CubicSolver> copy() const override { return make_cppad_solver(); }

 private:
  static void read(const CppadSolution& solution, const CppadLayout& at, const CubicProblem::State& begin,
                   CubicTrajectory& answer) {
    for (std::size_t k = 0; k < at.nodes; ++k) {
      auto& x = answer.x[k];
      for (std::size_t i = 0; i < 4; ++i) x[i] = solution.x[at.state(i, k)];
      x[4] = solution.x[at.state(5, k)];
      x[5] = k == 0 ? begin[5] : answer.u[k - 1][0];
      x[6] = k == 0 ? begin[6] : answer.u[k - 1][1];
      if (k + 1 == at.nodes) break;
      // Ipopt relaxes bounds by 1e-8.
      answer.u[k] = {solution.x[at.steer(k)], std::clamp(solution.x[at.throttle(k)], -1.0, 1.0)};
    }
  }
};

}  // namespace

std::unique_ptr<controller::CubicSolver> make_cppad_solver() { return std::make_unique<CppadSolver>(); }

}  // namespace chicane::bench
