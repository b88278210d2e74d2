// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <memory>

#include "chicane/solver/ocp_solver.hpp"
#include "traced/interpreted_problem.hpp"

namespace chicane::python {

/// Solves interpreted problems of one size class: with the plain solver where nothing must hold, else with
/// the augmented Lagrangian around the same code.
template <class Arch, SizeClass Sizes>
class SolverOfSize final : public TracedSolver {
 public:
  SolverOfSize(const TracedProblem& problem, const Workspace& workspace) {
    problem_.problem = &problem;
    problem_.workspace = &workspace;
    for (const Function f : {Function::kEquality, Function::kTerminalEquality, Function::kTerminalConstraint})
      has_equalities_ = has_equalities_ || problem.rows(f) > 0;
    augmented_.problem = &problem_;
    augmented_.penalty_factor.fill(1.0);
  }

  void solve(const TracedCall& call, TracedAnswer& answer) noexcept override {
    problem_.call = call;
    load(answer);
    const std::array<double, Sizes.nx> x0 = state(call.x0);
    is_hard_ = has_equalities_ || has_hard();
    if (is_hard_) {
      if (hard_ == nullptr) hard_ = std::make_unique<Hard>(call.options);
      hard_->set_options(call.options);
      hard_->record_iterations(call.log);
      multipliers_.is_known = multipliers_.is_known && call.goes_on;
      answer.report = hard_->solve(problem_, x0, trajectory_, multipliers_, call.deadline);
      store_multipliers(*hard_, answer);
      store_hard(answer);
    } else {
      if (soft_ == nullptr) soft_ = std::make_unique<Soft>(call.options);
      soft_->set_options(call.options);
      soft_->record_iterations(call.log);
      answer.report = {};
      static_cast<solver::SolveReport&>(answer.report) =
          soft_->solve(augmented_, x0, trajectory_, call.deadline);
      store_multipliers(*soft_, answer);
    }
    store(answer);
  }

  bool prepare() noexcept override { return is_hard_ ? hard_->prepare() : soft_->prepare(augmented_); }
  bool feedback(const double* x0, TracedAnswer& answer) noexcept override {
    const auto done =
        is_hard_ ? hard_->feedback(state(x0), trajectory_) : soft_->feedback(state(x0), trajectory_);
    store(answer);
    return done.is_solved;
  }

 private:
  using Problem = InterpretedProblem<Arch, Sizes>;
  using Augmented = solver::Augmented<Problem, kMostStages>;
  using Soft = solver::OcpSolver<Augmented, kMostStages, Arch>;
  using Hard = solver::OcpSolver<Problem, kMostStages, Arch>;

  [[nodiscard]] std::array<double, Sizes.nx> state(const double* from) const noexcept {
    std::array<double, Sizes.nx> state{};
    std::copy(from, from + problem_.problem->nx, state.begin());
    return state;
  }
  [[nodiscard]] bool has_hard() const noexcept {
    for (std::size_t c = 0; c < problem_.constraint_count(); ++c) {
      if (problem_.call.is_hard[c]) return true;
    }
    return false;
  }
  void load(const TracedAnswer& guess) noexcept {
    const auto nx = static_cast<std::size_t>(problem_.problem->nx);
    const auto nu = static_cast<std::size_t>(problem_.problem->nu);
    trajectory_.horizon = problem_.call.horizon;
    for (std::size_t k = 0; k <= static_cast<std::size_t>(trajectory_.horizon); ++k) {
      trajectory_.x[k].fill(0.0);
      std::copy_n(guess.x.data() + k * nx, nx, trajectory_.x[k].begin());
      if (k == static_cast<std::size_t>(trajectory_.horizon)) break;
      trajectory_.u[k].fill(0.0);
      std::copy_n(guess.u.data() + k * nu, nu, trajectory_.u[k].begin());
    }
  }
  void store(TracedAnswer& answer) const noexcept {
    const auto nx = static_cast<std::size_t>(problem_.problem->nx);
    const auto nu = static_cast<std::size_t>(problem_.problem->nu);
    for (std::size_t k = 0; k <= static_cast<std::size_t>(trajectory_.horizon); ++k) {
      std::copy_n(trajectory_.x[k].begin(), nx, answer.x.data() + k * nx);
      if (k < static_cast<std::size_t>(trajectory_.horizon))
        std::copy_n(trajectory_.u[k].begin(), nu, answer.u.data() + k * nu);
    }
  }
  template <class Solver>
  void store_multipliers(const Solver& from, TracedAnswer& answer) const noexcept {
    double* adjoint = answer.adjoint.data();
    double* bound = answer.bound.data();
    double* constraint = answer.constraint.data();
    const int constraints = static_cast<int>(problem_.constraint_count());
    for (int k = 0; k < trajectory_.horizon; ++k) {
      for (int i = 0; i < problem_.problem->nx; ++i) *adjoint++ = from.adjoint(k, i);
      for (int m = 0; m < problem_.problem->nu; ++m) *bound++ = from.bound_multiplier(k, m);
      for (int c = 0; c < constraints; ++c) *constraint++ = from.constraint_multiplier(k, c);
    }
  }
  void store_hard(TracedAnswer& answer) const noexcept {
    const int equalities = problem_.problem->rows(Function::kEquality);
    double* to = answer.equality.data();
    for (int k = 0; k < trajectory_.horizon; ++k) {
      for (int n = 0; n < equalities; ++n) *to++ = hard_->equality_multiplier(k, n);
    }
    for (std::size_t n = 0; n < answer.terminal_equality.size(); ++n)
      answer.terminal_equality[n] = hard_->terminal_equality_multiplier(static_cast<int>(n));
    for (std::size_t n = 0; n < answer.terminal_constraint.size(); ++n)
      answer.terminal_constraint[n] = hard_->terminal_constraint_multiplier(static_cast<int>(n));
  }

  Problem problem_;
  Augmented augmented_;
  bool has_equalities_ = false;
  bool is_hard_ = false;  ///< the last solve was with what must hold
  std::unique_ptr<Soft> soft_;
  std::unique_ptr<Hard> hard_;
  solver::HardMultipliers<Problem, kMostStages> multipliers_;
  solver::Trajectory<Sizes.nx, Sizes.nu, kMostStages> trajectory_;
};

template <class Arch, SizeClass Sizes>
std::unique_ptr<TracedSolver> make_sized_solver(const TracedProblem& problem, const Workspace& workspace) {
  return std::make_unique<SolverOfSize<Arch, Sizes>>(problem, workspace);
}

}  // namespace chicane::python
