// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <functional>
#include <string_view>
#include <tuple>

#include "chicane/base/compiler.hpp"
#include "chicane/base/math.hpp"
#include "chicane/base/random.hpp"
#include "chicane/solver/hard_constraints.hpp"
#include "chicane/solver/problem.hpp"

// The vocabulary of problems, for the headers of families.

namespace chicane::bench {

/// An array of numbers of one type: values, jets or dual numbers.
template <class A>
concept Numbers = requires {
  requires std::same_as<A, std::array<typename A::value_type, std::tuple_size_v<A>>>;
};

/// One optimal control problem of a family that is no car. A family draws its instances with `draw(random)`;
/// a family that has instances without a solution, with `draw(random, is_impossible)`.
template <int Nx, int Nu>
struct FamilyProblem {
  static constexpr int kNx = Nx, kNu = Nu;
  std::array<double, Nx> start{};  ///< x_0
  std::array<double, Nx> goal{};   ///< end of the straight line of a naive guess
  std::array<double, Nu> idle{};   ///< the trivial input: none, or a hover's
  std::array<double, Nu> most{};   ///< bounds of the inputs, in both directions

  [[nodiscard]] std::array<double, Nu> input_upper(int) const { return most; }
  [[nodiscard]] std::array<double, Nu> input_lower(int) const {
    std::array<double, Nu> least;
    std::transform(most.begin(), most.end(), least.begin(), std::negate<>{});
    return least;
  }

  /// No cost at the end.
  template <Numbers X>
  auto terminal_residual(const X&) const {
    return std::array<typename X::value_type, 0>{};
  }
};

/// All constraints must hold; their first penalty is this.
template <int Penalty>
struct AllHard {
  [[nodiscard]] bool is_hard(int) const { return true; }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const {
    return {.linear = Penalty, .quadratic = Penalty};
  }
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
