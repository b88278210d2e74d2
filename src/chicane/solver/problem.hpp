// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

#include "chicane/base/compiler.hpp"
#include "chicane/base/jet.hpp"
#include "chicane/base/pack.hpp"
#include "chicane/solver/detail/problem_check.hpp"

/// What a user of the solver writes and gets: the concept of an optimal control problem, soft penalties,
/// options and trajectories. The solver is in ocp_solver.hpp.

namespace chicane::solver {

/// Several consecutive stages at once, one in each lane of the pack V: stage `first` in lane 0. Functions of
/// a structured problem get one of these, or an int, as their stage `k`.
template <class V>
struct StageLanes {
  int first = 0;
};

/// Largest number of lanes of a pack.
inline constexpr std::size_t kMostLanes = 8;
/// Length of an array of `count` values that any pack may read to its end.
[[nodiscard]] constexpr std::size_t padded_stages(std::size_t count) noexcept {
  return (count + kMostLanes - 1) / kMostLanes * kMostLanes;
}

/// One number for each stage 0 … Capacity − 1, readable for one stage or for several in lanes.
template <std::size_t Capacity>
struct StageData {
  alignas(64) std::array<double, padded_stages(Capacity)> values{};

  [[nodiscard]] double& operator[](std::size_t k) noexcept { return values[k]; }
  [[nodiscard]] double at(int k) const noexcept { return values[static_cast<std::size_t>(k)]; }
  template <class V>
  [[nodiscard]] V at(StageLanes<V> k) const noexcept {
    return V::load(values.data() + k.first);
  }
};

/// The number of a stage as a value: k itself, or one in each lane.
[[nodiscard]] inline double stage_number(int k) noexcept { return k; }
template <class V>
[[nodiscard]] CHICANE_INLINE inline V stage_number(StageLanes<V> k) noexcept {
  alignas(64) static constexpr std::array<double, kMostLanes> kCount{0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0};
  return V::load(kCount.data()) + static_cast<double>(k.first);
}

/// A discrete-time optimal control problem is a type P with functions:
///
///     min Σ_{k<N} ½‖r_k(x_k, u_k)‖² + ½‖r_N(x_N)‖² + Σ soft penalty(c_k(x_k, u_k))
///     s.t. x_0 given, x_{k+1} = f_k(x_k, u_k), lower_k <= u_k <= upper_k
///
/// It has the sizes kNx, kNu, kNr (stage residuals), kNe (terminal residuals), kNc (soft constraints c <= 0;
/// may be 0; the constraint of stage k is on (x_k, u_k), k < N), the functions of one of the two levels
/// below, and
///
///     std::array<double, kNu> input_lower(int k) const;    // may be -infinity
///     std::array<double, kNu> input_upper(int k) const;
///     SoftPenalty soft_penalty(int constraint) const;      // only when kNc > 0
///     std::string_view constraint_name(int constraint) const;  // optional
///     std::string_view constraint_unit(int constraint) const;  // optional
///
/// Costs on input changes: make the previous input part of the state. Bounds on input changes: make the
/// change the input, and the input a state, which soft constraints keep inside its bounds.
///
/// **For budgets of a few iterations**, a type may say `static constexpr bool kRealTime = true`: the filter
/// method, which solves from poor guesses in tens of iterations, is left out, and is not compiled.
///
/// **Level 1, any model.** One scalar type for everything, branches allowed; derivatives are dense:
///
///     template <class T> std::array<T, kNx> dynamics(int k, const std::array<T, kNx>& x,
///                                                    const std::array<T, kNu>& u) const;
///     …and the same for std::array<T, kNr> residual(k, x, u), std::array<T, kNe> terminal_residual(x) and
///     std::array<T, kNc> constraint(k, x, u).
///
/// With `template <class K, class T> … dynamics(K k, …)` instead of `int k` for all of them, and without
/// branches on x and u, several stages are evaluated at once.
///
/// **Level 2, structured.** Every variable has a type of its own, which knows what it depends on (jet.hpp):
/// derivatives that are zero by construction cost nothing, here or in the Riccati sweeps. Stages are
/// evaluated in SIMD lanes.
///
///     template <class K, class X, class U> auto dynamics(K k, const X& x, const U& u) const {
///       const auto& [position, speed] = x;          // works on arrays and on tuples
///       const auto& [force] = u;
///       return std::make_tuple(position + speed * dt, speed + force * (dt / mass.at(k)));
///     }
///
/// and so on for residual(k, x, u), terminal_residual(x), constraint(k, x, u). Rules:
///
/// - `auto` for every intermediate; results by std::make_tuple (or std::array where all types are equal);
/// - data that differ from stage to stage: a StageData member and `.at(k)`; `stage_number(k)` is k as a
/// number;
/// - no branches on values: select(a > b, x, y), max, min, positive_part, abs instead; compile-time ones are
/// fine. All functions of jet.hpp are found by their arguments; what variables cannot
/// do is refused in few lines (symbol.hpp);
/// - model code over one type T (`struct Motion<T>`) runs on T = Common<A, B, …> of the variables it uses;
/// - quantities that follow from x_k and u_k are outputs, not states: put them into residual();
/// - next_state() and roll_out() call them with numbers;
/// - they are called from several places: without CHICANE_INLINE on them and on what they call, jets
/// may go through memory.
///
/// **Constraints that must hold exactly**, equalities and terminal ones among them: hard_constraints.hpp.
///
/// A stage may have at most 24 variables (states and inputs); about 60 where the functions are over arrays,
/// as in level 1 with `class K`, and `static constexpr bool kGaussNewton = true`. All functions are called on
/// the thread that calls solve(), during the call, in any order; a problem that several threads solve at once
/// is only read.

namespace detail {

template <class V, int Order, int Begin, int... n>
auto make_seeds(std::integer_sequence<int, n...>)
    -> std::tuple<Jet<V, Order, variable(Begin + n), variable(Begin + n)>...>;
template <class V, int Order, int Begin, int Count>
using Seeds = decltype(make_seeds<V, Order, Begin>(std::make_integer_sequence<int, Count>{}));

}  // namespace detail

/// States and inputs of a stage as jets, each of its own type: arguments of a structured problem's functions.
template <class P, class V, int Order>
using StateJets = detail::Seeds<V, Order, 0, P::kNx>;
template <class P, class V, int Order>
using InputJets = detail::Seeds<V, Order, P::kNx, P::kNu>;

/// A row of results (tuple or array, constants among them) as an array of one type.
template <class T, class Row>
[[nodiscard]] constexpr auto to_array(const Row& row) {
  return std::apply([](const auto&... values) { return std::array<T, sizeof...(values)>{T(values)...}; },
                    row);
}
/// A number with the functions of jets, without derivatives.
using Plain = Jet<double, 1, 0>;

/// Concept of a problem; detail/problem_check.hpp checks it with messages that name the remedy.
template <class P>
concept OcpProblem = detail::is_problem<P>();

/// Concept of a problem of level 2.
template <class P>
concept StructuredProblem = OcpProblem<P> && detail::TakesSymbols<P>;

/// Number of a problem's kNc soft constraints in use: all, unless it has a function constraint_count().
template <class P>
[[nodiscard]] constexpr std::size_t constraint_count(const P& problem) noexcept {
  if constexpr (requires { problem.constraint_count(); }) return problem.constraint_count();
  return static_cast<std::size_t>(P::kNc);
}

/// x_{k+1} for numbers (or any one scalar type), for problems of both levels.
template <class T, OcpProblem P>
[[nodiscard]] std::array<T, P::kNx> next_state(const P& problem, int k, const std::array<T, P::kNx>& x,
                                               const std::array<T, P::kNu>& u) {
  if constexpr (std::is_same_v<T, double>) {  // scalar of models' own functions
    using One = std::conditional_t<StructuredProblem<P>, Pack<arch::Baseline, 2>, Plain>;
    const auto next = to_array<One>(problem.dynamics(k, to_array<One>(x), to_array<One>(u)));
    return std::apply([](const auto&... value) { return std::array<double, P::kNx>{value_of(value)...}; },
                      next);
  } else {
    return to_array<T>(problem.dynamics(k, x, u));
  }
}

/// Penalty of violating a soft constraint c <= 0 by s > 0: linear · s + ½ quadratic · s².
struct SoftPenalty {
  double linear = 500.0;     ///< cost over violation
  double quadratic = 200.0;  ///< cost over half of the squared violation
  double cap = 1e30;         ///< violation of a converged solution above which it is reported as kInfeasible
};

/// States x_0..x_N and inputs u_0..u_{N-1} of a horizon of N <= Capacity intervals.
template <int Nx, int Nu, int Capacity>
struct Trajectory {
  using State = std::array<double, Nx>;
  using Input = std::array<double, Nu>;

  int horizon = 0;                      ///< N
  std::array<State, Capacity + 1> x{};  ///< x[0..N]
  std::array<Input, Capacity> u{};      ///< u[0..N-1]
};

/// Options of the solver. Defaults suit control at 10–100 Hz.
struct SolverOptions {
  double tolerance = 1e-6;        ///< stationarity accepted as optimal; (0, 1e-2]. Largest violation of hard
                                  ///< constraints in a usable answer
  double loose_tolerance = 1e-2;  ///< stationarity accepted when the budget is spent; [tolerance, 1e3]
  int max_iterations = 1000;  ///< limit of SQP iterations, with the share of a shorter horizon; worst-case
                              ///< time is proportional to it; [1, 10000]. Controllers set less
  /// Permits the filter method after failing full steps, or for kRealTime a growing horizon. Both reach
  /// optima from poor guesses, at the cost of tens of iterations; switch it off for budgets of a few
  /// iterations.
  bool may_start_short = true;
  /// Starts from the states of the warm start if they are finite; the first steps close their gaps. For
  /// unstable systems, whose simulated guess would diverge.
  bool start_from_states = false;
  bool second_order = true;  ///< exact Hessians near the solution: fewer iterations, costlier iterations
};

}  // namespace chicane::solver
