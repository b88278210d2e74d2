// SPDX-License-Identifier: MIT
// Jet: a value with its first and second derivatives, whose type says which are not zero. Chain rule by
// types. Derivatives are computed forward, along with the value (automatic differentiation).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "chicane/base/compiler.hpp"
#include "chicane/base/math.hpp"

namespace chicane {

/// A set of the variables of one stage, one bit each: states first, then inputs.
using Variables = std::uint32_t;
/// Limit of the number of variables of a stage; Pairs has 24 · 25 / 2 = 300 bits in five words.
inline constexpr int kMaxVariables = 24;

/// The set of variable `index` alone.
[[nodiscard]] constexpr Variables variable(int index) noexcept { return Variables{1} << index; }
/// The set of variables 0 … count − 1.
[[nodiscard]] constexpr Variables first_variables(int count) noexcept { return variable(count) - 1; }
[[nodiscard]] constexpr bool contains(Variables set, int index) noexcept { return (set >> index & 1U) != 0; }
[[nodiscard]] constexpr int size_of(Variables set) noexcept { return std::popcount(set); }
/// Number of members of the set below `index`: the position at which the entry of `index` is stored.
[[nodiscard]] constexpr std::size_t rank_of(Variables set, int index) noexcept {
  return static_cast<std::size_t>(std::popcount(set & (variable(index) - 1)));
}
/// The member with `rank` lower members: inverse of rank_of().
[[nodiscard]] constexpr int member_of(Variables set, int rank) noexcept {
  for (; rank > 0; --rank) set &= set - 1;
  return std::countr_zero(set);
}

/// A set of unordered pairs of variables: the pattern of a symmetric matrix. Usable as a template argument.
struct Pairs {
  std::array<std::uint64_t, 5> words{};  ///< public, so that the type is structural: use the functions

  /// Bit of the pair (i, j): pairs are numbered by columns of the upper triangle.
  static constexpr int index_of(int i, int j) noexcept {
    return i <= j ? j * (j + 1) / 2 + i : i * (i + 1) / 2 + j;
  }
  [[nodiscard]] constexpr bool contains(int i, int j) const noexcept {
    const auto at = static_cast<unsigned>(index_of(i, j));
    return (words[at / 64] >> (at % 64) & 1U) != 0;
  }
  constexpr void insert(int i, int j) noexcept {
    const auto at = static_cast<unsigned>(index_of(i, j));
    words[at / 64] |= std::uint64_t{1} << (at % 64);
  }
  [[nodiscard]] constexpr int size() const noexcept {
    int sum = 0;
    for (const auto word : words) sum += std::popcount(word);
    return sum;
  }
  /// Number of pairs of the set before (i, j): the position at which its entry is stored.
  [[nodiscard]] constexpr std::size_t rank(int i, int j) const noexcept {
    const auto at = static_cast<unsigned>(index_of(i, j));
    int sum = std::popcount(words[at / 64] & ((std::uint64_t{1} << (at % 64)) - 1));
    for (unsigned w = 0; w < at / 64; ++w) sum += std::popcount(words[w]);
    return static_cast<std::size_t>(sum);
  }
  /// All pairs with one variable of each set.
  static constexpr Pairs of(Variables a, Variables b) noexcept {
    Pairs result;
    for (Variables rest = a; rest != 0; rest &= rest - 1) {
      for (Variables other = b; other != 0; other &= other - 1)
        result.insert(std::countr_zero(rest), std::countr_zero(other));
    }
    return result;
  }
  constexpr Pairs& operator|=(const Pairs& o) noexcept {
    for (std::size_t w = 0; w < words.size(); ++w) words[w] |= o.words[w];
    return *this;
  }
  friend constexpr Pairs operator|(Pairs a, const Pairs& b) noexcept { return a |= b; }
  friend constexpr bool operator==(const Pairs&, const Pairs&) = default;
  /// Whether every pair of this set is in the other one.
  [[nodiscard]] constexpr bool is_within(const Pairs& o) const noexcept { return (*this | o) == o; }
};

/// A pair of variables, i <= j.
struct Pair {
  int i = 0;
  int j = 0;
};

/// The members of a set of pairs in the order of their storage.
template <Pairs Set>
[[nodiscard]] constexpr auto members() noexcept {
  std::array<Pair, static_cast<std::size_t>(Set.size())> result{};
  std::size_t at = 0;
  for (int j = 0; j < kMaxVariables; ++j) {
    for (int i = 0; i <= j; ++i) {
      if (Set.contains(i, j)) result[at++] = {i, j};
    }
  }
  return result;
}

/// A value with its derivatives. Only derivatives that are not zero by construction are stored; the type says
/// which. Sums and products have the types that follow from the rules of calculus, so the sparsity pattern of
/// a problem is read off the return types of its functions, and zeros are never computed. Comparisons see
/// values only. No allocation; everything is inlined.
///
///   V       double, or a pack of doubles with one stage in each lane
///   Order   1: first derivatives; 2: second derivatives, too
///   First   variables with a first derivative
///   Unit    variables of First whose first derivative is exactly 1, which is not stored
///   Second  pairs with a second derivative; none for Order 1
template <class V, int Order, Variables First, Variables Unit = 0, Pairs Second = Pairs{}>
struct Jet {
  static_assert((Unit & ~First) == 0);
  using Value = V;
  static constexpr int kOrder = Order;
  static constexpr Variables kFirst = First;
  static constexpr Variables kUnit = Unit;
  static constexpr Pairs kSecond = Second;
  /// Numbers of stored first and second derivatives.
  static constexpr std::size_t kSlopes = static_cast<std::size_t>(size_of(First & ~Unit));
  static constexpr std::size_t kCurvatures = static_cast<std::size_t>(Second.size());
  /// Whether every derivative by variables 0 … n is stored, so that chain_dense() applies.
  static constexpr bool kIsDense = Unit == 0 && First != 0 && (First & (First + 1)) == 0 &&
                                   (Order < 2 || Second == Pairs::of(First, First));

  V v;                                    ///< value
  std::array<V, kSlopes> slopes;          ///< first derivatives by variable
  std::array<V, kCurvatures> curvatures;  ///< second derivatives by pair, in the order of members<Second>()

  constexpr Jet() noexcept {}  // NOLINT: not initialised, like a plain double
  /// A constant, where all derivatives can be stored as zero.
  template <class S>
  requires(Unit == 0 && std::convertible_to<S, V>) constexpr Jet(
      const S& value)  // NOLINT: constants mix freely with jets, as in formulas
      : v(value) {
    slopes.fill(V(0.0));
    curvatures.fill(V(0.0));
  }
  /// The value and derivatives of a jet that stores fewer; those it lacks become stored zeros.
  template <Variables F, Variables U, Pairs P>
  requires(
      (F & ~First) == 0 && (Unit & ~U) == 0 && P.is_within(Second) &&
      !(F == First && U == Unit &&
        P == Second)) constexpr Jet(const Jet<V, Order, F, U, P>& narrow);  // NOLINT: as safe as int to long

  /// The variable `index` of First with this value: its derivative by itself is 1.
  static constexpr Jet variable(const V& value, int index) requires(Unit == 0) {
    Jet result(value);
    result.slopes[rank_of(First, index)] = V(1.0);
    return result;
  }

  // clang-format off: compilers show the comment
  operator double() const =
      delete;  // NOLINT  a jet is no number: write sin(x), not std::sin(x); auto y = x, not double y = x
  // clang-format on

  constexpr Jet& operator+=(const Jet& o) { return *this = *this + o; }
  constexpr Jet& operator-=(const Jet& o) { return *this = *this - o; }
  constexpr Jet& operator*=(const Jet& o) { return *this = *this * o; }
  constexpr Jet& operator/=(const Jet& o) { return *this = *this / o; }
};

/// A number with its derivatives by N variables, all stored: for code over arrays of one scalar.
template <int N, int Order = 1>
using FullJet = Jet<double, Order, first_variables(N), 0,
                    Order == 2 ? Pairs::of(first_variables(N), first_variables(N)) : Pairs{}>;

/// The variable `Index` with this value: its derivative by itself is 1.
template <int Order, int Index, class V>
[[nodiscard]] constexpr auto seed(const V& value) {
  Jet<V, Order, variable(Index), variable(Index)> result;
  result.v = value;
  return result;
}

/// Whether T is a Jet or a LooseJet (loose_jet.hpp).
template <class T>
inline constexpr bool kIsJet = false;
template <class V, int O, Variables F, Variables U, Pairs S>
inline constexpr bool kIsJet<Jet<V, O, F, U, S>> = true;
template <class T>
concept AnyJet = kIsJet<std::remove_cvref_t<T>>;
/// Arguments of a function of two, of which at least one is a jet.
template <class A, class B>
concept WithJet = AnyJet<A> || AnyJet<B>;
/// A constant beside a jet of type J: a double, or a pack of the jet's values.
template <class S, class J>
concept ConstantFor = !AnyJet<S> && std::convertible_to<S, typename J::Value>;

/// Value without derivatives, as of plain numbers (math.hpp).
template <class V, int O, Variables F, Variables U, Pairs S>
[[nodiscard]] constexpr const V& value_of(const Jet<V, O, F, U, S>& x) noexcept {
  return x.v;
}

namespace jet {

/// Value of a jet; a constant itself.
template <class T>
[[nodiscard]] CHICANE_INLINE inline constexpr const auto& value(const T& x) noexcept {
  if constexpr (AnyJet<T>)
    return x.v;
  else
    return x;
}

/// Derivatives known at compile time: 0, 1 and −1. Products and sums with them cost nothing.
struct Zero {};
struct One {};
struct Minus {};

template <class T>
inline constexpr bool kIsZero = std::is_same_v<T, Zero>;
template <class T>
inline constexpr bool kIsOne = std::is_same_v<T, One>;

/// a · b, of numbers or derivatives known at compile time.
template <class A, class B>
[[nodiscard]] CHICANE_INLINE inline constexpr auto times(const A& a, const B& b) {
  if constexpr (kIsZero<A> || kIsZero<B>)
    return Zero{};
  else if constexpr (kIsOne<A>)
    return b;
  else if constexpr (kIsOne<B>)
    return a;
  else if constexpr (std::is_same_v<A, Minus> && std::is_same_v<B, Minus>)
    return One{};
  else if constexpr (std::is_same_v<A, Minus>)
    return -b;
  else if constexpr (std::is_same_v<B, Minus>)
    return -a;
  else
    return a * b;
}
/// A derivative as a number of type V.
template <class V, class A>
[[nodiscard]] CHICANE_INLINE inline constexpr V number(const A& a) {
  if constexpr (kIsZero<A>)
    return V(0.0);
  else if constexpr (kIsOne<A>)
    return V(1.0);
  else if constexpr (std::is_same_v<A, Minus>)
    return V(-1.0);
  else
    return a;
}
/// a + b, of numbers or derivatives known at compile time.
template <class V, class A, class B>
[[nodiscard]] CHICANE_INLINE inline constexpr auto plus(const A& a, const B& b) {
  if constexpr (kIsZero<A>)
    return b;
  else if constexpr (kIsZero<B>)
    return a;
  else
    return number<V>(a) + number<V>(b);
}

/// First derivative by variable I; Zero or One where the type says so.
template <int I, AnyJet J>
[[nodiscard]] CHICANE_INLINE inline constexpr auto slope(const J& x) {
  if constexpr (!contains(J::kFirst, I))
    return Zero{};
  else if constexpr (contains(J::kUnit, I))
    return One{};
  else
    return x.slopes[rank_of(J::kFirst & ~J::kUnit, I)];
}
/// Second derivative by variables I and K; Zero where the type says so.
template <int I, int K, AnyJet J>
[[nodiscard]] CHICANE_INLINE inline constexpr auto curvature(const J& x) {
  if constexpr (!J::kSecond.contains(I, K))
    return Zero{};
  else
    return x.curvatures[J::kSecond.rank(I, K)];
}

/// Calls visit(std::integral_constant<int, 0>) … visit(…<N − 1>), always unrolled.
template <int N, class Visit>
CHICANE_INLINE inline constexpr void repeat(const Visit& visit) {
  [&]<int... n>(std::integer_sequence<int, n...>) CHICANE_INLINE {
    (visit(std::integral_constant<int, n>{}), ...);
  }
  (std::make_integer_sequence<int, N>{});
}

/// Partial derivatives of an outer function f(a, b): f_a, f_b, f_aa, f_ab, f_bb.
template <class A, class B, class AA, class AB, class BB>
struct Partials {
  A a;
  B b;
  AA aa;
  AB ab;
  BB bb;
};
template <class A, class B, class AA, class AB, class BB>
Partials(A, B, AA, AB, BB) -> Partials<A, B, AA, AB, BB>;

/// Variables by which f(a, b) has the derivative 1: their slope is 1 in one argument, f has the partial
/// derivative 1 by that argument, and the other argument does not depend on them.
template <class PA, class PB, AnyJet A, AnyJet B>
constexpr Variables unit_of() noexcept {
  const Variables in_a = kIsZero<PA> ? 0 : A::kFirst;
  const Variables in_b = kIsZero<PB> ? 0 : B::kFirst;
  return (kIsOne<PA> ? A::kUnit & ~in_b : 0) | (kIsOne<PB> ? B::kUnit & ~in_a : 0);
}
/// Pairs by which f(a, b) has a second derivative.
template <class PA, class PB, class AA, class AB, class BB, AnyJet A, AnyJet B>
constexpr Pairs second_of() noexcept {
  Pairs set;
  if constexpr (!kIsZero<PA>) set |= A::kSecond;
  if constexpr (!kIsZero<PB>) set |= B::kSecond;
  if constexpr (!kIsZero<AA>) set |= Pairs::of(A::kFirst, A::kFirst);
  if constexpr (!kIsZero<AB>) set |= Pairs::of(A::kFirst, B::kFirst);
  if constexpr (!kIsZero<BB>) set |= Pairs::of(B::kFirst, B::kFirst);
  return set;
}

/// Chain rule for f(a, b) of jets that store everything: plain loops, quick to compile. `value` is f(a, b).
template <AnyJet A, class PA, class PB, class AA, class AB, class BB>
[[nodiscard]] CHICANE_INLINE inline constexpr A chain_dense(const A& a, const A& b,
                                                            const typename A::Value& value,
                                                            const Partials<PA, PB, AA, AB, BB>& f) {
  using V = typename A::Value;
  constexpr std::size_t count = A::kSlopes;
  A r;
  r.v = value;
  for (std::size_t i = 0; i < count; ++i)
    r.slopes[i] = number<V>(plus<V>(times(f.a, a.slopes[i]), times(f.b, b.slopes[i])));
  if constexpr (A::kOrder == 2) {
    std::size_t at = 0;
    for (std::size_t j = 0; j < count; ++j) {
      const auto aj = plus<V>(times(f.aa, a.slopes[j]), times(f.ab, b.slopes[j]));
      const auto bj = plus<V>(times(f.bb, b.slopes[j]), times(f.ab, a.slopes[j]));
      for (std::size_t i = 0; i <= j; ++i, ++at) {
        const auto inner = plus<V>(times(f.a, a.curvatures[at]), times(f.b, b.curvatures[at]));
        r.curvatures[at] = number<V>(plus<V>(inner, plus<V>(times(aj, a.slopes[i]), times(bj, b.slopes[i]))));
      }
    }
  }
  return r;
}

/// Chain rule for f(a, b) of jets of any types: each stored derivative on its own. `value` is f(a, b).
template <AnyJet A, AnyJet B, class PA, class PB, class AA, class AB, class BB>
[[nodiscard]] CHICANE_INLINE inline constexpr auto chain_sparse(const A& a, const B& b,
                                                                const typename A::Value& value,
                                                                const Partials<PA, PB, AA, AB, BB>& f) {
  using V = typename A::Value;
  constexpr Variables first = (kIsZero<PA> ? 0 : A::kFirst) | (kIsZero<PB> ? 0 : B::kFirst);
  constexpr Variables unit = unit_of<PA, PB, A, B>();
  constexpr Pairs second = [] {
    if constexpr (A::kOrder == 2)
      return second_of<PA, PB, AA, AB, BB, A, B>();
    else
      return Pairs{};
  }();
  Jet<V, A::kOrder, first, unit, second> r;
  r.v = value;
  repeat<size_of(first & ~unit)>([&](auto n) CHICANE_INLINE {
    constexpr int i = member_of(first & ~unit, n);
    r.slopes[n] = number<V>(plus<V>(times(f.a, slope<i>(a)), times(f.b, slope<i>(b))));
  });
  repeat<second.size()>([&](auto n) CHICANE_INLINE {
    constexpr Pair p = members<second>()[n];
    const auto ai = slope<p.i>(a);
    const auto ak = slope<p.j>(a);
    const auto bi = slope<p.i>(b);
    const auto bk = slope<p.j>(b);
    const auto inner = plus<V>(times(f.a, curvature<p.i, p.j>(a)), times(f.b, curvature<p.i, p.j>(b)));
    const auto own = plus<V>(times(f.aa, times(ai, ak)), times(f.bb, times(bi, bk)));
    const auto mixed = times(f.ab, plus<V>(times(ai, bk), times(ak, bi)));
    r.curvatures[n] = number<V>(plus<V>(plus<V>(inner, own), mixed));
  });
  return r;
}

/// Chain rule for f(a, b). `value` is f(a, b).
template <AnyJet A, AnyJet B, class PA, class PB, class AA, class AB, class BB>
[[nodiscard]] CHICANE_INLINE inline constexpr auto chain(const A& a, const B& b,
                                                         const typename A::Value& value,
                                                         const Partials<PA, PB, AA, AB, BB>& f) {
  if constexpr (std::is_same_v<A, B> && A::kIsDense) {
    return chain_dense(a, b, value, f);
  } else {
    return chain_sparse(a, b, value, f);
  }
}

/// Chain rule for f(a). `value` is f(a), `slope` f' and `curvature` f''.
template <AnyJet A, class Slope, class Curvature>
[[nodiscard]] CHICANE_INLINE inline constexpr auto chain(const A& a, const typename A::Value& value,
                                                         const Slope& slope, const Curvature& curvature) {
  const Partials f{slope, Zero{}, curvature, Zero{}, Zero{}};
  if constexpr (A::kIsDense) {
    return chain_dense(a, a, value, f);
  } else {
    return chain_sparse(a, Jet<typename A::Value, A::kOrder, 0>{}, value, f);
  }
}

}  // namespace jet

template <class V, int Order, Variables First, Variables Unit, Pairs Second>
template <Variables F, Variables U, Pairs P>
requires((F & ~First) == 0 && (Unit & ~U) == 0 && P.is_within(Second) &&
         !(F == First && U == Unit && P == Second))
    CHICANE_INLINE constexpr Jet<V, Order, First, Unit, Second>::Jet(const Jet<V, Order, F, U, P>& narrow)
    : v(narrow.v) {
  jet::repeat<size_of(First & ~Unit)>([&](auto n) CHICANE_INLINE {
    constexpr int i = member_of(First & ~Unit, n);
    slopes[n] = jet::number<V>(jet::slope<i>(narrow));
  });
  jet::repeat<Second.size()>([&](auto n) CHICANE_INLINE {
    constexpr Pair p = members<Second>()[n];
    curvatures[n] = jet::number<V>(jet::curvature<p.i, p.j>(narrow));
  });
}

}  // namespace chicane
