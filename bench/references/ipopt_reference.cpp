// SPDX-License-Identifier: MIT
#include "references/ipopt_reference.hpp"

#include <IpSolveStatistics.hpp>
#include <algorithm>

#include "problems/ipopt_solver.hpp"
#include "references/described_nlp.hpp"
#include "references/ipopt_settings.hpp"

namespace chicane::bench {
namespace {

bool is_solved(Ipopt::ApplicationReturnStatus status) {
  return status == Ipopt::Solve_Succeeded || status == Ipopt::Solved_To_Acceptable_Level;
}

/// The described problem by hand.
class IpoptReference final : public Reference<DescribedProblem> {
 public:
  explicit IpoptReference(bool is_hot)
      : is_hot_{is_hot}, nlp_(new DescribedNlp), app_(make_ipopt(false)), hot_app_(make_ipopt(true)) {}

  [[nodiscard]] std::string_view name() const override { return is_hot_ ? "ipopt_hot" : "ipopt"; }
  [[nodiscard]] bool is_hot() const override { return is_hot_; }
  [[nodiscard]] Outcome solve(const Instance& now, const Instance* before, Trajectory& answer) override {
    if (is_hot_ && before != nullptr) {
      run(*app_, *before, answer);
      remember();
    }
    return run(is_hot_ && before != nullptr ? *hot_app_ : *app_, now, answer);
  }

 private:
  Outcome run(Ipopt::IpoptApplication& app, const Instance& instance, Trajectory& answer) {
    nlp_->pose(instance.problem, instance.start, instance.guess);
    nlp_->time_in_functions = 0.0;
    Outcome outcome;
    const double begin = cpu_time();
    const auto status = app.OptimizeTNLP(Ipopt::SmartPtr<Ipopt::TNLP>(Ipopt::GetRawPtr(nlp_)));
    outcome.time = cpu_time() - begin;
    outcome.time_in_functions = nlp_->time_in_functions;
    outcome.is_solved = is_solved(status);
    if (Ipopt::IsValid(app.Statistics())) outcome.iterations = app.Statistics()->IterationCount();
    answer = instance.guess;
    if (outcome.is_solved) nlp_->answer(answer);
    return outcome;
  }

  /// One stage earlier; the last one stays.
  static std::vector<double> shifted(const std::vector<double>& values, std::ptrdiff_t width) {
    std::vector<double> result = values;
    std::copy(values.begin() + width, values.end(), result.begin());
    return result;
  }
  void remember() {
    nlp_->low = shifted(nlp_->end_low, DescribedNlp::kNz);
    nlp_->high = shifted(nlp_->end_high, DescribedNlp::kNz);
    nlp_->equation = shifted(nlp_->end_equation, DescribedNlp::kNs);
  }

  bool is_hot_;
  Ipopt::SmartPtr<DescribedNlp> nlp_;
  Ipopt::SmartPtr<Ipopt::IpoptApplication> app_, hot_app_;
};

/// The corridor, with derivatives by dual numbers.
class CorridorReference final : public Reference<CorridorProblem> {
 public:
  [[nodiscard]] std::string_view name() const override { return "ipopt"; }
  [[nodiscard]] Outcome solve(const Instance& now, const Instance*, Trajectory& answer) override {
    answer = now.guess;
    const IpoptReport report = solver_.solve(now.problem, now.start, answer);
    return {report.is_solved, report.iterations, report.time, report.time_in_functions};
  }

 private:
  IpoptSolver<CorridorProblem> solver_;
};

}  // namespace

void add_ipopt(References& references) {
  references.described.push_back(std::make_unique<IpoptReference>(false));
  references.described.push_back(std::make_unique<IpoptReference>(true));
  references.corridor.push_back(std::make_unique<CorridorReference>());
  references.versions += (references.versions.empty() ? "Ipopt " : ", Ipopt ") + std::string(IPOPT_VERSION);
}

}  // namespace chicane::bench
