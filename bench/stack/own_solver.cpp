// SPDX-License-Identifier: MIT
#include "chicane/base/instruction_set.hpp"
#include "problems/cpu_time.hpp"
#include "stack/cppad_solver.hpp"

namespace chicane::bench {
namespace {

class OwnSolver final : public controller::CubicSolver, public SolveClock {
 public:
  [[nodiscard]] double last() const noexcept override { return last_; }

  solver::SolveReport solve(const controller::CubicProblem& problem,
                            const controller::CubicProblem::State& start, controller::CubicTrajectory& answer,
                            Deadline deadline) noexcept override {
    const double started = cpu_time();
    const solver::SolveReport report = solver_->solve(problem, start, answer, deadline);
    last_ = cpu_time() - started;
    return report;
  }

 private:
  std::unique_ptr<controller::CubicSolver> solver_ = controller::make_cubic_solver();
  double last_ = 0.0;
};

}  // namespace

TimedSolver make_own_solver() {
  auto solver = std::make_unique<OwnSolver>();
  const SolveClock* clock = solver.get();
  return {std::move(solver), clock};
}

}  // namespace chicane::bench
