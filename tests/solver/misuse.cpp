// SPDX-License-Identifier: MIT
// What a model cannot do, one case for each number CASE; misuse.sh compiles them one by one. Behind `expect:`
// stands what the compiler has to say.
#include <array>
#include <cmath>
#include <tuple>

#include "chicane/solver/problem.hpp"

struct Model {
  static constexpr int kNx = 2, kNu = 1, kNr = 2, kNe = 2, kNc = 0;

  template <class K, class X, class U>
  auto dynamics(K, const X& x, const U& u) const {
    const auto& [a, b] = x;
    const auto& [push] = u;
#if CASE == 0  // compiles
    auto force = select(a > 1, sin(a), max(b, 0.0)) + pow(a, 2) - hypot(a, 1.0);
#elif CASE == 1   // expect: write sin(x), not std::sin(x)
    auto force = std::sin(a);
#elif CASE == 2   // expect: write select(x > 1.0, a, b)
    auto force = 1.0 * b;
    if (a > 1) force = 2.0 * b;
#elif CASE == 3   // expect: write select(x > 1.0, a, b)
    auto force = a > 1 ? 1.0 * a : 2.0 * b;
#elif CASE == 4   // expect: auto y = x, not double y = x
    double force = 2.0 * a;
#elif CASE == 5   // expect: & and | of comparisons
    auto force = select(a > 1 && b > 2, a, b);
#elif CASE == 6   // expect: write abs(a - b) < 1e-9
    auto force = select(a == 0.0, a, b);
#elif CASE == 7   // expect: write select(x > 1.0, a, b), max(a, b)
    auto force = std::max(1.0 * a, 1.0 * b);
#elif CASE == 8   // expect: write pow(x, 2)
    auto force = a ^ 2;
#elif CASE == 9   // expect: has jumps
    auto force = a + floor(b);
#elif CASE == 10  // expect: auto y = x, not double y = x
    auto force = static_cast<double>(a) + 1.0;
#elif CASE == 11  // expect: write select(x > 1.0, a, b)
    auto force = b;
    while (force > 1) force -= 1.0;
#elif CASE == 12  // expect: write sin(x), not std::sin(x)
    auto force = std::pow(a, 2) + std::atan2(a, b);
#elif CASE == 13  // expect: dynamics() has to return kNx rows
    return std::make_tuple(a + 0.1 * b);
    auto force = a;
#elif CASE == 14  // expect: the same of input_upper(int k)
    auto force = a;
#else
#error "no such case"
#endif
#if CASE != 13
    return std::make_tuple(a + 0.1 * b, b + 0.1 * (push + force));
#endif
  }
  template <class K, class X, class U>
  auto residual(K, const X& x, const U& u) const {
    return std::make_tuple(std::get<0>(x), 0.1 * std::get<0>(u));
  }
  template <class X>
  auto terminal_residual(const X& x) const {
    return std::make_tuple(std::get<0>(x), std::get<1>(x));
  }
  std::array<double, 1> input_lower(int) const { return {-1.0}; }
#if CASE != 14
  std::array<double, 1> input_upper(int) const { return {1.0}; }
#endif
};

template <chicane::solver::OcpProblem P>
struct Solver {};
Solver<Model> solver;
