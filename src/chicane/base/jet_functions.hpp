// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/base/inlining.hpp"
#include "chicane/base/jet.hpp"
#include "chicane/base/math.hpp"

namespace chicane {

/// More functions for jets, beside those of jet.hpp, and smooth ones for any scalar. All are found by their
/// arguments: models write them without `chicane::` and without `using`.
///
/// Where a derivative is infinite or does not exist, it is not a number, and a solve that comes there ends
/// *not finite*: asin and acos at ±1 and beyond, pow with an exponent below 2 that is not whole at 0 (and for
/// x < 0 the value, too), hypot at (0, 0). max, min, abs, select and positive_part have the derivatives of
/// the side that is chosen; at the edge that of the second argument, abs those of +x, positive_part 0.

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

/// A constant exponent; whole ones up to ±64 for bases of any sign.
template <AnyJet A>
[[nodiscard]] CHICANE_INLINE inline auto pow(const A& a, double exponent) {
  using V = typename A::Value;
  const V slope = exponent == 0.0 ? V(0.0) : V(exponent * pow(a.v, exponent - 1.0));
  const V curvature =
      exponent == 0.0 || exponent == 1.0 ? V(0.0) : V(exponent * (exponent - 1.0) * pow(a.v, exponent - 2.0));
  return jet::chain(a, pow(a.v, exponent), slope, curvature);
}
/// exp(b · log(a)): a > 0.
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

// ---- smooth in place of abs, max, min, positive_part and a step: within about `width` of the edge (> 0, in
// the unit of x) they are round, elsewhere they are the sharp ones but for less than width² / |x|.

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
/// From 0 to 1, ½ at 0: ½ (1 + tanh(x / width)).
template <class T>
[[nodiscard]] CHICANE_INLINE inline auto smooth_step(const T& x, double width) {
  return 0.5 + 0.5 * tanh(x * (1.0 / width));
}

}  // namespace chicane
