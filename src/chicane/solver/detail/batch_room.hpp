// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "chicane/base/inlining.hpp"
#include "chicane/base/math_pack.hpp"
#include "chicane/solver/detail/soft_constraint.hpp"
#include "chicane/solver/problem.hpp"

namespace chicane::solver {

/// Several problems of one kind with their iterates, one in each lane of the pack V. A problem is a struct of
/// nothing but numbers: Problem<V> holds as many side by side.
template <template <class> class Problem, class V, int Capacity>
struct BatchRoom {
  using One = Problem<double>;
  using Many = Problem<V>;
  static constexpr std::size_t kLanes = V::kLanes;
  static constexpr std::size_t kNx = One::kNx;
  static constexpr std::size_t kNu = One::kNu;
  static constexpr std::size_t kNc = One::kNc;
  static constexpr std::size_t kNumbers = sizeof(One) / sizeof(double);
  static_assert(sizeof(Many) == kLanes * sizeof(One), "a problem of a batch consists of its numbers alone");

  Many many;
  std::array<std::array<V, kNx>, Capacity + 1> x;
  std::array<std::array<V, kNu>, Capacity> u;
  std::array<std::array<SoftConstraint<V>, kNc>, kNc == 0 ? 1 : Capacity> soft;
  std::size_t owner[kLanes]{};  ///< number of the problem in each lane

  /// Puts problem number `i` with its start and the inputs of its guess into a lane.
  template <class Trajectory>
  void put(std::size_t lane, std::size_t i, const One& problem, const std::array<double, kNx>& start,
           const Trajectory& guess) noexcept {
    const auto* from = static_cast<const double*>(static_cast<const void*>(&problem));
    auto* to = static_cast<double*>(static_cast<void*>(&many));
    for (std::size_t n = 0; n < kNumbers; ++n) to[n * kLanes + lane] = from[n];
    for (std::size_t j = 0; j < kNx; ++j) x[0][j].set(lane, start[j]);
    for (std::size_t k = 0; k < static_cast<std::size_t>(guess.horizon); ++k) {
      for (std::size_t m = 0; m < kNu; ++m) u[k][m].set(lane, guess.u[k][m]);
    }
    owner[lane] = i;
  }

  /// Simulates all lanes from inputs within their bounds, not-a-number where those cross; slacks start on the
  /// central path of the barrier `mu`.
  CHICANE_FLATTEN void simulate(std::size_t horizon, double mu) noexcept {
    for (std::size_t k = 0; k < horizon; ++k) {
      const int number = static_cast<int>(k);
      const auto low = many.input_lower(number);
      const auto high = many.input_upper(number);
      for (std::size_t m = 0; m < kNu; ++m) {
        const V wanted = select(is_finite(u[k][m]), u[k][m], V(0.0));
        const V within = min(max(wanted, V(low[m])), V(high[m]));
        u[k][m] = select(V(low[m]) <= V(high[m]), within, V(std::numeric_limits<double>::quiet_NaN()));
      }
      x[k + 1] = to_array<V>(many.dynamics(number, x[k], u[k]));
      if constexpr (kNc > 0) {
        const auto values = to_array<V>(many.constraint(number, x[k], u[k]));
        for (std::size_t c = 0; c < kNc; ++c) {
          soft[k][c].value = values[c];
          soft[k][c].centre(price(c), mu);
        }
      }
    }
  }

  /// Moves what is in `lanes` of `other` into the same lanes.
  void move_in(const BatchRoom& other, const typename V::MaskType& lanes, std::size_t horizon) noexcept {
    const auto move = [&](V& to, const V& from) CHICANE_INLINE { to = select(lanes, from, to); };
    auto* to = static_cast<V*>(static_cast<void*>(&many));
    const auto* from = static_cast<const V*>(static_cast<const void*>(&other.many));
    for (std::size_t n = 0; n < kNumbers; ++n) move(to[n], from[n]);
    for (std::size_t k = 0; k < horizon; ++k) {
      unroll<kNx>([&](auto i) CHICANE_INLINE { move(x[k][i], other.x[k][i]); });
      unroll<kNu>([&](auto m) CHICANE_INLINE { move(u[k][m], other.u[k][m]); });
      unroll<kNc>([&](auto c) CHICANE_INLINE {
        move(soft[k][c].s, other.soft[k][c].s);
        move(soft[k][c].t, other.soft[k][c].t);
        move(soft[k][c].n, other.soft[k][c].n);
        move(soft[k][c].z, other.soft[k][c].z);
      });
    }
    for (std::size_t i = 0; i < kNx; ++i) move(x[horizon][i], other.x[horizon][i]);
  }

  /// Of soft constraint c.
  [[nodiscard]] CHICANE_INLINE SoftPenalty price([[maybe_unused]] std::size_t c) const noexcept {
    if constexpr (kNc > 0) return many.soft_penalty(static_cast<int>(c));
    return {};
  }
  /// Where the barrier starts for such prices: one height for all lanes, OcpSolver's for a start that
  /// violates its constraints by 0.4.
  [[nodiscard]] double start_mu() const noexcept {
    double most = 0.0;
    for (std::size_t c = 0; c < kNc; ++c) most = std::max({most, price(c).linear, 0.1 * price(c).quadratic});
    return 0.2 * most;
  }
};

}  // namespace chicane::solver
