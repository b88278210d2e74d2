// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <tuple>

#include "chicane/base/inlining.hpp"
#include "chicane/base/math_pack.hpp"
#include "chicane/solver/problem.hpp"
#include "problems/corridor_problem.hpp"

namespace chicane::bench {

/// The structured corridor problem over its numbers (DescribedOver); its soft constraints are of one price
/// for all.
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
  return StructuredDescribedProblem(plain, cte);
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
