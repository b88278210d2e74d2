// SPDX-License-Identifier: MIT
#include "problems/reference.hpp"
#include "references/fatrop_solver.hpp"
#include "references/hpipm_solver.hpp"

namespace chicane::bench {
namespace {

template <class Problem>
using StructuredForm = decltype(structured(std::declval<const Instance<Problem, kLongestHorizon>&>()));

template <class Problem, template <class, int> class Solver>
class PeerReference final : public Reference<Problem> {
 public:
  explicit PeerReference(std::string_view name) : name_{name} {}
  [[nodiscard]] std::string_view name() const override { return name_; }
  [[nodiscard]] Outcome solve(const typename Reference<Problem>::Instance& now,
                              const typename Reference<Problem>::Instance*,
                              typename Reference<Problem>::Trajectory& answer) override {
    const auto problem = structured(now);
    const auto start = StructuredDescribedProblem::without_cte(now.start);
    const auto t = std::make_unique<StructuredTrajectory>();
    t->horizon = now.guess.horizon;
    std::copy_n(now.guess.u.begin(), t->horizon, t->u.begin());
    solver::roll_out(problem, start, *t);
    const Outcome outcome = solver_->solve(problem, start, *t);
    answer = now.guess;
    std::copy_n(t->u.begin(), t->horizon, answer.u.begin());
    return outcome;
  }

 private:
  using PeerSolver = Solver<StructuredForm<Problem>, kLongestHorizon>;
  std::string_view name_;
  std::unique_ptr<PeerSolver> solver_ = std::make_unique<PeerSolver>();
};

template <class Problem>
void add(std::vector<std::unique_ptr<Reference<Problem>>>& references) {
  references.push_back(std::make_unique<PeerReference<Problem, HpipmSolver>>("hpipm"));
  references.push_back(std::make_unique<PeerReference<Problem, FatropSolver>>("fatrop"));
}

}  // namespace

void add_peers(References& references) {
  add(references.described);
  add(references.corridor);
  references.versions +=
      std::string(references.versions.empty() ? "" : ", ") + "fatrop and HPIPM with BLASFEO";
}

}  // namespace chicane::bench
