// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <tuple>

#include "chicane/base/inlining.hpp"
#include "chicane/base/math_pack.hpp"
#include "chicane/solver/problem.hpp"
#include "problems/corridor_problem.hpp"

namespace chicane::bench {

/// The structured described problem over its numbers: doubles for one problem, packs for several side by
/// side.
template <class Real>
struct DescribedOver {
  static constexpr int kNx = 7;
  static constexpr int kNu = 2;
  static constexpr int kNr = 7;
  static constexpr int kNe = 3;
  static constexpr int kNc = 0;
  static constexpr double kStep = DescribedData::kStep;
  static constexpr double kLength = DescribedData::kLength;

  std::array<Real, 4> path{};
  Real speed_reference{};
  Real steer_limit{};
  Real acceleration_limit{};
  Real first_cte{};

  template <class K, class X, class U>
  CHICANE_INLINE auto dynamics(K, const X& s, const U& input) const {
    const auto& [x, y, psi, v, epsi, last_steer, last_a] = s;
    const auto& [steer, a] = input;
    const auto turn = v * steer * (kStep / kLength);
    return std::make_tuple(x + v * cos(psi) * kStep, y + v * sin(psi) * kStep, psi + turn, v + a * kStep,
                           psi - atan(slope(x)) + turn, steer, a);
  }
  template <class K, class X, class U>
  CHICANE_INLINE auto residual(K k, const X& s, const U& input) const {
    const auto& [x, y, psi, v, epsi, last_steer, last_a] = s;
    const auto& [steer, a] = input;
    const auto change = select(solver::stage_number(k) > 0.0, 1.0, 0.0);
    return std::make_tuple(weight(200.0) * next_cte(s), weight(200.0) * epsi,
                           weight(0.1) * (v - speed_reference), weight(1.0) * steer, weight(1.0) * a,
                           change * weight(10.0) * (steer - last_steer), change * weight(1.0) * (a - last_a));
  }
  template <class X>
  CHICANE_INLINE auto terminal_residual(const X& s) const {
    const auto& [x, y, psi, v, epsi, last_steer, last_a] = s;
    return std::make_tuple(weight(200.0) * first_cte, weight(200.0) * epsi,
                           weight(0.1) * (v - speed_reference));
  }
  template <class X>
  CHICANE_INLINE auto next_cte(const X& s) const {
    const auto& [x, y, psi, v, epsi, last_steer, last_a] = s;
    return path[0] + x * (path[1] + x * (path[2] + x * path[3])) - y + v * sin(epsi) * kStep;
  }
  [[nodiscard]] std::array<Real, 2> input_lower(int) const { return {-steer_limit, -acceleration_limit}; }
  [[nodiscard]] std::array<Real, 2> input_upper(int) const { return {steer_limit, acceleration_limit}; }

 private:
  static double weight(double w) { return DescribedData::weight(w); }
  template <class T>
  auto slope(const T& x) const {
    return path[1] + x * (2.0 * path[2] + x * (3.0 * path[3]));
  }
};

/// The structured corridor problem likewise; its soft constraints are of one price for all.
template <class Real>
struct CorridorOver : DescribedOver<Real> {
  static constexpr int kNc = 2;
  static constexpr std::size_t kStages = 64;  ///< eight at a time never read beyond them up to N = 56
  using Bounds = std::array<Real, kStages>;

  Bounds low{};
  Bounds high{};

  template <class K, class X, class U>
  CHICANE_INLINE auto constraint(K k, const X& s, const U&) const {
    const auto cte = this->next_cte(s);
    return std::make_tuple(cte - at(high, k), at(low, k) - cte);
  }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 500.0, .quadratic = 100.0}; }

 private:
  static const Real& at(const Bounds& bounds, int k) { return bounds[static_cast<std::size_t>(k)]; }
  template <class V>
  static V at(const Bounds& bounds, solver::StageLanes<V> k) {
    return V::load_unaligned(&bounds[static_cast<std::size_t>(k.first)]);
  }
};

/// One of them for a batch, from the problem as it is written down, its first cross-track error and a
/// horizon.
inline DescribedOver<double> for_batch(const DescribedProblem& plain, double cte, int = 0) {
  DescribedOver<double> p;
  p.path = plain.path;
  p.speed_reference = plain.speed_reference;
  p.steer_limit = plain.steer_limit;
  p.acceleration_limit = plain.acceleration_limit;
  p.first_cte = cte;
  return p;
}
inline CorridorOver<double> for_batch(const CorridorProblem& plain, double cte, int horizon) {
  const StructuredCorridorProblem structured(plain, cte, horizon);
  CorridorOver<double> p;
  static_cast<DescribedOver<double>&>(p) = for_batch(static_cast<const DescribedProblem&>(plain), cte);
  for (int k = 0; k < horizon; ++k) {
    p.low[static_cast<std::size_t>(k)] = structured.low.at(k);
    p.high[static_cast<std::size_t>(k)] = structured.high.at(k);
  }
  return p;
}

}  // namespace chicane::bench
