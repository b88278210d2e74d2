// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "chicane/solver/problem.hpp"
#include "families/kkt.hpp"

namespace chicane::bench {

/// The inputs simulated from x0.
template <solver::OcpProblem P, int Capacity>
solver::Trajectory<P::kNx, P::kNu, Capacity> simulated(const P& problem, const std::array<double, P::kNx>& x0,
                                                       solver::Trajectory<P::kNx, P::kNu, Capacity> t) {
  t.x[0] = x0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(t.horizon); ++k)
    t.x[k + 1] = problem.dynamics(static_cast<int>(k), t.x[k], t.u[k]);
  return t;
}

/// Objective of the inputs when they are simulated from x0, soft constraints as exact penalties.
template <solver::OcpProblem P, int Capacity>
double simulated_cost(const P& problem, const std::array<double, P::kNx>& x0,
                      const solver::Trajectory<P::kNx, P::kNu, Capacity>& t) {
  const auto along = simulated(problem, x0, t);
  double cost = 0.0;
  for (int k = 0; k < t.horizon; ++k) {
    const auto& x = along.x[static_cast<std::size_t>(k)];
    const auto& u = along.u[static_cast<std::size_t>(k)];
    for (const double r : problem.residual(k, x, u)) cost += 0.5 * r * r;
    if constexpr (P::kNc > 0) {
      int c = 0;
      for (const double value : problem.constraint(k, x, u)) {
        const auto penalty = problem.soft_penalty(c++);
        if (value > 0.0) cost += value * (penalty.linear + 0.5 * penalty.quadratic * value);
      }
    }
  }
  for (const double r : problem.terminal_residual(along.x[static_cast<std::size_t>(t.horizon)]))
    cost += 0.5 * r * r;
  return cost;
}

/// dJ/du of the simulated inputs, by stages, from the independent check (kkt.hpp). Only for problems without
/// soft constraints (their penalty has a kink).
template <solver::OcpProblem P, int Capacity>
std::vector<std::array<double, P::kNu>> simulated_gradient(
    const P& problem, const std::array<double, P::kNx>& x0,
    const solver::Trajectory<P::kNx, P::kNu, Capacity>& t) {
  std::vector<std::array<double, P::kNu>> gradient(static_cast<std::size_t>(t.horizon));
  const auto no_price = [](int, int) { return 0.0; };
  check_kkt(OverArrays<P>{problem}, simulated(problem, x0, t), no_price, NoHardMultipliers{},
            gradient.data());
  return gradient;
}

/// ‖u − Proj(u − dJ/du)‖∞ of the simulated inputs.
template <solver::OcpProblem P, int Capacity>
double projected_gradient(const P& problem, const std::array<double, P::kNx>& x0,
                          const solver::Trajectory<P::kNx, P::kNu, Capacity>& t) {
  const auto no_price = [](int, int) { return 0.0; };
  return check_kkt(OverArrays<P>{problem}, simulated(problem, x0, t), no_price).stationarity;
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
