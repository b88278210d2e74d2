// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>
#include <type_traits>

#include "chicane/base/inlining.hpp"
#include "chicane/base/math_pack.hpp"
#include "chicane/solver/detail/pattern.hpp"
#include "chicane/solver/detail/problem_pattern.hpp"

namespace chicane::solver {

/// Adds up what the rows of a structured problem's functions bring to one stage of the quadratic programs of
/// several problems, one in each lane of V: over the entries that there are, everything unrolled.
template <class V, StructuredProblem Problem>
struct BatchTerms {
  using Layout = solver::Layout<ProblemPattern<Problem>>;
  using Jacobians = std::array<V, Layout::kFCount>;  ///< as numbered by Layout::kF
  using Costs = std::array<V, Layout::kLCount>;      ///< as numbered by Layout::kL
  static constexpr std::size_t kNx = Layout::kNx;
  static constexpr int kVariables = Problem::kNx + Problem::kNu;

  /// Row I of the Jacobians, without its defect.
  template <std::size_t I, class J>
  CHICANE_INLINE static void set_jacobian(const J& row, Jacobians& F) noexcept {
    jet::repeat<kVariables>([&](auto j) CHICANE_INLINE {
      constexpr std::size_t kEntry = Layout::kF[I][in_z<Problem>(j)];
      if constexpr (kEntry != Layout::kNone) F[kEntry] = jet::number<V>(jet::slope<j>(row));
    });
  }

  /// Sets to zero what no row of `Rows` sets first.
  template <class Rows>
  CHICANE_INLINE static void clear(Costs& L) noexcept {
    using Sets = detail::RowSets<Rows>;
    jet::repeat<kVariables>([&](auto i) CHICANE_INLINE {
      if constexpr (gradient(i) != Layout::kNone && Sets::first_with(i) < 0) L[gradient(i)] = V(0.0);
      jet::repeat<i + 1>([&](auto j) CHICANE_INLINE {
        if constexpr (hessian(i, j) != Layout::kNone && Sets::first_with(i, j) < 0) L[hessian(i, j)] = V(0.0);
      });
    });
  }

  /// ½‖r‖²: gradient and Gauss–Newton Hessian of all rows, and ‖r‖² to `squares`.
  template <class Rows>
  CHICANE_INLINE static void add_squares(const Rows& rows, Costs& L, V& squares) noexcept {
    unroll<std::tuple_size_v<Rows>>([&](auto n) CHICANE_INLINE {
      const auto& r = std::get<n>(rows);
      const V value = V(jet::value(r));
      squares = fused_multiply_add(value, value, squares);
      add_gradient<Rows, n>(r, value, L);
      add_square<Rows, n>(r, jet::One{}, L);
    });
  }
  /// L += weight · dr; `Rows`, N: the first row with an entry sets it; void: none does.
  template <class Rows, std::size_t N, class J>
  CHICANE_INLINE static void add_gradient(const J& r, const V& weight, Costs& L) noexcept {
    for_slopes(r, [&](auto i, const auto& slope)
                      CHICANE_INLINE { add<is_first<Rows, N>(i, i)>(weight, slope, L[gradient(i)]); });
  }
  /// L += weight · drᵀ dr
  template <class Rows, std::size_t N, class J, class W>
  CHICANE_INLINE static void add_square(const J& r, const W& weight, Costs& L) noexcept {
    for_slopes(r, [&](auto i, const auto& by_i) CHICANE_INLINE {
      const auto scaled = jet::times(weight, by_i);
      for_slopes(r, [&](auto j, const auto& by_j) CHICANE_INLINE {
        if constexpr (j <= i) add<is_first<Rows, N>(i, j)>(scaled, by_j, L[hessian(i, j)]);
      });
    });
  }
  /// L += weight · ddr
  template <class J>
  CHICANE_INLINE static void add_curvature(const J& r, const V& weight, Costs& L) noexcept {
    for_curvatures(r, [&](auto i, auto j, const V& curvature)
                          CHICANE_INLINE { add<false>(weight, curvature, L[hessian(i, j)]); });
  }

  /// The terminal cost: gradient to p, Hessian to the upper triangle of P, second derivatives times
  /// `exactness`.
  template <class Rows, class Value>
  CHICANE_INLINE static void add_terminal(const Rows& rows, const V& exactness, Value& value,
                                          V& squares) noexcept {
    for (auto& row : value.P) row.fill(V(0.0));
    value.p.fill(V(0.0));
    unroll<std::tuple_size_v<Rows>>([&](auto n) CHICANE_INLINE {
      const auto& r = std::get<n>(rows);
      const V size = V(jet::value(r));
      squares = fused_multiply_add(size, size, squares);
      for_slopes(r, [&](auto i, const auto& by_i) CHICANE_INLINE {
        add<false>(size, by_i, value.p[i]);
        for_slopes(r, [&](auto j, const auto& by_j) CHICANE_INLINE {
          if constexpr (i <= j) add<false>(by_i, by_j, value.P[i][j]);
        });
      });
      for_curvatures(r, [&](auto i, auto j, const V& curvature) CHICANE_INLINE {
        add<false>(exactness * size, curvature, value.P[std::min<int>(i, j)][std::max<int>(i, j)]);
      });
    });
  }

  /// visit(i, ∂r/∂w_i) for the derivatives that there are; none of a constant.
  template <class J, class Visit>
  CHICANE_INLINE static void for_slopes(const J& r, const Visit& visit) noexcept {
    if constexpr (AnyJet<J>) {
      jet::repeat<size_of(J::kFirst)>([&](auto n) CHICANE_INLINE {
        constexpr int i = member_of(J::kFirst, n);
        visit(std::integral_constant<int, i>{}, jet::slope<i>(r));
      });
    }
  }

 private:
  static constexpr std::size_t gradient(int i) noexcept { return Layout::kL[in_z<Problem>(i)][kNx]; }
  static constexpr std::size_t hessian(int i, int j) noexcept {
    return Layout::kL[in_z<Problem>(i)][in_z<Problem>(j)];
  }
  template <class Rows, std::size_t N>
  static constexpr bool is_first(int i, int j) noexcept {
    if constexpr (std::is_void_v<Rows>) {
      return false;
    } else {
      return detail::RowSets<Rows>::first_with(i, j) == static_cast<int>(N);
    }
  }
  template <class J, class Visit>
  CHICANE_INLINE static void for_curvatures(const J& r, const Visit& visit) noexcept {
    if constexpr (AnyJet<J>) {
      jet::repeat<J::kSecond.size()>([&](auto n) CHICANE_INLINE {
        constexpr Pair p = members<J::kSecond>()[n];
        visit(std::integral_constant<int, p.i>{}, std::integral_constant<int, p.j>{}, r.curvatures[n]);
      });
    }
  }
  /// entry (+)= a · b
  template <bool IsFirst, class A, class B>
  CHICANE_INLINE static void add(const A& a, const B& b, V& entry) noexcept {
    if constexpr (IsFirst) {
      entry = jet::number<V>(jet::times(a, b));
    } else {
      entry = fused_multiply_add(jet::number<V>(a), jet::number<V>(b), entry);
    }
  }
};

}  // namespace chicane::solver
