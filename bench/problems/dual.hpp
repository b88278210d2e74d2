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
};

/// The plain number inside, however deeply nested.
template <int N, class T>
[[nodiscard]] constexpr double value_of(const Dual<N, T>& x) noexcept {
  return value_of(x.v);
}

template <int N, class T>
[[nodiscard]] Dual<N, T> sin(const Dual<N, T>& a) {
  return Dual<N, T>::chain(a, sin(a.v), cos(a.v));
}
template <int N, class T>
[[nodiscard]] Dual<N, T> cos(const Dual<N, T>& a) {
  return Dual<N, T>::chain(a, cos(a.v), -sin(a.v));
}
template <int N, class T>
[[nodiscard]] Dual<N, T> tan(const Dual<N, T>& a) {
  const T t = tan(a.v);
  return Dual<N, T>::chain(a, t, 1.0 + t * t);
}
template <int N, class T>
[[nodiscard]] Dual<N, T> atan(const Dual<N, T>& a) {
  return Dual<N, T>::chain(a, atan(a.v), 1.0 / (1.0 + a.v * a.v));
}
template <int N, class T>
[[nodiscard]] Dual<N, T> sqrt(const Dual<N, T>& a) {
  const T s = sqrt(a.v);
  return Dual<N, T>::chain(a, s, 0.5 / s);
}
template <int N, class T>
[[nodiscard]] Dual<N, T> exp(const Dual<N, T>& a) {
  const T e = exp(a.v);
  return Dual<N, T>::chain(a, e, e);
}
template <int N, class T>
[[nodiscard]] Dual<N, T> log(const Dual<N, T>& a) {
  return Dual<N, T>::chain(a, log(a.v), 1.0 / a.v);
}
template <int N, class T>
[[nodiscard]] Dual<N, T> tanh(const Dual<N, T>& a) {
  const T t = tanh(a.v);
  return Dual<N, T>::chain(a, t, 1.0 - t * t);
}
template <int N, class T>
[[nodiscard]] Dual<N, T> asin(const Dual<N, T>& a) {
  return Dual<N, T>::chain(a, asin(a.v), 1.0 / sqrt((1.0 - a.v) * (1.0 + a.v)));
}
template <int N, class T>
[[nodiscard]] Dual<N, T> acos(const Dual<N, T>& a) {
  return Dual<N, T>::chain(a, acos(a.v), -1.0 / sqrt((1.0 - a.v) * (1.0 + a.v)));
}
template <int N, class T>
[[nodiscard]] Dual<N, T> pow(const Dual<N, T>& a, double exponent) {
  const T slope = exponent == 0.0 ? T(0.0) : T(exponent * pow(a.v, exponent - 1.0));
  return Dual<N, T>::chain(a, pow(a.v, exponent), slope);
}
template <int N, class T>
[[nodiscard]] Dual<N, T> pow(const Dual<N, T>& a, const Dual<N, T>& b) {
  return exp(b * log(a));
}
template <int N, class T>
[[nodiscard]] Dual<N, T> hypot(const Dual<N, T>& a, const std::type_identity_t<Dual<N, T>>& b) {
  return sqrt(a * a + b * b);
}
template <int N, class T>
[[nodiscard]] Dual<N, T> abs(const Dual<N, T>& a) {
  return value_of(a) < 0.0 ? -a : a;
}
template <int N, class T>
[[nodiscard]] Dual<N, T> atan2(const Dual<N, T>& y, const Dual<N, T>& x) {
  const T q = x.v * x.v + y.v * y.v;
  Dual<N, T> r;
  r.v = atan2(y.v, x.v);
  for (std::size_t i = 0; i < N; ++i) r.d[i] = (x.v * y.d[i] - y.v * x.d[i]) / q;
  return r;
}

template <int N, class T>
[[nodiscard]] Dual<N, T> select(bool chosen, const Dual<N, T>& a, const std::type_identity_t<Dual<N, T>>& b) {
  return chosen ? a : b;
}
template <int N, class T>
[[nodiscard]] Dual<N, T> select(bool chosen, double a, const Dual<N, T>& b) {
  return chosen ? Dual<N, T>(a) : b;
}
template <int N, class T>
[[nodiscard]] Dual<N, T> max(const Dual<N, T>& a, const std::type_identity_t<Dual<N, T>>& b) {
  return value_of(a) > value_of(b) ? a : b;
}
template <int N, class T>
[[nodiscard]] Dual<N, T> min(const Dual<N, T>& a, const std::type_identity_t<Dual<N, T>>& b) {
  return value_of(a) < value_of(b) ? a : b;
}
template <int N, class T>
[[nodiscard]] Dual<N, T> positive_part(const Dual<N, T>& a) {
  return value_of(a) > 0.0 ? a : Dual<N, T>(0.0);
}

}  // namespace chicane
