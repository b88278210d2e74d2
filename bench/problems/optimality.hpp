// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "chicane/solver/problem.hpp"
#include "problems/dual.hpp"

namespace chicane::bench {

/// Objective of the inputs when they are simulated from x0, soft constraints as exact penalties. Works for
/// any scalar: `u(k, m)` gives the inputs.
template <class T, solver::OcpProblem P, class Inputs>
T simulated_cost(const P& problem, const std::array<double, P::kNx>& x0, int horizon, const Inputs& u) {
  std::array<T, P::kNx> x;
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = T(x0[i]);
  T cost(0.0);
  for (int k = 0; k < horizon; ++k) {
    std::array<T, P::kNu> input;
    for (int m = 0; m < P::kNu; ++m) input[static_cast<std::size_t>(m)] = u(k, m);
    for (const T& r : problem.residual(k, x, input)) cost += 0.5 * r * r;
    if constexpr (P::kNc > 0) {
      const auto values = problem.constraint(k, x, input);
      for (int c = 0; c < P::kNc; ++c) {
        const T& value = values[static_cast<std::size_t>(c)];
        const auto penalty = problem.soft_penalty(c);
        if (value > T(0.0)) cost += value * (penalty.linear + 0.5 * penalty.quadratic * value);
      }
    }
    x = problem.dynamics(k, x, input);
  }
  for (const T& r : problem.terminal_residual(x)) cost += 0.5 * r * r;
  return cost;
}

template <solver::OcpProblem P, int Capacity>
double simulated_cost(const P& problem, const std::array<double, P::kNx>& x0,
                      const solver::Trajectory<P::kNx, P::kNu, Capacity>& t) {
  return simulated_cost<double>(problem, x0, t.horizon, [&](int k, int m) {
    return t.u[static_cast<std::size_t>(k)][static_cast<std::size_t>(m)];
  });
}

/// dJ/du of the simulated inputs, by stages. Shares no code with the solver's adjoint: one forward derivative
/// for each input, through the whole simulation. Only for problems without soft constraints (their penalty
/// has a kink).
template <solver::OcpProblem P, int Capacity>
std::vector<std::array<double, P::kNu>> simulated_gradient(
    const P& problem, const std::array<double, P::kNx>& x0,
    const solver::Trajectory<P::kNx, P::kNu, Capacity>& t) {
  using T = Dual<1>;
  std::vector<std::array<double, P::kNu>> gradient(static_cast<std::size_t>(t.horizon));
  for (int stage = 0; stage < t.horizon; ++stage) {
    for (int input = 0; input < P::kNu; ++input) {
      const T cost = simulated_cost<T>(problem, x0, t.horizon, [&](int k, int m) {
        const double u = t.u[static_cast<std::size_t>(k)][static_cast<std::size_t>(m)];
        return k == stage && m == input ? T::variable(u, 0) : T(u);
      });
      gradient[static_cast<std::size_t>(stage)][static_cast<std::size_t>(input)] = cost.d[0];
    }
  }
  return gradient;
}

/// ‖u − Proj(u − dJ/du)‖∞ of the simulated inputs.
template <solver::OcpProblem P, int Capacity>
double projected_gradient(const P& problem, const std::array<double, P::kNx>& x0,
                          const solver::Trajectory<P::kNx, P::kNu, Capacity>& t) {
  const auto gradient = simulated_gradient(problem, x0, t);
  double worst = 0.0;
  for (int stage = 0; stage < t.horizon; ++stage) {
    const auto k = static_cast<std::size_t>(stage);
    for (std::size_t m = 0; m < gradient[k].size(); ++m) {
      const double u = t.u[k][m];
      const double moved =
          std::clamp(u - gradient[k][m], problem.input_lower(stage)[m], problem.input_upper(stage)[m]);
      worst = std::max(worst, std::fabs(moved - u));
    }
  }
  return worst;
}

/// Ipopt moves every bound outwards by this share of it, and at least by this much (its option
/// bound_relax_factor).
inline constexpr double kIpoptRelaxation = 1e-8;

/// By how much an optimum gets cheaper, to first order, when the bounds on its inputs are moved as Ipopt
/// moves them: the multipliers of the bounds, here the slopes of the simulated cost, times the moves.
template <solver::OcpProblem P, int Capacity>
double gain_of_relaxed_bounds(const P& problem, const std::array<double, P::kNx>& x0,
                              const solver::Trajectory<P::kNx, P::kNu, Capacity>& t) {
  const auto gradient = simulated_gradient(problem, x0, t);
  double gain = 0.0;
  for (int stage = 0; stage < t.horizon; ++stage) {
    const auto k = static_cast<std::size_t>(stage);
    for (std::size_t m = 0; m < gradient[k].size(); ++m) {
      const double slope = gradient[k][m];
      const double bound = slope > 0.0 ? problem.input_lower(stage)[m] : problem.input_upper(stage)[m];
      const double move = kIpoptRelaxation * std::max(1.0, std::fabs(bound));
      if (std::fabs(t.u[k][m] - bound) <= move) gain += std::fabs(slope) * move;
    }
  }
  return gain;
}

template <solver::OcpProblem P, int Capacity>
bool inputs_are_inside(const P& problem, const solver::Trajectory<P::kNx, P::kNu, Capacity>& t) {
  for (int k = 0; k < t.horizon; ++k) {
    for (std::size_t m = 0; m < static_cast<std::size_t>(P::kNu); ++m) {
      const double u = t.u[static_cast<std::size_t>(k)][m];
      if (!(u >= problem.input_lower(k)[m] && u <= problem.input_upper(k)[m])) return false;
    }
  }
  return true;
}

}  // namespace chicane::bench
