// SPDX-License-Identifier: MIT
#include "problems/ipopt_problem.hpp"
#include "problems/reference.hpp"

namespace chicane::bench {
namespace {

template <class Problem>
class IpoptReference final : public Reference<Problem> {
 public:
  using typename Reference<Problem>::Instance;
  using typename Reference<Problem>::Trajectory;

  explicit IpoptReference(bool is_hot) : is_hot_{is_hot} {}

  [[nodiscard]] std::string_view name() const override { return is_hot_ ? "ipopt_hot" : "ipopt"; }
  [[nodiscard]] bool is_hot() const override { return is_hot_; }
  [[nodiscard]] Outcome solve(const Instance& now, const Instance* before, Trajectory& answer) override {
    const bool is_hot = is_hot_ && before != nullptr;
    if (is_hot) {
      answer = before->guess;
      solver_.solve(before->problem, before->start, answer);
      solver_.remember();
    }
    answer = now.guess;
    return is_hot ? solver_.solve_warm(now.problem, now.start, answer)
                  : solver_.solve(now.problem, now.start, answer);
  }

 private:
  bool is_hot_;
  IpoptSolver<Problem, kLongestHorizon> solver_;
};

}  // namespace

void add_ipopt(References& references) {
  references.described.push_back(std::make_unique<IpoptReference<DescribedProblem>>(false));
  references.described.push_back(std::make_unique<IpoptReference<DescribedProblem>>(true));
  references.corridor.push_back(std::make_unique<IpoptReference<CorridorProblem>>(false));
  references.versions += (references.versions.empty() ? "Ipopt " : ", Ipopt ") + std::string(IPOPT_VERSION);
}

}  // namespace chicane::bench
