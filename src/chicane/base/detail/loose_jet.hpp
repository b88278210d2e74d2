// SPDX-License-Identifier: MIT
// LooseJet: a second-order jet (jet_rules.hpp) whose value, not its type, says which derivatives are not
// zero.
#pragma once

#include <array>
#include <bit>
#include <concepts>
#include <cstddef>

#include "chicane/base/compiler.hpp"
#include "chicane/base/detail/jet_rules.hpp"

namespace chicane {

/// A number with its first and second derivatives by `Count` variables (a jet of second order). The members
/// `first` and `second` say which derivatives may differ from zero, so that all values of a function over
/// arrays of one scalar have one type. Only derivatives in those sets are computed and copied; results have
/// the bits of a Jet that stores everything.
template <class V, int Count>
struct LooseJet {
  using Value = V;
  static constexpr int kOrder = 2;
  static constexpr Variables kFirst = first_variables(Count);
  static constexpr Variables kUnit = 0;
  static constexpr Pairs kSecond = Pairs::of(kFirst, kFirst);
  static constexpr std::size_t kSlopes = Count;
  static constexpr std::size_t kCurvatures = Count * (Count + 1) / 2;
  static constexpr bool kIsDense = true;  ///< derivatives are visited by loops
  static constexpr bool kIsSparse =
      true;                               ///< has each_slope() and each_curvature(), as solver/sparse_row.hpp
  static constexpr bool kIsLoose = true;  ///< tells LooseJet from Jet

  V v;                            ///< value
  Variables first = 0;            ///< variables with a slope; other slopes are stored zeros
  Variables second = 0;           ///< variables whose pairs have a curvature; others are uninitialised
  std::array<V, kSlopes> slopes;  ///< one for each variable
  std::array<V, kCurvatures> curvatures;  ///< one for each pair, in the order of members<kSecond>()

  LooseJet() noexcept {}  // NOLINT: not initialised, like a plain double
  template <class S>
  requires(std::convertible_to<S, V>) LooseJet(const S& value)  // NOLINT: constants mix freely with jets
      : v(value) {
    slopes.fill(V(0.0));
  }
  LooseJet(const LooseJet& o) noexcept { *this = o; }  // NOLINT: members are initialised by the assignment
  /// Copies the curvatures of `second` alone, or all in one go.
  LooseJet& operator=(const LooseJet& o) noexcept {
    v = o.v;
    first = o.first;
    second = o.second;
    slopes = o.slopes;
    if (is_full()) {
      curvatures = o.curvatures;
      return *this;
    }
    each_row(second, [&](std::size_t) CHICANE_INLINE {
      return [&](std::size_t, std::size_t at) CHICANE_INLINE { curvatures[at] = o.curvatures[at]; };
    });
    return *this;
  }
  /// The variable `index` with this value: its derivative by itself is 1.
  static LooseJet variable(const V& value, int index) noexcept {
    LooseJet result(value);
    result.first = chicane::variable(index);
    result.slopes[static_cast<std::size_t>(index)] = V(1.0);
    return result;
  }
  // clang-format off: compilers show the comment
  operator double() const =
      delete;  // NOLINT  a jet is no number: write sin(x), not std::sin(x); auto y = x, not double y = x
  // clang-format on

  LooseJet& operator+=(const LooseJet& o) { return *this = *this + o; }
  LooseJet& operator-=(const LooseJet& o) { return *this = *this - o; }
  LooseJet& operator*=(const LooseJet& o) { return *this = *this * o; }
  LooseJet& operator/=(const LooseJet& o) { return *this = *this / o; }

  /// Answer of rows without content (solver/sparse_row.hpp), which a LooseJet never is.
  [[nodiscard]] static constexpr bool is_absent() noexcept { return false; }
  /// Calls visit(i, first derivative) for each variable i of `first`.
  template <class Visit>
  CHICANE_INLINE void each_slope(const Visit& visit) const noexcept {
    for (Variables rest = first; rest != 0; rest &= rest - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(rest));
      visit(i, slopes[i]);
    }
  }
  /// Calls visit(i, j, second derivative) for each pair i <= j of `second`.
  template <class Visit>
  CHICANE_INLINE void each_curvature(const Visit& visit) const noexcept {
    each_row(second, [&](std::size_t j) CHICANE_INLINE {
      return [&, j](std::size_t i, std::size_t at) CHICANE_INLINE { visit(i, j, curvatures[at]); };
    });
  }
  /// Calls visit(j)(i, index in `curvatures`) for each pair i <= j of the set.
  template <class Visit>
  CHICANE_INLINE static void each_row(Variables set, const Visit& visit) noexcept {
    for (Variables rest = set; rest != 0; rest &= rest - 1) {
      const auto j = static_cast<std::size_t>(std::countr_zero(rest));
      const auto visit_pair = visit(j);
      for (Variables below = set & ((Variables{2} << j) - 1); below != 0; below &= below - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(below));
        visit_pair(i, j * (j + 1) / 2 + i);
      }
    }
  }
  /// Calls visit(j)(i, index in `curvatures`) for all pairs i <= j, in loops of fixed length.
  template <class Visit>
  CHICANE_INLINE static void each_row(const Visit& visit) noexcept {
    std::size_t at = 0;
    for (std::size_t j = 0; j < kSlopes; ++j) {
      const auto visit_pair = visit(j);
      for (std::size_t i = 0; i <= j; ++i, ++at) visit_pair(i, at);
    }
  }
  /// Whether every pair has a curvature.
  [[nodiscard]] bool is_full() const noexcept { return second == kFirst; }
  /// Variables that have a curvature with j.
  [[nodiscard]] Variables partners(std::size_t j) const noexcept {
    return contains(second, static_cast<int>(j)) ? second : 0;
  }
};

template <class V, int Count>
inline constexpr bool kIsJet<LooseJet<V, Count>> = true;
template <class T>
concept AnyLooseJet = AnyJet<T> && requires {
  requires std::remove_cvref_t<T>::kIsLoose;
};
template <class V, int Count>
[[nodiscard]] constexpr const V& value_of(const LooseJet<V, Count>& x) noexcept {
  return x.v;
}

namespace jet {

/// Chain rule for f(a, b). `value` is f(a, b), `f` has its partial derivatives. Jets with all pairs take
/// loops of fixed length, which compilers vectorise; others visit the pairs of their sets.
template <AnyLooseJet A, class PA, class PB, class AA, class AB, class BB>
[[nodiscard]] inline A chain(const A& a, const A& b, const typename A::Value& value,
                             const Partials<PA, PB, AA, AB, BB>& f) {
  using V = typename A::Value;
  A r;
  r.v = value;
  r.first = a.first | b.first;
  r.second = a.second | b.second;
  if constexpr (!kIsZero<AA>) r.second |= a.first;
  if constexpr (!kIsZero<AB>) r.second |= a.first | b.first;
  if constexpr (!kIsZero<BB>) r.second |= b.first;
  for (std::size_t i = 0; i < A::kSlopes; ++i)
    r.slopes[i] = number<V>(plus<V>(times(f.a, a.slopes[i]), times(f.b, b.slopes[i])));
  if (a.is_full() && b.is_full()) {
    A::each_row([&](std::size_t j) CHICANE_INLINE {
      const auto aj = plus<V>(times(f.aa, a.slopes[j]), times(f.ab, b.slopes[j]));
      const auto bj = plus<V>(times(f.bb, b.slopes[j]), times(f.ab, a.slopes[j]));
      return [&, aj, bj](std::size_t i, std::size_t at) CHICANE_INLINE {
        const auto inner = plus<V>(times(f.a, a.curvatures[at]), times(f.b, b.curvatures[at]));
        r.curvatures[at] = number<V>(plus<V>(inner, plus<V>(times(aj, a.slopes[i]), times(bj, b.slopes[i]))));
      };
    });
    return r;
  }
  const V zero(0.0);
  A::each_row(r.second, [&](std::size_t j) CHICANE_INLINE {
    const auto aj = plus<V>(times(f.aa, a.slopes[j]), times(f.ab, b.slopes[j]));
    const auto bj = plus<V>(times(f.bb, b.slopes[j]), times(f.ab, a.slopes[j]));
    const Variables in_a = a.partners(j), in_b = b.partners(j);
    return [&, aj, bj, in_a, in_b](std::size_t i, std::size_t at) CHICANE_INLINE {
      const V& own_a = *((in_a >> i & 1U) != 0 ? &a.curvatures[at] : &zero);
      const V& own_b = *((in_b >> i & 1U) != 0 ? &b.curvatures[at] : &zero);
      const auto inner = plus<V>(times(f.a, own_a), times(f.b, own_b));
      r.curvatures[at] = number<V>(plus<V>(inner, plus<V>(times(aj, a.slopes[i]), times(bj, b.slopes[i]))));
    };
  });
  return r;
}
/// Chain rule for f(a, b) where one argument is a constant.
template <AnyLooseJet A, AnyJet B, class PA, class PB, class AA, class AB, class BB>
requires(B::kFirst == 0) [[nodiscard]] inline A
    chain(const A& a, const B& b, const typename A::Value& value, const Partials<PA, PB, AA, AB, BB>& f) {
  return chain(a, A(b.v), value, f);
}
template <AnyJet A, AnyLooseJet B, class PA, class PB, class AA, class AB, class BB>
requires(A::kFirst == 0) [[nodiscard]] inline B
    chain(const A& a, const B& b, const typename A::Value& value, const Partials<PA, PB, AA, AB, BB>& f) {
  return chain(B(a.v), b, value, f);
}
/// Chain rule for f(a). `value` is f(a), `slope` f' and `curvature` f''.
template <AnyLooseJet A, class Slope, class Curvature>
[[nodiscard]] inline A chain(const A& a, const typename A::Value& value, const Slope& slope,
                             const Curvature& curvature) {
  using V = typename A::Value;
  A r;
  r.v = value;
  r.first = a.first;
  r.second = a.second;
  if constexpr (!kIsZero<Curvature>) r.second |= a.first;
  for (std::size_t i = 0; i < A::kSlopes; ++i) r.slopes[i] = number<V>(times(slope, a.slopes[i]));
  if (a.is_full()) {
    A::each_row([&](std::size_t j) CHICANE_INLINE {
      const auto aj = times(curvature, a.slopes[j]);
      return [&, aj](std::size_t i, std::size_t at) CHICANE_INLINE {
        r.curvatures[at] = number<V>(plus<V>(times(slope, a.curvatures[at]), times(aj, a.slopes[i])));
      };
    });
    return r;
  }
  const V zero(0.0);
  A::each_row(r.second, [&](std::size_t j) CHICANE_INLINE {
    const auto aj = times(curvature, a.slopes[j]);
    const Variables in_a = a.partners(j);
    return [&, aj, in_a](std::size_t i, std::size_t at) CHICANE_INLINE {
      const V& own = *((in_a >> i & 1U) != 0 ? &a.curvatures[at] : &zero);
      r.curvatures[at] = number<V>(plus<V>(times(slope, own), times(aj, a.slopes[i])));
    };
  });
  return r;
}

}  // namespace jet

/// `a` where the mask is set, else `b`, each with its derivatives.
template <class M, AnyLooseJet A>
[[nodiscard]] inline A select(const M& mask, const A& a, const A& b) {
  using V = typename A::Value;
  A r;
  r.v = select(mask, a.v, b.v);
  r.first = a.first | b.first;
  r.second = a.second | b.second;
  for (std::size_t i = 0; i < A::kSlopes; ++i) r.slopes[i] = select(mask, a.slopes[i], b.slopes[i]);
  const V zero(0.0);
  A::each_row(r.second, [&](std::size_t j) CHICANE_INLINE {
    const Variables in_a = a.partners(j), in_b = b.partners(j);
    return [&, in_a, in_b](std::size_t i, std::size_t at) CHICANE_INLINE {
      const V& own_a = *((in_a >> i & 1U) != 0 ? &a.curvatures[at] : &zero);
      const V& own_b = *((in_b >> i & 1U) != 0 ? &b.curvatures[at] : &zero);
      r.curvatures[at] = select(mask, own_a, own_b);
    };
  });
  return r;
}
template <class M, AnyLooseJet A, ConstantFor<A> S>
[[nodiscard]] inline A select(const M& mask, const A& a, const S& b) {
  return select(mask, a, A(b));
}
template <class M, AnyLooseJet A, ConstantFor<A> S>
[[nodiscard]] inline A select(const M& mask, const S& b, const A& a) {
  return select(mask, A(b), a);
}

}  // namespace chicane
