// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "chicane/solver/hard_constraints.hpp"
#include "chicane/solver/problem.hpp"
#include "problems/dual.hpp"

namespace chicane::bench {

/// A structured problem, or one over lanes, as functions of arrays of one scalar.
template <solver::OcpProblem P>
struct OverArrays : P {
  static constexpr int kNh = solver::equality_count<P>();
  static constexpr int kNeh = solver::terminal_equality_count<P>();
  static constexpr int kNec = solver::terminal_constraint_count<P>();
  template <class T>
  using X = std::array<T, P::kNx>;
  template <class T>
  using U = std::array<T, P::kNu>;
  template <class T, class K>
  std::array<T, P::kNx> dynamics(K k, const X<T>& x, const U<T>& u) const {
    return solver::to_array<T>(P::dynamics(k, x, u));
  }
  template <class T, class K>
  std::array<T, P::kNr> residual(K k, const X<T>& x, const U<T>& u) const {
    return solver::to_array<T>(P::residual(k, x, u));
  }
  template <class T>
  std::array<T, P::kNe> terminal_residual(const X<T>& x) const {
    return solver::to_array<T>(P::terminal_residual(x));
  }
  template <class T, class K>
  std::array<T, P::kNc> constraint(K k, const X<T>& x, const U<T>& u) const {
    if constexpr (P::kNc > 0) return solver::to_array<T>(P::constraint(k, x, u));
    return {};
  }
  template <class T, class K>
  std::array<T, kNh> equality(K k, const X<T>& x, const U<T>& u) const {
    if constexpr (kNh > 0) return solver::to_array<T>(P::equality(k, x, u));
    return {};
  }
  template <class T>
  std::array<T, kNeh> terminal_equality(const X<T>& x) const {
    if constexpr (kNeh > 0) return solver::to_array<T>(P::terminal_equality(x));
    return {};
  }
  template <class T>
  std::array<T, kNec> terminal_constraint(const X<T>& x) const {
    if constexpr (kNec > 0) return solver::to_array<T>(P::terminal_constraint(x));
    return {};
  }
};
/// Whether constraint c must hold.
template <class P>
[[nodiscard]] bool is_hard([[maybe_unused]] const P& problem, [[maybe_unused]] int c) {
  if constexpr (requires { problem.is_hard(0); }) return problem.is_hard(c);
  return false;
}

/// How far a trajectory is from a point where no direction is downhill.
struct KktResidual {
  double defect = 0.0;        ///< ‖x_{k+1} − f‖∞ / (1 + |x|)
  double stationarity = 0.0;  ///< ‖u − Proj(u − dL/du)‖∞
  double subgradient = 0.0;   ///< how far each multiplier is from belonging to its constraint's value
  double outside = 0.0;       ///< of the bounds of inputs and of their changes
  double miss = 0.0;          ///< of what must hold
  double total = 0.0;         ///< sum of its misses
  double rounding = 0.0;  ///< what it may leave of the stationarity here: one ulp in each product, added up
                          ///< along the horizon
  double cost = 0.0;      ///< with the exact penalties
};

/// Multipliers of constraints and of what else must hold, as a solver hands them out: none.
struct NoMultipliers {
  double constraint_multiplier(int, int) const { return 0.0; }
  double equality_multiplier(int, int) const { return 0.0; }
  double terminal_equality_multiplier(int) const { return 0.0; }
  double terminal_constraint_multiplier(int) const { return 0.0; }
};

/// Scalars at `values`: double, dual or of second order, with variables from number `first` on.
template <class T, std::size_t N>
[[nodiscard]] std::array<T, N> variables_at(const std::array<double, N>& values, [[maybe_unused]] int first) {
  std::array<T, N> result;
  for (std::size_t i = 0; i < N; ++i) {
    [[maybe_unused]] const int index = first + static_cast<int>(i);
    if constexpr (std::is_same_v<T, double>) {
      result[i] = values[i];
    } else if constexpr (std::is_same_v<decltype(T::v), double>) {
      result[i] = T::variable(values[i], index);
    } else {
      result[i] = T::variable(decltype(T::v)::variable(values[i], index), index);
    }
  }
  return result;
}

/// Checks a trajectory with multipliers. Everything else is computed here, by dual numbers, stage by stage:
/// no line is shared with the solver. `gradient`, where given, gets dL/du of each stage.
template <solver::OcpProblem P, int Capacity, class Multipliers = NoMultipliers>
KktResidual check_kkt(const OverArrays<P>& problem, const solver::Trajectory<P::kNx, P::kNu, Capacity>& t,
                      const Multipliers& of = {}, std::array<double, P::kNu>* gradient = nullptr) {
  constexpr int kNx = P::kNx, kNu = P::kNu, kNz = kNx + kNu;
  using D = Dual<kNz>;
  constexpr double kUnit = 2.2e-16;
  KktResidual result;
  std::array<double, kNz> slope{};  // of the Lagrangian's stage, by x_k and u_k
  std::array<double, kNz> noise{};  // what rounding leaves in it
  const auto add = [&](const D& row, double weight) {
    for (std::size_t v = 0; v < kNz; ++v) {
      slope[v] += weight * row.d[v];
      noise[v] += kUnit * std::fabs(weight * row.d[v]);
    }
  };
  const auto must_be_zero = [&](const D& h, double y) {
    if (std::isnan(h.v)) result.miss = HUGE_VAL;
    result.miss = std::max(result.miss, std::fabs(h.v));
    result.total += std::fabs(h.v);
    add(h, y);
  };
  const auto must_not_be_positive = [&](const D& g, double y) {
    const double beyond = std::max(g.v, 0.0), inside = -std::min(g.v, 0.0);
    result.miss = std::isnan(g.v) ? HUGE_VAL : std::max(result.miss, beyond);
    result.total += beyond;
    result.subgradient = std::max({result.subgradient, -y, std::min(inside, y)});
    add(g, y);
  };
  const auto end = variables_at<D>(t.x[static_cast<std::size_t>(t.horizon)], 0);
  for (const D& r : problem.template terminal_residual<D>(end)) {
    result.cost += 0.5 * r.v * r.v;
    for (std::size_t i = 0; i < kNx; ++i) slope[i] += r.v * r.d[i];
  }
  [[maybe_unused]] int row = 0;
  if constexpr (OverArrays<P>::kNeh > 0) {
    for (const D& h : problem.template terminal_equality<D>(end))
      must_be_zero(h, of.terminal_equality_multiplier(row++));
  }
  row = 0;
  if constexpr (OverArrays<P>::kNec > 0) {
    for (const D& g : problem.template terminal_constraint<D>(end))
      must_not_be_positive(g, of.terminal_constraint_multiplier(row++));
  }
  std::array<double, kNx> adjoint{}, error{};  // and the error of the adjoint, as rounding adds up
  for (int stage = t.horizon; stage-- > 0;) {
    for (std::size_t i = 0; i < kNx; ++i) {
      adjoint[i] = slope[i];
      error[i] = noise[i] + (stage + 1 < t.horizon ? kUnit * std::fabs(slope[i]) : 0.0);
    }
    slope = noise = {};
    const auto k = static_cast<std::size_t>(stage);
    const auto x = variables_at<D>(t.x[k], 0);
    const auto u = variables_at<D>(t.u[k], kNx);
    for (const D& r : problem.template residual<D>(stage, x, u)) {
      result.cost += 0.5 * r.v * r.v;
      add(r, r.v);
    }
    const auto next = problem.template dynamics<D>(stage, x, u);
    for (std::size_t i = 0; i < kNx; ++i) {
      const double size = 1.0 + std::fabs(next[i].v);
      result.defect = std::max(result.defect, std::fabs(t.x[k + 1][i] - next[i].v) / size);
      add(next[i], adjoint[i]);
      for (std::size_t v = 0; v < kNz; ++v)
        noise[v] += std::fabs(next[i].d[v]) * (error[i] + kUnit * std::fabs(adjoint[i]));
    }
    row = 0;
    if constexpr (OverArrays<P>::kNh > 0) {
      for (const D& h : problem.template equality<D>(stage, x, u))
        must_be_zero(h, of.equality_multiplier(stage, row++));
    }
    if constexpr (P::kNc > 0) {
      int c = -1;
      for (const D& value : problem.template constraint<D>(stage, x, u)) {
        const double z = of.constraint_multiplier(stage, ++c);
        if (is_hard(problem, c)) {
          must_not_be_positive(value, z);
          continue;
        }
        const auto penalty = problem.soft_penalty(c);
        const double beyond = std::max(value.v, 0.0);
        result.cost += beyond * (penalty.linear + 0.5 * penalty.quadratic * beyond);
        const double inside = std::min(std::fabs(std::min(value.v, 0.0)), std::fabs(z));
        const double kink = std::min(beyond, std::fabs(penalty.linear + penalty.quadratic * beyond - z));
        result.subgradient = std::max({result.subgradient, inside, kink, -z});
        add(value, z);
      }
    }
    const auto low = problem.input_lower(stage), high = problem.input_upper(stage);
    for (std::size_t m = 0; m < kNu; ++m) {
      const double at = t.u[k][m], moved = std::clamp(at - slope[kNx + m], low[m], high[m]);
      result.stationarity = std::max(result.stationarity, std::fabs(moved - at));
      result.outside = std::max({result.outside, low[m] - at, at - high[m]});
      result.rounding = std::max(result.rounding, noise[kNx + m]);
      if (gradient != nullptr) gradient[k][m] = slope[kNx + m];
    }
  }
  return result;
}
template <solver::OcpProblem P, int Capacity, class Multipliers = NoMultipliers>
KktResidual check_kkt(const P& problem, const solver::Trajectory<P::kNx, P::kNu, Capacity>& t,
                      const Multipliers& of = {}) {
  return check_kkt(OverArrays<P>{problem}, t, of);
}

/// The independent check of the inputs, simulated from x0: soft constraints as exact penalties. `gradient`,
/// where given, gets dJ/du of each stage.
template <solver::OcpProblem P, int Capacity>
KktResidual check_simulated(const P& problem, const std::array<double, P::kNx>& x0,
                            solver::Trajectory<P::kNx, P::kNu, Capacity> t,
                            std::array<double, P::kNu>* gradient = nullptr) {
  t.x[0] = x0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(t.horizon); ++k)
    t.x[k + 1] = problem.dynamics(static_cast<int>(k), t.x[k], t.u[k]);
  return check_kkt(OverArrays<P>{problem}, t, NoMultipliers{}, gradient);
}

/// Objective of the inputs when they are simulated from x0.
template <solver::OcpProblem P, int Capacity>
double simulated_cost(const P& problem, const std::array<double, P::kNx>& x0,
                      const solver::Trajectory<P::kNx, P::kNu, Capacity>& t) {
  return check_simulated(problem, x0, t).cost;
}

/// ‖u − Proj(u − dJ/du)‖∞ of the simulated inputs. Only for problems without soft constraints (their penalty
/// has a kink).
template <solver::OcpProblem P, int Capacity>
double projected_gradient(const P& problem, const std::array<double, P::kNx>& x0,
                          const solver::Trajectory<P::kNx, P::kNu, Capacity>& t) {
  return check_simulated(problem, x0, t).stationarity;
}

/// Ipopt moves every bound outwards by this share of it, and at least by this much (its option
/// bound_relax_factor).
inline constexpr double kIpoptRelaxation = 1e-8;

/// By how much an optimum gets cheaper, to first order, when the bounds on its inputs are moved as Ipopt
/// moves them: the multipliers of the bounds, here the slopes of the simulated cost, times the moves.
template <solver::OcpProblem P, int Capacity>
double gain_of_relaxed_bounds(const P& problem, const std::array<double, P::kNx>& x0,
                              const solver::Trajectory<P::kNx, P::kNu, Capacity>& t) {
  std::vector<std::array<double, P::kNu>> gradient(static_cast<std::size_t>(t.horizon));
  check_simulated(problem, x0, t, gradient.data());
  double gain = 0.0;
  for (std::size_t k = 0; k < gradient.size(); ++k) {
    const auto low = problem.input_lower(static_cast<int>(k)),
               high = problem.input_upper(static_cast<int>(k));
    for (std::size_t m = 0; m < gradient[k].size(); ++m) {
      const double slope = gradient[k][m], bound = slope > 0.0 ? low[m] : high[m];
      const double move = kIpoptRelaxation * std::max(1.0, std::fabs(bound));
      if (std::fabs(t.u[k][m] - bound) <= move) gain += std::fabs(slope) * move;
    }
  }
  return gain;
}

template <solver::OcpProblem P, int Capacity>
bool inputs_are_inside(const P& problem, const solver::Trajectory<P::kNx, P::kNu, Capacity>& t) {
  bool are_inside = true;
  for (int k = 0; k < t.horizon; ++k) {
    const auto& u = t.u[static_cast<std::size_t>(k)];
    for (std::size_t m = 0; m < u.size(); ++m)
      are_inside = are_inside && u[m] >= problem.input_lower(k)[m] && u[m] <= problem.input_upper(k)[m];
  }
  return are_inside;
}

}  // namespace chicane::bench
