// SPDX-License-Identifier: MIT
#include "references/cppad_reference.hpp"

#include "problems/cpu_time.hpp"
#include "references/cppad_nlp.hpp"

namespace chicane::bench {
namespace {

DescribedTerms terms_of(const DescribedProblem& problem) {
  DescribedTerms terms{.dt = DescribedProblem::kStep,
                       .turn_per_metre = 1.0 / DescribedProblem::kLength,
                       .speed_reference = problem.speed_reference,
                       .weights = {200.0, 200.0, 0.1, 1.0, 1.0, 10.0, 1.0, 0.0}};
  for (std::size_t i = 0; i < terms.line.size(); ++i) terms.line[i] = problem.path[i];
  return terms;
}

class CppadReference final : public Reference<DescribedProblem> {
 public:
  [[nodiscard]] std::string_view name() const override { return "cppad"; }
  [[nodiscard]] Outcome solve(const Instance& now, const Instance*, Trajectory& answer) override {
    const auto horizon = static_cast<std::size_t>(now.guess.horizon);
    const CppadLayout at{horizon + 1};
    CppadVector start(at.size());
    for (std::size_t k = 0; k <= horizon; ++k) {
      const auto& x = k == 0 ? now.start : now.guess.x[k];
      for (std::size_t i = 0; i < 6; ++i) start[at.state(i, k)] = x[i];
      if (k == horizon) break;
      start[at.steer(k)] = now.guess.u[k][0];
      start[at.throttle(k)] = now.guess.u[k][1];
    }
    const DescribedTerms terms = terms_of(now.problem);
    const double steer_limit = now.problem.input_upper(0)[0];
    Outcome outcome;
    const double begin = cpu_time();
    const CppadSolution solution = solve_with_cppad(
        terms, at, start, steer_limit,
        "Numeric max_cpu_time 10\nNumeric tol          1e-6\nNumeric bound_relax_factor 0\n");
    outcome.time = cpu_time() - begin;
    outcome.is_solved = is_solved(solution);
    answer = now.guess;
    for (std::size_t k = 0; outcome.is_solved && k < horizon; ++k)
      answer.u[k] = {solution.x[at.steer(k)], solution.x[at.throttle(k)]};
    return outcome;
  }
};

}  // namespace

void add_cppad(References& references) {
  references.described.push_back(std::make_unique<CppadReference>());
  references.versions +=
      std::string(references.versions.empty() ? "" : ", ") + "CppAD of r-cran-tmb (" CPPAD_PACKAGE_STRING ")";
}

}  // namespace chicane::bench
