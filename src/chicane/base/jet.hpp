// SPDX-License-Identifier: MIT
// Arithmetic, elementary functions, choices and smooth functions of jets: numbers with derivatives.
#pragma once

#include <algorithm>
#include <type_traits>

#include "chicane/base/compiler.hpp"
#include "chicane/base/detail/jet_rules.hpp"
#include "chicane/base/detail/loose_jet.hpp"
#include "chicane/base/math.hpp"

namespace chicane {

// Each function states its value and partial derivatives; the chain rule (detail/jet_rules.hpp) does the
// rest.

// ---- arithmetic

template <AnyJet A, AnyJet B>
[[nodiscard]] CHICANE_INLINE inline constexpr auto operator+(const A& a, const B& b) {
  using namespace jet;
  return chain(a, b, a.v + b.v, Partials{One{}, One{}, Zero{}, Zero{}, Zero{}});
}
template <AnyJet A, AnyJet B>
[[nodiscard]] CHICANE_INLINE inline constexpr auto operator-(const A& a, const B& b) {
  using namespace jet;
  return chain(a, b, a.v - b.v, Partials{One{}, Minus{}, Zero{}, Zero{}, Zero{}});
}
template <AnyJet A, AnyJet B>
[[nodiscard]] CHICANE_INLINE inline constexpr auto operator*(const A& a, const B& b) {
  using namespace jet;
  return chain(a, b, a.v * b.v, Partials{b.v, a.v, Zero{}, One{}, Zero{}});
}
template <AnyJet A, AnyJet B>
[[nodiscard]] CHICANE_INLINE inline constexpr auto operator/(const A& a, const B& b) {
  using namespace jet;
  using V = typename A::Value;
  const V inverse = 1.0 / b.v;
  const V value = a.v / b.v;
  const V by_b = -value * inverse;
  const V by_ab = -inverse * inverse;
  return chain(a, b, value, Partials{inverse, by_b, Zero{}, by_ab, -2.0 * by_b * inverse});
}
template <AnyJet A>
[[nodiscard]] CHICANE_INLINE inline constexpr auto operator-(const A& a) {
  return jet::chain(a, -a.v, jet::Minus{}, jet::Zero{});
}
template <AnyJet A>
[[nodiscard]] CHICANE_INLINE inline constexpr const A& operator+(const A& a) {
  return a;
}

template <AnyJet A, ConstantFor<A> S>
[[nodiscard]] CHICANE_INLINE inline constexpr auto operator+(const A& a, const S& b) {
  return jet::chain(a, a.v + b, jet::One{}, jet::Zero{});
}
template <AnyJet A, ConstantFor<A> S>
[[nodiscard]] CHICANE_INLINE inline constexpr auto operator+(const S& b, const A& a) {
  return a + b;
}
template <AnyJet A, ConstantFor<A> S>
[[nodiscard]] CHICANE_INLINE inline constexpr auto operator-(const A& a, const S& b) {
  return jet::chain(a, a.v - b, jet::One{}, jet::Zero{});
}
template <AnyJet A, ConstantFor<A> S>
[[nodiscard]] CHICANE_INLINE inline constexpr auto operator-(const S& b, const A& a) {
  return jet::chain(a, b - a.v, jet::Minus{}, jet::Zero{});
}
template <AnyJet A, ConstantFor<A> S>
[[nodiscard]] CHICANE_INLINE inline constexpr auto operator*(const A& a, const S& b) {
  return jet::chain(a, a.v * b, typename A::Value(b), jet::Zero{});
}
template <AnyJet A, ConstantFor<A> S>
[[nodiscard]] CHICANE_INLINE inline constexpr auto operator*(const S& b, const A& a) {
  return a * b;
}
template <AnyJet A, ConstantFor<A> S>
[[nodiscard]] CHICANE_INLINE inline constexpr auto operator/(const A& a, const S& b) {
  return a * (1.0 / b);
}
template <AnyJet A, ConstantFor<A> S>
[[nodiscard]] CHICANE_INLINE inline constexpr auto operator/(const S& b, const A& a) {
  using V = typename A::Value;
  const V inverse = 1.0 / a.v;
  const V value = b * inverse;
  const V slope = -value * inverse;
  return jet::chain(a, value, slope, -2.0 * slope * inverse);
}

// Comparisons, of values only.
template <class A, WithJet<A> B>
[[nodiscard]] CHICANE_INLINE inline constexpr auto operator<(const A& a, const B& b) {
  return jet::value(a) < jet::value(b);
}
template <class A, WithJet<A> B>
[[nodiscard]] CHICANE_INLINE inline constexpr auto operator>(const A& a, const B& b) {
  return jet::value(a) > jet::value(b);
}

template <class A, WithJet<A> B>
[[nodiscard]] CHICANE_INLINE inline constexpr auto operator<=(const A& a, const B& b) {
  return jet::value(a) <= jet::value(b);
}
template <class A, WithJet<A> B>
[[nodiscard]] CHICANE_INLINE inline constexpr auto operator>=(const A& a, const B& b) {
  return jet::value(a) >= jet::value(b);
}

// ---- elementary functions

template <AnyJet A>
[[nodiscard]] CHICANE_INLINE inline auto sin(const A& a) {
  const auto s = sin(a.v);
  return jet::chain(a, s, cos(a.v), -s);
}
template <AnyJet A>
[[nodiscard]] CHICANE_INLINE inline auto cos(const A& a) {
  const auto c = cos(a.v);
  return jet::chain(a, c, -sin(a.v), -c);
}
template <AnyJet A>
[[nodiscard]] CHICANE_INLINE inline auto tan(const A& a) {
  const auto t = tan(a.v);
  const auto slope = 1.0 + t * t;
  return jet::chain(a, t, slope, 2.0 * t * slope);
}
template <AnyJet A>
[[nodiscard]] CHICANE_INLINE inline auto atan(const A& a) {
  const auto slope = 1.0 / (1.0 + a.v * a.v);
  return jet::chain(a, atan(a.v), slope, -2.0 * a.v * slope * slope);
}
template <AnyJet A>
[[nodiscard]] CHICANE_INLINE inline auto sqrt(const A& a) {
  const auto root = sqrt(a.v);
  const auto slope = 0.5 / root;
  return jet::chain(a, root, slope, -0.5 * slope / a.v);
}
template <AnyJet A>
[[nodiscard]] CHICANE_INLINE inline auto exp(const A& a) {
  const auto e = exp(a.v);
  return jet::chain(a, e, e, e);
}
template <AnyJet A>
[[nodiscard]] CHICANE_INLINE inline auto log(const A& a) {
  const auto slope = 1.0 / a.v;
  return jet::chain(a, log(a.v), slope, -slope * slope);
}
template <AnyJet A>
[[nodiscard]] CHICANE_INLINE inline auto tanh(const A& a) {
  const auto t = tanh(a.v);
  const auto slope = 1.0 - t * t;
  return jet::chain(a, t, slope, -2.0 * t * slope);
}
template <AnyJet A, AnyJet B>
[[nodiscard]] CHICANE_INLINE inline auto atan2(const A& y, const B& x) {
  using namespace jet;
  const auto inverse = 1.0 / (x.v * x.v + y.v * y.v);
  const auto by_y = x.v * inverse;
  const auto by_x = -y.v * inverse;
  const auto by_yy = 2.0 * by_y * by_x;
  return chain(y, x, atan2(y.v, x.v), Partials{by_y, by_x, by_yy, by_x * by_x - by_y * by_y, -by_yy});
}

// ---- choices without branches

/// `a` where the mask is set, else `b`, each with its derivatives.
template <class M, AnyJet A, AnyJet B>
[[nodiscard]] CHICANE_INLINE inline constexpr auto select(const M& mask, const A& a, const B& b) {
  using V = typename A::Value;
  Jet<V, A::kOrder, A::kFirst | B::kFirst, A::kUnit & B::kUnit, A::kSecond | B::kSecond> r;
  using R = decltype(r);
  r.v = select(mask, a.v, b.v);
  if constexpr (std::is_same_v<A, B>) {
    for (std::size_t n = 0; n < R::kSlopes; ++n) r.slopes[n] = select(mask, a.slopes[n], b.slopes[n]);
    for (std::size_t n = 0; n < R::kCurvatures; ++n)
      r.curvatures[n] = select(mask, a.curvatures[n], b.curvatures[n]);
    return r;
  }
  jet::repeat<static_cast<int>(R::kSlopes)>([&](auto n) CHICANE_INLINE {
    constexpr int i = member_of(R::kFirst & ~R::kUnit, n);
    r.slopes[n] = select(mask, jet::number<V>(jet::slope<i>(a)), jet::number<V>(jet::slope<i>(b)));
  });
  jet::repeat<static_cast<int>(R::kCurvatures)>([&](auto n) CHICANE_INLINE {
    constexpr Pair p = members<R::kSecond>()[n];
    r.curvatures[n] = select(mask, jet::number<V>(jet::curvature<p.i, p.j>(a)),
                             jet::number<V>(jet::curvature<p.i, p.j>(b)));
  });
  return r;
}
template <class M, AnyJet A, ConstantFor<A> S>
[[nodiscard]] CHICANE_INLINE inline constexpr auto select(const M& mask, const A& a, const S& b) {
  return select(mask, a, Jet<typename A::Value, A::kOrder, 0>(b));
}
template <class M, AnyJet A, ConstantFor<A> S>
[[nodiscard]] CHICANE_INLINE inline constexpr auto select(const M& mask, const S& b, const A& a) {
  return select(mask, Jet<typename A::Value, A::kOrder, 0>(b), a);
}
template <class A, WithJet<A> B>
[[nodiscard]] CHICANE_INLINE inline constexpr auto max(const A& a, const B& b) {
  return select(a > b, a, b);
}
template <class A, WithJet<A> B>
[[nodiscard]] CHICANE_INLINE inline constexpr auto min(const A& a, const B& b) {
  return select(a < b, a, b);
}
/// max(a, 0): the excess over a limit.
template <AnyJet A>
[[nodiscard]] CHICANE_INLINE inline constexpr auto positive_part(const A& a) {
  return select(a.v > 0.0, a, 0.0);
}
template <AnyJet A>
[[nodiscard]] CHICANE_INLINE inline constexpr auto abs(const A& a) {
  return select(a.v < 0.0, -a, a);
}

// ---- a common type for mixed arguments

namespace jet {

/// Variables, order and values of a jet; of a constant, which has no derivatives, as well.
template <class T>
struct Traits {
  static constexpr Variables kFirst = 0;
  static constexpr int kOrder = 0;
  using Value = T;
};
template <AnyJet T>
struct Traits<T> : T {};

/// The jet with all derivatives that any of T… has; the values' type if all are constants.
template <class... T>
struct Common {
  static constexpr Variables kAll = (Traits<T>::kFirst | ...);
  static constexpr int kOrder = std::max({Traits<T>::kOrder...});
  static constexpr Pairs kPairs = kOrder == 2 ? Pairs::of(kAll, kAll) : Pairs{};
  using Value = std::common_type_t<typename Traits<T>::Value...>;
  using Type = std::conditional_t<kOrder == 0, Value, Jet<Value, kOrder, kAll, 0, kPairs>>;
};
/// The first LooseJet among T…
template <class T, class... Rest>
struct LooseOf : LooseOf<Rest...> {};
template <AnyLooseJet T, class... Rest>
struct LooseOf<T, Rest...> {
  using Type = T;
};
template <class... T>
requires(AnyLooseJet<T> || ...) struct Common<T...> : LooseOf<T...> {
};

}  // namespace jet

/// Type that holds each of T… and is closed under arithmetic, for code with one type of numbers (struct
/// Motion<T>).
template <class... T>
using Common = typename jet::Common<std::remove_cvref_t<T>...>::Type;

// ---- asin, acos, pow and hypot for jets, and smooth functions for any scalar
//
// Argument-dependent look-up finds all functions of this file: models write neither `chicane::` nor `using`.
//
// A derivative that is infinite or does not exist is not a number, and the solve that needs it ends *not
// finite*: of asin and acos at ±1 and beyond, of pow at 0 with an exponent below 2 that is not whole (for x <
// 0 the value, too), of hypot at (0, 0). max, min, abs, select and positive_part have the derivatives of the
// chosen side. At the edge max and min have those of the second argument, abs those of +x, positive_part 0.

template <AnyJet A>
[[nodiscard]] CHICANE_INLINE inline auto asin(const A& a) {
  const auto inverse = 1.0 / ((1.0 - a.v) * (1.0 + a.v));
  const auto slope = sqrt(inverse);
  return jet::chain(a, asin(a.v), slope, a.v * slope * inverse);
}
template <AnyJet A>
[[nodiscard]] CHICANE_INLINE inline auto acos(const A& a) {
  const auto inverse = 1.0 / ((1.0 - a.v) * (1.0 + a.v));
  const auto slope = sqrt(inverse);
  return jet::chain(a, acos(a.v), -slope, -a.v * slope * inverse);
}

/// Power with a constant exponent; whole exponents up to ±64 take bases of any sign.
template <AnyJet A>
[[nodiscard]] CHICANE_INLINE inline auto pow(const A& a, double exponent) {
  using V = typename A::Value;
  const V slope = exponent == 0.0 ? V(0.0) : V(exponent * pow(a.v, exponent - 1.0));
  const V curvature =
      exponent == 0.0 || exponent == 1.0 ? V(0.0) : V(exponent * (exponent - 1.0) * pow(a.v, exponent - 2.0));
  return jet::chain(a, pow(a.v, exponent), slope, curvature);
}
/// Power exp(b · log(a)) of a base a > 0.
template <AnyJet A, AnyJet B>
[[nodiscard]] CHICANE_INLINE inline auto pow(const A& a, const B& b) {
  return exp(b * log(a));
}
template <AnyJet B>
[[nodiscard]] CHICANE_INLINE inline auto pow(double a, const B& b) {
  return exp(log(a) * b);
}

/// The length of (a, b).
template <AnyJet A, AnyJet B>
[[nodiscard]] CHICANE_INLINE inline auto hypot(const A& a, const B& b) {
  using namespace jet;
  const auto length = hypot(a.v, b.v);
  const auto inverse = 1.0 / length;
  const auto by_a = a.v * inverse;
  const auto by_b = b.v * inverse;
  return chain(a, b, length,
               Partials{by_a, by_b, by_b * by_b * inverse, -by_a * by_b * inverse, by_a * by_a * inverse});
}
template <AnyJet A, ConstantFor<A> S>
[[nodiscard]] CHICANE_INLINE inline auto hypot(const A& a, const S& b) {
  return hypot(a, Jet<typename A::Value, A::kOrder, 0>(b));
}
template <AnyJet A, ConstantFor<A> S>
[[nodiscard]] CHICANE_INLINE inline auto hypot(const S& b, const A& a) {
  return hypot(a, b);
}
template <AnyJet A, ConstantFor<A> S>
[[nodiscard]] CHICANE_INLINE inline auto atan2(const A& y, const S& x) {
  return atan2(y, Jet<typename A::Value, A::kOrder, 0>(x));
}
template <AnyJet A, ConstantFor<A> S>
[[nodiscard]] CHICANE_INLINE inline auto atan2(const S& y, const A& x) {
  return atan2(Jet<typename A::Value, A::kOrder, 0>(y), x);
}

// ---- smooth abs, max, min, positive part and step: round within about `width` (> 0, unit of x) of the edge.
// Farther away they differ from the sharp ones by less than width² / |x|, the step by exp(−2 |x| / width).

/// √(x² + width²): `width` above |x| at 0.
template <class T>
[[nodiscard]] CHICANE_INLINE inline auto smooth_abs(const T& x, double width) {
  return sqrt(x * x + width * width);
}
/// ½ (x + smooth_abs(x)): width / 2 above max(x, 0) at 0.
template <class T>
[[nodiscard]] CHICANE_INLINE inline auto smooth_positive_part(const T& x, double width) {
  return 0.5 * (x + smooth_abs(x, width));
}
template <class A, class B>
[[nodiscard]] CHICANE_INLINE inline auto smooth_max(const A& a, const B& b, double width) {
  return b + smooth_positive_part(a - b, width);
}
template <class A, class B>
[[nodiscard]] CHICANE_INLINE inline auto smooth_min(const A& a, const B& b, double width) {
  return b - smooth_positive_part(b - a, width);
}
/// Smooth step from 0 to 1, ½ at 0: ½ (1 + tanh(x / width)).
template <class T>
[[nodiscard]] CHICANE_INLINE inline auto smooth_step(const T& x, double width) {
  return 0.5 + 0.5 * tanh(x * (1.0 / width));
}

}  // namespace chicane
