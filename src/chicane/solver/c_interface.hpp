// SPDX-License-Identifier: MIT
// Makes a C++ problem usable through the C interface (chicane/solver.h).
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <new>
#include <type_traits>

#include "chicane/base/deadline.hpp"
#include "chicane/solver.h"
#include "chicane/solver/c_functions.hpp"
#include "chicane/solver/ocp_solver.hpp"

namespace chicane::solver {

/// Solver of a problem for C (chicane/solver.h). A source file with
///
///     #include "chicane/solver/c_interface.hpp"
///     extern "C" const chicane_problem* cart_pole(void) {
///       return chicane::solver::c_problem<CartPole>();
///     }
///
/// gives programs in C the function cart_pole() and the functions of chicane/solver.h. The type of the
/// problem is default constructible, and has
///
///     static constexpr int kHorizon;
///     static constexpr const char* kName;         // for chicane_problem_name()
///     static constexpr int kParameters;           // optional: number of parameters
///     StageData<kHorizon + 1> p[…];               // optional: parameters first, then data of its own
///     std::array<double, kNu> lower[kHorizon];    // optional: as input_lower() returns them
///     std::array<double, kNu> upper[kHorizon];    // optional: as input_upper() returns them
///     static constexpr double kCostOffset;        // optional: added to costs
template <OcpProblem P>
class CSolver final : public chicane_solver {
 public:
  static constexpr int kHorizon = P::kHorizon;
  static constexpr std::size_t kNx = P::kNx, kNu = P::kNu, kNc = P::kNc;

  explicit CSolver(const chicane_problem* table) noexcept : chicane_solver{table, 0} {
    trajectory_.horizon = kHorizon;
  }

  static constexpr int parameter_count() noexcept {
    if constexpr (requires { P::kParameters; }) return P::kParameters;
    return 0;
  }
  /// Sizes of the problem for programs in C.
  static constexpr chicane_sizes sizes() noexcept {
    return {CHICANE_SOLVER_VERSION,
            P::kNx,
            P::kNu,
            kHorizon,
            parameter_count(),
            P::kNc,
            equality_count<P>(),
            terminal_equality_count<P>(),
            terminal_constraint_count<P>(),
            sizeof(CSolver) + alignof(CSolver)};  // the caller's memory may have any alignment
  }

  void set_options(const chicane_options& options) noexcept {
    solver_.set_options({.tolerance = options.tolerance,
                         .max_iterations = options.max_iterations,
                         .start_from_states = options.start_from_states != 0,
                         .second_order = options.second_order != 0});
    budget_s_ = options.budget_s;
  }

  /// Calls visit(number) for each entry of an array, in its order: by reference, or by value for arrays that
  /// only a solve writes.
  template <class Self, class Visit>
  static void for_each_entry(Self& self, chicane_array array, const Visit& visit) noexcept {
    const auto rows = [&](auto& of, std::size_t count) {
      for (std::size_t k = 0; k < count; ++k) {
        for (auto& value : of[k]) visit(value);
      }
    };
    const auto multipliers = [&](std::size_t count, const auto& multiplier) {
      for (int k = 0; k < kHorizon; ++k) {
        for (std::size_t n = 0; n < count; ++n) visit(multiplier(k, static_cast<int>(n)));
      }
    };
    constexpr auto kStages = static_cast<std::size_t>(kHorizon);
    const auto& solver = self.solver_;
    switch (array) {
      case CHICANE_PARAMETERS:
        if constexpr (parameter_count() > 0) {
          for (std::size_t k = 0; k <= kStages; ++k) {
            for (std::size_t n = 0; n < parameter_count(); ++n) visit(self.problem_.p[n].values[k]);
          }
        }
        break;
      case CHICANE_LOWER:
        if constexpr (kHasBounds) rows(self.problem_.lower, kStages);
        break;
      case CHICANE_UPPER:
        if constexpr (kHasBounds) rows(self.problem_.upper, kStages);
        break;
      case CHICANE_STATES:
        rows(self.trajectory_.x, kStages + 1);
        break;
      case CHICANE_INPUTS:
        rows(self.trajectory_.u, kStages);
        break;
      case CHICANE_DYNAMICS_MULTIPLIERS:
        multipliers(kNx, [&](int k, int i) { return solver.adjoint(k, i); });
        break;
      case CHICANE_BOUND_MULTIPLIERS:
        multipliers(kNu, [&](int k, int m) { return solver.bound_multiplier(k, m); });
        break;
      case CHICANE_CONSTRAINT_MULTIPLIERS:
        multipliers(kNc, [&](int k, int c) { return solver.constraint_multiplier(k, c); });
        break;
      case CHICANE_EQUALITY_MULTIPLIERS:
        if constexpr (HardProblem<P>)
          multipliers(equality_count<P>(), [&](int k, int n) { return solver.equality_multiplier(k, n); });
        break;
      case CHICANE_TERMINAL_MULTIPLIERS:
        if constexpr (HardProblem<P>) {
          for (int n = 0; n < terminal_equality_count<P>(); ++n)
            visit(solver.terminal_equality_multiplier(n));
          for (int n = 0; n < terminal_constraint_count<P>(); ++n)
            visit(solver.terminal_constraint_multiplier(n));
        }
        break;
    }
  }

  // As the functions of the same names in chicane/solver.h.
  /// Skips arrays that only a solve writes; chicane_set() has refused them.
  template <class T>
  void set(chicane_array array, const T* from) noexcept {
    for_each_entry(*this, array, [&](auto&& value) {
      if constexpr (std::is_lvalue_reference_v<decltype(value)>) value = static_cast<double>(*from++);
    });
  }
  template <class T>
  void get(chicane_array array, T* to) const noexcept {
    for_each_entry(*this, array, [&](double value) { *to++ = static_cast<T>(value); });
  }

  template <class T>
  void solve(const T* x0, chicane_report& report) noexcept {
    const Deadline watch = Deadline::stopwatch();
    const Deadline deadline =
        budget_s_ > 0.0
            ? Deadline::after(std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 * budget_s_)))
            : Deadline::never();
    const auto done = solver_.solve(problem_, state(x0), trajectory_, deadline);
    report = {.status = static_cast<int>(done.status),
              .is_usable = usable(done.status) ? 1 : 0,
              .iterations = done.iterations,
              .cost = done.cost + offset(),
              .stationarity = done.stationarity,
              .defect = done.defect,
              .complementarity = done.complementarity,
              .violation = done.violation,
              .violated_stage = done.worst_stage,
              .violated_constraint = done.worst_constraint,
              .miss = 0.0,
              .miss_kind = 0,
              .miss_stage = -1,
              .miss_row = -1,
              .seconds = 0.0,
              .gap = done.gap};
    if constexpr (HardProblem<P>) {
      report.miss = done.miss;
      report.miss_kind = static_cast<int>(done.kind);
      report.miss_stage = done.miss_stage;
      report.miss_row = done.miss_row;
    }
    report.seconds = watch.elapsed();
    is_ready = done.status != SolveStatus::kNotFinite ? 1 : 0;
    is_prepared = 0;
  }
  bool prepare() noexcept {
    if constexpr (HardProblem<P>) return solver_.prepare();
    if constexpr (!HardProblem<P>) return solver_.prepare(problem_);
  }
  template <class T>
  bool feedback(const T* x0) noexcept {
    return solver_.feedback(state(x0), trajectory_).is_solved;
  }
  /// Moves the guess one stage ahead. The last state and input stay, and so are there twice.
  void shift() noexcept {
    std::copy(trajectory_.x.begin() + 1, trajectory_.x.begin() + kHorizon + 1, trajectory_.x.begin());
    std::copy(trajectory_.u.begin() + 1, trajectory_.u.begin() + kHorizon, trajectory_.u.begin());
  }

 private:
  static constexpr bool kHasBounds = requires(P p) { p.lower[0][0] = p.upper[0][0]; };
  static constexpr double offset() noexcept {
    if constexpr (requires { P::kCostOffset; }) return P::kCostOffset;
    return 0.0;
  }
  template <class T>
  static std::array<double, kNx> state(const T* x0) noexcept {
    std::array<double, kNx> state;
    for (std::size_t i = 0; i < kNx; ++i) state[i] = static_cast<double>(x0[i]);
    return state;
  }

  P problem_;
  OcpSolver<P, kHorizon> solver_;
  Trajectory<P::kNx, P::kNu, kHorizon> trajectory_;  ///< guess, then answer
  double budget_s_ = 0.0;                            ///< time limit of a solve [s]; 0: none
};

namespace detail {
template <class P>
CSolver<P>* solver_of(chicane_solver* solver) noexcept {
  return static_cast<CSolver<P>*>(solver);
}
template <class P>
const CSolver<P>* solver_of(const chicane_solver* solver) noexcept {
  return static_cast<const CSolver<P>*>(solver);
}
using Handle = chicane_solver*;
template <class P>
inline constexpr chicane_problem kProblemForC{
    .sizes = CSolver<P>::sizes(),
    .name = P::kName,
    .alignment = alignof(CSolver<P>),
    .create = [](const chicane_problem* self, void* memory) -> Handle {
      return ::new (memory) CSolver<P>(self);
    },
    .destroy = [](Handle s) { solver_of<P>(s)->~CSolver<P>(); },
    .set_options = [](Handle s, const chicane_options* options) { solver_of<P>(s)->set_options(*options); },
    .set = [](Handle s, chicane_array array, const double* from) { solver_of<P>(s)->set(array, from); },
    .setf = [](Handle s, chicane_array array, const float* from) { solver_of<P>(s)->set(array, from); },
    .get = [](const chicane_solver* s, chicane_array array, double* to) { solver_of<P>(s)->get(array, to); },
    .getf = [](const chicane_solver* s, chicane_array array, float* to) { solver_of<P>(s)->get(array, to); },
    .solve = [](Handle s, const double* x0, chicane_report* r) { solver_of<P>(s)->solve(x0, *r); },
    .solvef = [](Handle s, const float* x0, chicane_report* r) { solver_of<P>(s)->solve(x0, *r); },
    .shift = [](Handle s) { solver_of<P>(s)->shift(); },
    .prepare = [](Handle s) { return solver_of<P>(s)->prepare(); },
    .feedback = [](Handle s, const double* x0) { return solver_of<P>(s)->feedback(x0); },
    .feedbackf = [](Handle s, const float* x0) { return solver_of<P>(s)->feedback(x0); }};
}  // namespace detail

/// Table of the functions by which programs in C use problem P.
template <OcpProblem P>
[[nodiscard]] const chicane_problem* c_problem() noexcept {
  return &detail::kProblemForC<P>;
}

}  // namespace chicane::solver
