// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <type_traits>

#include "chicane/base/dual.hpp"
#include "chicane/base/math.hpp"

namespace chicane::lap_time {

/// A number with its first and second derivatives by N variables: a model written as a template over its
/// scalar gives exact Jacobians and Hessians. Comparisons look at the value only. About N² operations each.
template <int N>
struct Curved {
  static constexpr int kEntries = N * (N + 1) / 2;
  double v = 0.0;
  std::array<double, N> g{};         ///< gradient
  std::array<double, kEntries> h{};  ///< Hessian: lower triangle by rows

  constexpr Curved() = default;
  constexpr Curved(double value) : v{value} {}  // NOLINT: constants mix freely with them, as in formulas

  /// f(a): its value, first and second derivative.
  static Curved chain(const Curved& a, double f, double f1, double f2) {
    Curved r(f);
    for (std::size_t i = 0; i < N; ++i) r.g[i] = f1 * a.g[i];
    std::size_t at = 0;
    for (std::size_t i = 0; i < N; ++i) {
      const double left = f2 * a.g[i];
      for (std::size_t j = 0; j <= i; ++j, ++at) r.h[at] = f1 * a.h[at] + left * a.g[j];
    }
    return r;
  }

  friend Curved operator-(const Curved& a) { return scaled(a, -1.0); }
  friend Curved operator+(const Curved& a, const Curved& b) {
    Curved r(a.v + b.v);
    for (std::size_t i = 0; i < N; ++i) r.g[i] = a.g[i] + b.g[i];
    for (std::size_t i = 0; i < kEntries; ++i) r.h[i] = a.h[i] + b.h[i];
    return r;
  }
  friend Curved operator-(const Curved& a, const Curved& b) {
    Curved r(a.v - b.v);
    for (std::size_t i = 0; i < N; ++i) r.g[i] = a.g[i] - b.g[i];
    for (std::size_t i = 0; i < kEntries; ++i) r.h[i] = a.h[i] - b.h[i];
    return r;
  }
  friend Curved operator*(const Curved& a, const Curved& b) {
    Curved r(a.v * b.v);
    for (std::size_t i = 0; i < N; ++i) r.g[i] = a.v * b.g[i] + b.v * a.g[i];
    std::size_t at = 0;
    for (std::size_t i = 0; i < N; ++i) {
      const double left = a.g[i];
      const double right = b.g[i];
      for (std::size_t j = 0; j <= i; ++j, ++at)
        r.h[at] = a.v * b.h[at] + b.v * a.h[at] + (left * b.g[j] + right * a.g[j]);
    }
    return r;
  }
  friend Curved operator/(const Curved& a, const Curved& b) { return a * (1.0 / b); }
  friend Curved operator+(const Curved& a, double b) {
    Curved r = a;
    r.v += b;
    return r;
  }
  friend Curved operator+(double a, const Curved& b) { return b + a; }
  friend Curved operator-(const Curved& a, double b) { return a + (-b); }
  friend Curved operator-(double a, const Curved& b) {
    Curved r = scaled(b, -1.0);
    r.v += a;
    return r;
  }
  friend Curved operator*(const Curved& a, double b) { return scaled(a, b); }
  friend Curved operator*(double a, const Curved& b) { return scaled(b, a); }
  friend Curved operator/(const Curved& a, double b) { return scaled(a, 1.0 / b); }
  friend Curved operator/(double a, const Curved& b) {
    const double inverse = 1.0 / b.v;
    return chain(b, a * inverse, -a * inverse * inverse, 2.0 * a * inverse * inverse * inverse);
  }
  friend bool operator<(const Curved& a, double b) { return a.v < b; }
  friend bool operator>(const Curved& a, double b) { return a.v > b; }
  Curved& operator+=(const Curved& o) { return *this = *this + o; }

 private:
  static Curved scaled(const Curved& a, double by) {
    Curved r(a.v * by);
    for (std::size_t i = 0; i < N; ++i) r.g[i] = a.g[i] * by;
    for (std::size_t i = 0; i < kEntries; ++i) r.h[i] = a.h[i] * by;
    return r;
  }
};

// Beside the functions below, those of numbers.
using chicane::atan;
using chicane::cos;
using chicane::sin;
using chicane::sqrt;
using chicane::value_of;

template <int N>
[[nodiscard]] double value_of(const Curved<N>& a) noexcept {
  return a.v;
}

template <int N>
[[nodiscard]] Curved<N> sin(const Curved<N>& a) {
  const double s = chicane::sin(a.v);
  return Curved<N>::chain(a, s, chicane::cos(a.v), -s);
}
template <int N>
[[nodiscard]] Curved<N> cos(const Curved<N>& a) {
  const double c = chicane::cos(a.v);
  return Curved<N>::chain(a, c, -chicane::sin(a.v), -c);
}
template <int N>
[[nodiscard]] Curved<N> sqrt(const Curved<N>& a) {
  const double root = std::sqrt(a.v);
  return Curved<N>::chain(a, root, 0.5 / root, -0.25 / (root * a.v));
}
template <int N>
[[nodiscard]] Curved<N> atan(const Curved<N>& a) {
  const double slope = 1.0 / (1.0 + a.v * a.v);
  return Curved<N>::chain(a, chicane::atan(a.v), slope, -2.0 * a.v * slope * slope);
}

template <int N>
[[nodiscard]] Curved<N> select(bool chosen, const Curved<N>& a, const Curved<N>& b) {
  return chosen ? a : b;
}

}  // namespace chicane::lap_time
