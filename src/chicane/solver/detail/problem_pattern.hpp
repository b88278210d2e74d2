// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <tuple>
#include <utility>

#include "chicane/base/compiler.hpp"
#include "chicane/base/jet.hpp"
#include "chicane/base/pack.hpp"
#include "chicane/solver/detail/pattern.hpp"
#include "chicane/solver/problem.hpp"
#include "chicane/solver/sparse_row.hpp"

namespace chicane::solver {

/// Position of variable `i` of (x, u) in z = (x, 1, u).
template <class P>
constexpr std::size_t in_z(int i) noexcept {
  return static_cast<std::size_t>(i < P::kNx ? i : i + 1);
}

/// The jet that stores every derivative of a stage: what problems of level 1 are called with.
template <class P, class V, int Order>
using DenseJet =
    Jet<V, Order, first_variables(P::kNx + P::kNu), 0,
        Order == 2 ? Pairs::of(first_variables(P::kNx + P::kNu), first_variables(P::kNx + P::kNu)) : Pairs{}>;

/// A result of a problem's functions as a jet: constants have no derivatives.
template <class V, int Order, class T>
[[nodiscard]] CHICANE_INLINE inline decltype(auto) as_jet(const T& value) {
  if constexpr (AnyJet<T>) {
    return (value);
  } else {
    return Jet<V, Order, 0>(value);
  }
}

namespace detail {

/// The patterns of all rows of a result.
template <class... J>
struct JetSets {
  static constexpr std::array<Variables, sizeof...(J)> kFirst{J::kFirst...};
  static constexpr std::array<Variables, sizeof...(J)> kUnit{J::kUnit...};
  static constexpr Pairs squares() noexcept {  // of residuals: JᵀJ
    Pairs set;
    ((set |= Pairs::of(J::kFirst, J::kFirst)), ...);
    return set;
  }
  static constexpr Pairs second() noexcept {
    Pairs set;
    ((set |= J::kSecond), ...);
    return set;
  }
  /// The first row with variable i, or with i and j; -1 when there is none.
  static constexpr int first_with(int i) noexcept { return first_with(i, i); }
  static constexpr int first_with(int i, int j) noexcept {
    for (std::size_t n = 0; n < sizeof...(J); ++n) {
      if (contains(kFirst[n], i) && contains(kFirst[n], j)) return static_cast<int>(n);
    }
    return -1;
  }
  static constexpr Variables first() noexcept { return (J::kFirst | ... | Variables{0}); }
};
template <class T>
using JetOf = std::remove_cvref_t<decltype(as_jet<Pack<arch::Baseline, 2>, 2>(std::declval<const T&>()))>;
template <class Row, class Sequence = std::make_index_sequence<std::tuple_size_v<Row>>>
struct RowSets;
template <class Row, std::size_t... n>
struct RowSets<Row, std::index_sequence<n...>> : JetSets<JetOf<std::tuple_element_t<n, Row>>...> {};

}  // namespace detail

/// Whether the solver knows second derivatives of the problem: unless it says `kGaussNewton = true`, to be
/// built in a fraction of the time where exact Hessians are not wanted.
template <class P>
[[nodiscard]] constexpr bool has_hessians() noexcept {
  if constexpr (requires { P::kGaussNewton; }) return !P::kGaussNewton;
  return true;
}

/// Whether second derivatives cost little beside the first: those of structured problems and of sparse rows.
template <class P>
[[nodiscard]] constexpr bool has_cheap_curvature() noexcept {
  return StructuredProblem<P> || kHasSparseRows<P>;
}

/// Whether the solver has the filter method for this problem: unless it says `kRealTime = true`, for budgets
/// of a few iterations.
template <class P>
[[nodiscard]] constexpr bool has_filter_method() noexcept {
  if constexpr (requires { P::kRealTime; }) return !P::kRealTime;
  return true;
}

/// Which entries of the stages of its quadratic programs a structured problem can make other than zero, read
/// off the types that its functions return.
template <StructuredProblem P>
struct StructuredPattern {
  static constexpr std::size_t kNx = P::kNx;
  static constexpr std::size_t kNu = P::kNu;
  static constexpr std::size_t kNz = kNx + 1 + kNu;
  using V = Pack<arch::Baseline, 2>;
  using X = StateJets<P, V, has_hessians<P>() ? 2 : 1>;
  using U = InputJets<P, V, has_hessians<P>() ? 2 : 1>;
  using Next = decltype(std::declval<const P&>().dynamics(0, X{}, U{}));
  using Residual = decltype(std::declval<const P&>().residual(0, X{}, U{}));
  static constexpr auto constraint_type() {
    if constexpr (P::kNc > 0) {
      return std::type_identity<decltype(std::declval<const P&>().constraint(0, X{}, U{}))>{};
    } else {
      return std::type_identity<std::tuple<>>{};
    }
  }
  using Constraint = typename decltype(constraint_type())::type;

  static constexpr bool kIsCompact = has_filter_method<P>();
  static constexpr auto kF = [] {
    std::array<std::array<Entry, kNz>, kNx> f{};
    for (std::size_t i = 0; i < kNx; ++i) {
      for (int j = 0; j < P::kNx + P::kNu; ++j) {
        if (!contains(detail::RowSets<Next>::kFirst[i], j)) continue;
        f[i][in_z<P>(j)] = contains(detail::RowSets<Next>::kUnit[i], j) ? Entry::kOne : Entry::kValue;
      }
      f[i][kNx] = Entry::kValue;
    }
    return f;
  }();
  static constexpr auto kL = [] {
    const Pairs pairs = detail::RowSets<Residual>::squares() | detail::RowSets<Constraint>::squares() |
                        detail::RowSets<Next>::second() | detail::RowSets<Residual>::second() |
                        detail::RowSets<Constraint>::second();
    const Variables first = detail::RowSets<Residual>::first() | detail::RowSets<Constraint>::first();
    std::array<std::array<bool, kNz>, kNz> l{};
    for (int i = 0; i < P::kNx + P::kNu; ++i) {
      for (int j = 0; j < P::kNx + P::kNu; ++j) l[in_z<P>(i)][in_z<P>(j)] = pairs.contains(i, j);
      l[in_z<P>(i)][kNx] = l[kNx][in_z<P>(i)] = contains(first, i);
    }
    for (std::size_t m = 0; m < kNu && has_filter_method<P>();
         ++m) {  // barriers of bounds (filter_slacks.hpp)
      const std::size_t u = kNx + 1 + m;
      l[u][u] = l[u][kNx] = l[kNx][u] = true;
    }
    return l;
  }();
};

/// Every entry counts.
template <OcpProblem P>
struct DensePattern : FullPattern<P::kNx, P::kNu> {
  static constexpr bool kIsCompact =
      has_filter_method<P>() || static_cast<std::size_t>(P::kNx + P::kNu) > kMostUnrolled;
};

namespace detail {
template <class P>
struct PatternOf {
  using Type = DensePattern<P>;
};
template <StructuredProblem P>
struct PatternOf<P> {
  using Type = StructuredPattern<P>;
};
}  // namespace detail

/// The pattern of any problem; a dense one for level 1.
template <OcpProblem P>
using ProblemPattern = typename detail::PatternOf<P>::Type;

}  // namespace chicane::solver
