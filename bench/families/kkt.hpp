// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "chicane/solver/hard_constraints.hpp"
#include "chicane/solver/problem.hpp"
#include "problems/dual.hpp"

namespace chicane::bench {

/// A structured problem, or one over lanes, as functions of arrays of one scalar: for Ipopt and for checks.
template <solver::OcpProblem P>
struct OverArrays : P {
  static constexpr int kNh = solver::equality_count<P>();
  static constexpr int kNeh = solver::terminal_equality_count<P>();
  static constexpr int kNec = solver::terminal_constraint_count<P>();
  template <class T>
  using X = std::array<T, P::kNx>;
  template <class T>
  using U = std::array<T, P::kNu>;
  template <class T>
  std::array<T, P::kNx> dynamics(int k, const X<T>& x, const U<T>& u) const {
    return solver::to_array<T>(P::dynamics(k, x, u));
  }
  template <class T>
  std::array<T, P::kNr> residual(int k, const X<T>& x, const U<T>& u) const {
    return solver::to_array<T>(P::residual(k, x, u));
  }
  template <class T>
  std::array<T, P::kNe> terminal_residual(const X<T>& x) const {
    return solver::to_array<T>(P::terminal_residual(x));
  }
  template <class T>
  std::array<T, P::kNc> constraint(int k, const X<T>& x, const U<T>& u) const {
    if constexpr (P::kNc > 0) return solver::to_array<T>(P::constraint(k, x, u));
    return {};
  }
  template <class T>
  std::array<T, kNh> equality(int k, const X<T>& x, const U<T>& u) const {
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

/// The multipliers of what must hold: of the equalities of stages, and at the end.
struct NoHardMultipliers {
  double equality_multiplier(int, int) const { return 0.0; }
  double terminal_equality_multiplier(int) const { return 0.0; }
  double terminal_constraint_multiplier(int) const { return 0.0; }
};

/// Checks a trajectory with the multipliers of its soft constraints, `multiplier(k, c)`, and of what must
/// hold. Everything else is computed here, by dual numbers, stage by stage: no line is shared with the
/// solver.
template <solver::OcpProblem P, int Capacity, class Multiplier, class HardMultiplier = NoHardMultipliers>
KktResidual check_kkt(const OverArrays<P>& problem, const solver::Trajectory<P::kNx, P::kNu, Capacity>& t,
                      const Multiplier& multiplier, const HardMultiplier& hard = {}) {
  constexpr int kNx = P::kNx, kNu = P::kNu, kNz = kNx + kNu;
  using D = Dual<kNz>;
  constexpr double kUnit = 2.2e-16;
  std::array<double, kNx> error{};  // of the adjoint, as rounding adds up
  KktResidual result;
  std::array<double, kNx> adjoint{};
  {
    std::array<D, kNx> x;
    for (int i = 0; i < kNx; ++i)
      x[static_cast<std::size_t>(i)] =
          D::variable(t.x[static_cast<std::size_t>(t.horizon)][static_cast<std::size_t>(i)], i);
    for (const D& r : problem.template terminal_residual<D>(x)) {
      result.cost += 0.5 * r.v * r.v;
      for (std::size_t i = 0; i < kNx; ++i) adjoint[i] += r.v * r.d[i];
    }
    const auto add = [&](const D& row, double y) {
      if (std::isnan(row.v)) result.miss = HUGE_VAL;
      for (std::size_t i = 0; i < kNx; ++i) {
        adjoint[i] += y * row.d[i];
        error[i] += kUnit * std::fabs(y * row.d[i]);
      }
    };
    int n = 0;
    for (const D& h : problem.template terminal_equality<D>(x)) {
      result.miss = std::max(result.miss, std::fabs(h.v));
      result.total += std::fabs(h.v);
      add(h, hard.terminal_equality_multiplier(n++));
    }
    n = 0;
    for (const D& g : problem.template terminal_constraint<D>(x)) {
      const double y = hard.terminal_constraint_multiplier(n++);
      result.miss = std::max(result.miss, g.v);
      result.total += std::max(0.0, g.v);
      result.subgradient = std::max({result.subgradient, -y, std::min(-g.v, y)});
      add(g, y);
    }
  }
  for (int stage = t.horizon; stage-- > 0;) {
    const auto k = static_cast<std::size_t>(stage);
    std::array<D, kNx> x;
    std::array<D, kNu> u;
    for (int i = 0; i < kNx; ++i)
      x[static_cast<std::size_t>(i)] = D::variable(t.x[k][static_cast<std::size_t>(i)], i);
    for (int m = 0; m < kNu; ++m)
      u[static_cast<std::size_t>(m)] = D::variable(t.u[k][static_cast<std::size_t>(m)], kNx + m);
    std::array<double, kNz> slope{};
    std::array<double, kNz> noise{};
    const auto add = [&](const D& row, double weight) {
      for (std::size_t v = 0; v < kNz; ++v) {
        slope[v] += weight * row.d[v];
        noise[v] += kUnit * std::fabs(weight * row.d[v]);
      }
    };
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
    int row = 0;
    for (const D& h : problem.template equality<D>(stage, x, u)) {
      if (std::isnan(h.v)) result.miss = HUGE_VAL;
      result.miss = std::max(result.miss, std::fabs(h.v));
      result.total += std::fabs(h.v);
      add(h, hard.equality_multiplier(stage, row++));
    }
    if constexpr (P::kNc > 0) {
      const auto values = problem.template constraint<D>(stage, x, u);
      for (int c = 0; c < P::kNc; ++c) {
        const double value = values[static_cast<std::size_t>(c)].v;
        const auto penalty = problem.soft_penalty(c);
        const double z = multiplier(stage, c);
        const double beyond = std::max(value, 0.0);
        if (is_hard(problem, c)) {
          result.miss = std::max(result.miss, beyond);
          result.total += beyond;
          result.subgradient = std::max({result.subgradient, std::min(-std::min(value, 0.0), z), -z});
          add(values[static_cast<std::size_t>(c)], z);
          continue;
        }
        result.cost += beyond * (penalty.linear + 0.5 * penalty.quadratic * beyond);
        const double inside = std::min(std::fabs(std::min(value, 0.0)), std::fabs(z));
        const double kink = std::min(beyond, std::fabs(penalty.linear + penalty.quadratic * beyond - z));
        result.subgradient = std::max({result.subgradient, inside, kink, -z});
        add(values[static_cast<std::size_t>(c)], z);
      }
    }
    const auto low = problem.input_lower(stage);
    const auto high = problem.input_upper(stage);
    for (std::size_t m = 0; m < kNu; ++m) {
      const double gradient = slope[kNx + m];
      const double at = t.u[k][m];
      const double moved = std::clamp(at - gradient, low[m], high[m]);
      result.stationarity = std::max(result.stationarity, std::fabs(moved - at));
      result.outside = std::max({result.outside, low[m] - at, at - high[m]});
    }
    for (std::size_t m = 0; m < kNu; ++m) result.rounding = std::max(result.rounding, noise[kNx + m]);
    for (std::size_t i = 0; i < kNx; ++i) {
      adjoint[i] = slope[i];
      error[i] = noise[i] + kUnit * std::fabs(slope[i]);
    }
  }
  return result;
}

}  // namespace chicane::bench
