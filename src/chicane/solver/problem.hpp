// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <concepts>

namespace chicane::solver {

/// A discrete-time optimal control problem, given as a type P with functions over any scalar T (double, or a
/// Dual):
///
///     min Σ_{k<N} ½‖r_k(x_k, u_k)‖² + ½‖r_N(x_N)‖² + Σ soft penalty(c_k(x_k, u_k))
///     s.t. x_0 given, x_{k+1} = f_k(x_k, u_k), lower_k <= u_k <= upper_k
///
/// P has the sizes kNx, kNu, kNr (stage residuals), kNe (terminal residuals), kNc (soft constraints c <= 0;
/// may be 0; the constraint of stage k is on (x_k, u_k), k < N) and
///
///     template <class T> std::array<T, kNx> dynamics(int k, const std::array<T, kNx>& x, const std::array<T,
///     kNu>& u) const; template <class T> std::array<T, kNr> residual(int k, const std::array<T, kNx>& x,
///     const std::array<T, kNu>& u) const; template <class T> std::array<T, kNe> terminal_residual(const
///     std::array<T, kNx>& x) const; template <class T> std::array<T, kNc> constraint(int k, const
///     std::array<T, kNx>& x, const std::array<T, kNu>& u) const; std::array<double, kNu> input_lower(int k)
///     const;   // may be -infinity std::array<double, kNu> input_upper(int k) const; SoftPenalty
///     soft_penalty(int constraint) const;     // only when kNc > 0
///
/// Costs on input changes: make the previous input part of the state.
template <class P>
concept OcpProblem = requires(const P& p, const std::array<double, P::kNx>& x,
                              const std::array<double, P::kNu>& u) {
  { p.dynamics(0, x, u) } -> std::same_as<std::array<double, P::kNx>>;
  { p.residual(0, x, u) } -> std::same_as<std::array<double, P::kNr>>;
  { p.terminal_residual(x) } -> std::same_as<std::array<double, P::kNe>>;
  { p.input_lower(0) } -> std::same_as<std::array<double, P::kNu>>;
  { p.input_upper(0) } -> std::same_as<std::array<double, P::kNu>>;
  { P::kNc } -> std::convertible_to<int>;
};

/// Price of violating a soft constraint c <= 0 by s > 0: linear · s + ½ quadratic · s².
struct SoftPenalty {
  double linear = 500.0;
  double quadratic = 200.0;
  double cap = 1e30;  ///< a converged violation above this is reported as kInfeasible
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

/// How the solver behaves. Defaults suit control at 10–100 Hz.
struct SolverOptions {
  double tolerance = 1e-6;        ///< stationarity accepted as optimal; (0, 1e-2]
  double loose_tolerance = 1e-2;  ///< stationarity accepted when the budget is spent; [tolerance, 1e3]
  int max_iterations = 40;        ///< SQP turns; worst-case time is proportional to it; [1, 200]
  bool may_start_short =
      true;  ///< when full steps fail, grow the horizon from its beginning: reaches optima from poor
             ///< guesses, at the price of tens of turns; off where the budget is a few turns
  bool second_order = true;  ///< exact Hessians near the solution: fewer turns, costlier turns
};

}  // namespace chicane::solver
