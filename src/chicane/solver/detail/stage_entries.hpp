// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

#include "chicane/base/compiler.hpp"
#include "chicane/base/jet.hpp"
#include "chicane/base/pack.hpp"
#include "chicane/solver/detail/pattern.hpp"
#include "chicane/solver/problem.hpp"
#include "chicane/solver/sparse_row.hpp"

namespace chicane::solver {

// From a problem's functions to its quadratic program: the pattern, and the sums of jets into entries of
// stages.

/// Position of variable `i` of (x, u) in z = (x, 1, u).
template <class P>
constexpr std::size_t in_z(int i) noexcept {
  return static_cast<std::size_t>(i < P::kNx ? i : i + 1);
}

/// Jet that stores every derivative of a stage: the scalar of level 1.
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
  static constexpr Pairs squares() noexcept {  // pairs in squares of residuals: JᵀJ
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

/// Whether the solver uses second derivatives of the problem: not with `kGaussNewton = true`, which compiles
/// in a fraction of the time.
template <class P>
[[nodiscard]] constexpr bool has_hessians() noexcept {
  if constexpr (requires { P::kGaussNewton; }) return !P::kGaussNewton;
  return true;
}

/// Whether second derivatives cost little more than the first, as in structured problems and sparse rows.
template <class P>
[[nodiscard]] constexpr bool has_cheap_curvature() noexcept {
  return StructuredProblem<P> || kHasSparseRows<P>;
}

/// Whether the solver has the filter method for this problem: not with `kRealTime = true`, for budgets of a
/// few iterations.
template <class P>
[[nodiscard]] constexpr bool has_filter_method() noexcept {
  if constexpr (requires { P::kRealTime; }) return !P::kRealTime;
  return true;
}

/// Entries of a structured problem's quadratic programs that can differ from zero, read off the types that
/// its functions return.
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

/// Pattern in which every entry counts.
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

template <class Row>
inline constexpr bool kIsDenseRow = false;
template <class J, std::size_t N>
requires requires { J::kIsDense; }
inline constexpr bool kIsDenseRow<std::array<J, N>> = J::kIsDense;

/// Calls visit(n, jet) for each result of a problem's function. n is a constant for a tuple, and a number for
/// an array whose jets store everything, because loops compile faster.
template <class V, int Order, class Row, class Visit>
CHICANE_INLINE inline void each_row(const Row& row, const Visit& visit) noexcept {
  constexpr std::size_t count = std::tuple_size_v<Row>;
  if constexpr (count == 0) {
    return;
  } else if constexpr (kIsDenseRow<Row>) {
    for (std::size_t n = 0; n < count; ++n) {
      if constexpr (AnySparseRow<typename Row::value_type>) {
        if (row[n].is_absent()) continue;
      }
      visit(n, row[n]);
    }
  } else {
    unroll<count>([&](auto n) CHICANE_INLINE { visit(n, as_jet<V, Order>(std::get<n>(row))); });
  }
}

/// Calls visit(j, slope) for each variable that a result depends on, or for all if its type does not name
/// them.
template <class V, class J, class Visit>
CHICANE_INLINE inline void each_slope(const J& row, const Visit& visit) noexcept {
  if constexpr (AnySparseRow<J>) {
    row.each_slope(visit);
  } else if constexpr (AnyJet<J> && !AnyLooseJet<J>) {
    jet::repeat<size_of(J::kFirst)>([&](auto n) CHICANE_INLINE {
      constexpr int j = member_of(J::kFirst, n);
      visit(static_cast<std::size_t>(j), jet::number<V>(jet::slope<j>(row)));
    });
  } else {
    for (std::size_t j = 0; j < row.slopes.size(); ++j) visit(j, row.slopes[j]);
  }
}

/// Sums of the entries of eight stages of the quadratic program, as packs over the stages, for dense
/// problems.
template <OcpProblem P, class V>
struct StageEntries {
  static constexpr std::size_t kVariables = static_cast<std::size_t>(P::kNx + P::kNu);
  using Layout = solver::Layout<ProblemPattern<P>>;
  using Jacobians = std::array<V, Layout::kFCount>;
  using Costs = std::array<V, Layout::kLCount>;
  using Gradient = std::array<V, kVariables>;  ///< gradient of the stage cost with the current multipliers

  static constexpr std::size_t z(std::size_t i) noexcept { return i < P::kNx ? i : i + 1; }
  static_assert(Layout::kFCount == Layout::kNx * Layout::kNz, "every entry is stored, row after row");

  /// Sets row i of the Jacobian and its defect.
  template <class J>
  static void set_jacobian(std::size_t i, const J& row, const V& defect, Jacobians& f) noexcept {
    V* const to = f.data() + i * Layout::kNz;
    if constexpr (AnySparseRow<J>) std::fill(to, to + Layout::kNz, V(0.0));
    each_slope<V>(row, [&](std::size_t j, const V& slope) CHICANE_INLINE { to[z(j)] = slope; });
    to[Layout::kOne] = defect;
  }
  template <class Rows>
  static void clear(Gradient& gradient, Costs& l) noexcept {
    gradient.fill(V(0.0));
    l.fill(V(0.0));
  }
  /// gradient += weight · dr
  template <class Rows, class J>
  static void add_gradient(std::size_t, const J& r, const V& weight, Gradient& gradient) noexcept {
    each_slope<V>(r, [&](std::size_t i, const V& slope) CHICANE_INLINE { gradient[i] += weight * slope; });
  }
  /// l += weight · drᵀ dr, over the variables that the row depends on in any of the eight stages.
  template <class Rows, class J>
  static void add_square(std::size_t, const J& r, const V& weight, Costs& l) noexcept {
    if constexpr (AnySparseRow<J>) {
      r.each_slope([&](std::size_t j, const V& slope) CHICANE_INLINE {
        const V scaled = weight * slope;
        r.each_slope([&](std::size_t i, const V& other) CHICANE_INLINE {
          if (i <= j) l[Layout::kL[z(i)][z(j)]] += scaled * other;
        });
      });
    } else {
      add_full_square(r, weight, l);
    }
  }
  template <class J>
  static void add_full_square(const J& r, const V& weight, Costs& l) noexcept {
    std::size_t present[kVariables];
    std::size_t count = 0;
    for (std::size_t j = 0; j < kVariables; ++j) {
      if (all(r.slopes[j] == V(0.0))) continue;
      present[count++] = j;
      const V scaled = weight * r.slopes[j];
      for (std::size_t n = 0; n < count; ++n)
        l[Layout::kL[z(present[n])][z(j)]] += scaled * r.slopes[present[n]];
    }
  }
  static void set_gradient(const Gradient& gradient, Costs& l) noexcept {
    for (std::size_t i = 0; i < kVariables; ++i) l[Layout::kL[z(i)][Layout::kOne]] = gradient[i];
  }
  template <class J>
  static void add_to_gradient(const J& r, const V& weight, Costs& l) noexcept {
    each_slope<V>(r, [&](std::size_t i, const V& slope)
                         CHICANE_INLINE { l[Layout::kL[z(i)][Layout::kOne]] += weight * slope; });
  }
  /// l += weight · ddr
  template <class J>
  static void add_curvature(const J& r, const V& weight, Costs& l) noexcept {
    if constexpr (AnySparseRow<J>) {
      r.each_curvature([&](std::size_t i, std::size_t j, const V& curvature)
                           CHICANE_INLINE { l[Layout::kL[z(i)][z(j)]] += weight * curvature; });
    } else {
      std::size_t at = 0;
      for (std::size_t j = 0; j < kVariables; ++j) {
        for (std::size_t i = 0; i <= j; ++i, ++at) l[Layout::kL[z(i)][z(j)]] += weight * r.curvatures[at];
      }
    }
  }
};

/// Sums of the entries of eight stages for structured problems: entries that are zero by type are absent, and
/// the first row with an entry sets it.
template <StructuredProblem P, class V>
struct StageEntries<P, V> {
  static constexpr int kVariables = P::kNx + P::kNu;
  using Layout = solver::Layout<ProblemPattern<P>>;
  using Jacobians = std::array<V, Layout::kFCount>;
  using Costs = std::array<V, Layout::kLCount>;
  using Gradient = std::array<V, static_cast<std::size_t>(kVariables)>;

  template <std::size_t I, class J>
  CHICANE_INLINE static void set_jacobian(std::integral_constant<std::size_t, I>, const J& row,
                                          const V& defect, Jacobians& f) noexcept {
    jet::repeat<kVariables>([&](auto j) CHICANE_INLINE {
      constexpr std::size_t entry = Layout::kF[I][in_z<P>(j)];
      if constexpr (entry != Layout::kNone) f[entry] = jet::number<V>(jet::slope<j>(row));
    });
    f[Layout::kF[I][Layout::kOne]] = defect;
  }
  /// Sets entries to zero that no row of `Rows` has.
  template <class Rows>
  CHICANE_INLINE static void clear(Gradient& gradient, Costs& l) noexcept {
    using Sets = detail::RowSets<Rows>;
    jet::repeat<kVariables>([&](auto j) CHICANE_INLINE {
      if constexpr (Sets::first_with(j) < 0) gradient[j] = V(0.0);
      jet::repeat<j + 1>([&](auto i) CHICANE_INLINE {
        constexpr std::size_t entry = Layout::kL[in_z<P>(i)][in_z<P>(j)];
        if constexpr (entry != Layout::kNone && Sets::first_with(i, j) < 0) l[entry] = V(0.0);
      });
    });
  }
  template <class Rows, class N, class J>
  CHICANE_INLINE static void add_gradient(N, const J& r, const V& weight, Gradient& gradient) noexcept {
    for_slopes(r, [&](auto i, const auto& slope) CHICANE_INLINE {
      const V share = jet::number<V>(jet::times(weight, slope));
      gradient[i] = is_first<Rows, N>(i, i) ? share : gradient[i] + share;
    });
  }
  template <class Rows, class N, class J>
  CHICANE_INLINE static void add_square(N, const J& r, const V& weight, Costs& l) noexcept {
    for_slopes(r, [&](auto j, const auto& slope_j) CHICANE_INLINE {
      const V scaled = jet::number<V>(jet::times(weight, slope_j));
      for_slopes(r, [&](auto i, const auto& slope_i) CHICANE_INLINE {
        if constexpr (i <= j) {
          V& entry = l[Layout::kL[in_z<P>(i)][in_z<P>(j)]];
          const V share = jet::number<V>(jet::times(scaled, slope_i));
          entry = is_first<Rows, N>(i, j) ? share : entry + share;
        }
      });
    });
  }
  CHICANE_INLINE static void set_gradient(const Gradient& gradient, Costs& l) noexcept {
    jet::repeat<kVariables>([&](auto i) CHICANE_INLINE {
      constexpr std::size_t entry = Layout::kL[in_z<P>(i)][Layout::kOne];
      if constexpr (entry != Layout::kNone) l[entry] = gradient[i];
    });
  }
  template <class J>
  CHICANE_INLINE static void add_to_gradient(const J& r, const V& weight, Costs& l) noexcept {
    for_slopes(r, [&](auto i, const auto& slope) CHICANE_INLINE {
      l[Layout::kL[in_z<P>(i)][Layout::kOne]] += jet::number<V>(jet::times(weight, slope));
    });
  }
  template <class J>
  CHICANE_INLINE static void add_curvature(const J& r, const V& weight, Costs& l) noexcept {
    jet::repeat<J::kSecond.size()>([&](auto n) CHICANE_INLINE {
      constexpr Pair p = members<J::kSecond>()[n];
      l[Layout::kL[in_z<P>(p.i)][in_z<P>(p.j)]] += weight * r.curvatures[n];
    });
  }

 private:
  template <class J, class Visit>
  CHICANE_INLINE static void for_slopes(const J& r, const Visit& visit) noexcept {
    jet::repeat<size_of(J::kFirst)>([&](auto n) CHICANE_INLINE {
      constexpr int i = member_of(J::kFirst, n);
      visit(std::integral_constant<int, i>{}, jet::slope<i>(r));
    });
  }
  /// Whether row N is the first of `Rows` with variables i and j. False for rows that only add (Rows = void).
  template <class Rows, class N>
  static constexpr bool is_first(int i, int j) noexcept {
    if constexpr (std::is_void_v<Rows>) {
      return false;
    } else {
      return detail::RowSets<Rows>::first_with(i, j) == static_cast<int>(N::value);
    }
  }
};

}  // namespace chicane::solver
