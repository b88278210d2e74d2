// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <tuple>

#include "chicane/base/compiler.hpp"
#include "chicane/base/math.hpp"
#include "chicane/base/random.hpp"
#include "chicane/solver/hard_constraints.hpp"
#include "chicane/solver/problem.hpp"

// The vocabulary of problems, for the headers of families.

namespace chicane::bench {

/// One optimal control problem of a family that is no car: what a solve needs, made from a seed.
template <class P>
struct FamilyInstance {
  P problem;
  std::array<double, P::kNx> start{};  ///< x_0
  std::array<double, P::kNx> goal{};   ///< where a naive guess of the states goes in a straight line
  std::array<double, P::kNu> idle{};   ///< the trivial input: none, or what hovers
};

/// One step of Runge and Kutta's classical method for x' = rate(x), of any scalar.
template <class T, std::size_t N, class Rate>
[[nodiscard]] std::array<T, N> runge_kutta_4(const std::array<T, N>& x, double step, const Rate& rate) {
  const auto ahead = [&](const std::array<T, N>& slope, double by) {
    std::array<T, N> result;
    for (std::size_t i = 0; i < N; ++i) result[i] = x[i] + by * slope[i];
    return result;
  };
  const std::array<T, N> a = rate(x);
  const std::array<T, N> b = rate(ahead(a, 0.5 * step));
  const std::array<T, N> c = rate(ahead(b, 0.5 * step));
  const std::array<T, N> d = rate(ahead(c, step));
  std::array<T, N> result;
  for (std::size_t i = 0; i < N; ++i) result[i] = x[i] + (step / 6.0) * (a[i] + 2.0 * (b[i] + c[i]) + d[i]);
  return result;
}

}  // namespace chicane::bench
