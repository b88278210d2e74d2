// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <type_traits>

#include "chicane/base/math.hpp"

namespace chicane {

/// For checks of the solver, which share no line with its jets and have no limit of variables.
/// Forward-mode dual number: a value and its derivatives with respect to N variables. T may itself be a Dual,
/// which gives exact second derivatives. Use: write a model as a template over its scalar and call it with
/// Dual<N>.
///
/// Rules are those of calculus; comparison looks at the value only, so a branch picks one side and
/// differentiates it. No allocation, no virtual call; costs about (1 + N) times the plain evaluation.
template <int N, class T = double>
struct Dual {
  T v{};                 ///< value
  std::array<T, N> d{};  ///< derivatives

  constexpr Dual() = default;
  constexpr Dual(double value) : v(value) {}  // NOLINT: constants mix freely with duals, as in formulas
  template <class U = T>
  requires(!std::is_same_v<U, double>) constexpr Dual(const T& value) : v(value) {}  // NOLINT

  /// Variable number `index` at `value`.
  static constexpr Dual variable(const T& value, int index) {
    Dual result;
    result.v = value;
    result.d[static_cast<std::size_t>(index)] = T(1.0);
    return result;
  }

  constexpr Dual& operator+=(const Dual& o) { return *this = *this + o; }
  constexpr Dual& operator-=(const Dual& o) { return *this = *this - o; }
  constexpr Dual& operator*=(const Dual& o) { return *this = *this * o; }
  constexpr Dual& operator/=(const Dual& o) { return *this = *this / o; }

  friend constexpr Dual operator-(const Dual& a) { return chain(a, -a.v, T(-1.0)); }
  friend constexpr Dual operator+(const Dual& a, const Dual& b) {
    Dual r;
    r.v = a.v + b.v;
    for (std::size_t i = 0; i < N; ++i) r.d[i] = a.d[i] + b.d[i];
    return r;
  }
  friend constexpr Dual operator-(const Dual& a, const Dual& b) {
    Dual r;
    r.v = a.v - b.v;
    for (std::size_t i = 0; i < N; ++i) r.d[i] = a.d[i] - b.d[i];
    return r;
  }
  friend constexpr Dual operator*(const Dual& a, const Dual& b) {
    Dual r;
    r.v = a.v * b.v;
    for (std::size_t i = 0; i < N; ++i) r.d[i] = a.d[i] * b.v + a.v * b.d[i];
    return r;
  }
  friend constexpr Dual operator/(const Dual& a, const Dual& b) {
    Dual r;
    r.v = a.v / b.v;
    for (std::size_t i = 0; i < N; ++i) r.d[i] = (a.d[i] - r.v * b.d[i]) / b.v;
    return r;
  }
  friend constexpr Dual operator+(const Dual& a, double b) {
    Dual r = a;
    r.v = r.v + b;
    return r;
  }
  friend constexpr Dual operator+(double a, const Dual& b) { return b + a; }
  friend constexpr Dual operator-(const Dual& a, double b) { return a + (-b); }
  friend constexpr Dual operator-(double a, const Dual& b) { return (-b) + a; }
  friend constexpr Dual operator*(const Dual& a, double b) { return chain(a, a.v * b, T(b)); }
  friend constexpr Dual operator*(double a, const Dual& b) { return b * a; }
  friend constexpr Dual operator/(const Dual& a, double b) { return a * (1.0 / b); }
  friend constexpr Dual operator/(double a, const Dual& b) { return Dual(a) / b; }

  friend constexpr bool operator<(const Dual& a, const Dual& b) { return a.v < b.v; }
  friend constexpr bool operator>(const Dual& a, const Dual& b) { return b.v < a.v; }
  friend constexpr bool operator<=(const Dual& a, const Dual& b) { return !(b.v < a.v); }
  friend constexpr bool operator>=(const Dual& a, const Dual& b) { return !(a.v < b.v); }

  /// f(a) with value `value` and slope `slope`: the chain rule.
  static constexpr Dual chain(const Dual& a, const T& value, const T& slope) {
    Dual r;
    r.v = value;
    for (std::size_t i = 0; i < N; ++i) r.d[i] = slope * a.d[i];
    return r;
  }

  /// The plain number inside, however deeply nested.
  friend constexpr double value_of(const Dual& x) noexcept { return value_of(x.v); }

  friend Dual sin(const Dual& a) { return chain(a, sin(a.v), cos(a.v)); }
  friend Dual cos(const Dual& a) { return chain(a, cos(a.v), -sin(a.v)); }
  friend Dual tan(const Dual& a) {
    const T t = tan(a.v);
    return chain(a, t, 1.0 + t * t);
  }
  friend Dual atan(const Dual& a) { return chain(a, atan(a.v), 1.0 / (1.0 + a.v * a.v)); }
  friend Dual asin(const Dual& a) { return chain(a, asin(a.v), 1.0 / sqrt((1.0 - a.v) * (1.0 + a.v))); }
  friend Dual acos(const Dual& a) { return chain(a, acos(a.v), -1.0 / sqrt((1.0 - a.v) * (1.0 + a.v))); }
  friend Dual sqrt(const Dual& a) {
    const T s = sqrt(a.v);
    return chain(a, s, 0.5 / s);
  }
  friend Dual exp(const Dual& a) {
    const T e = exp(a.v);
    return chain(a, e, e);
  }
  friend Dual log(const Dual& a) { return chain(a, log(a.v), 1.0 / a.v); }
  friend Dual tanh(const Dual& a) {
    const T t = tanh(a.v);
    return chain(a, t, 1.0 - t * t);
  }
  friend Dual pow(const Dual& a, double exponent) {
    return chain(a, pow(a.v, exponent), exponent == 0.0 ? T(0.0) : T(exponent * pow(a.v, exponent - 1.0)));
  }
  friend Dual pow(const Dual& a, const Dual& b) { return exp(b * log(a)); }
  friend Dual hypot(const Dual& a, const Dual& b) { return sqrt(a * a + b * b); }
  friend Dual atan2(const Dual& y, const Dual& x) {
    const T q = x.v * x.v + y.v * y.v;
    return chain(y, atan2(y.v, x.v), x.v / q) + chain(x, T(0.0), -y.v / q);
  }

  friend Dual abs(const Dual& a) { return value_of(a) < 0.0 ? -a : a; }
  friend Dual select(bool chosen, const Dual& a, const Dual& b) { return chosen ? a : b; }
  friend Dual max(const Dual& a, const Dual& b) { return value_of(a) > value_of(b) ? a : b; }
  friend Dual min(const Dual& a, const Dual& b) { return value_of(a) < value_of(b) ? a : b; }
  friend Dual positive_part(const Dual& a) { return value_of(a) > 0.0 ? a : Dual(0.0); }
};

}  // namespace chicane
