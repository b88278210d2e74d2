// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "chicane/base/random.hpp"
#include "fuzz/classify.hpp"

namespace chicane::bench {

[[nodiscard]] inline double not_a_number(Random& random) {
  const double u = random.uniform();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return u < 0.4 ? std::numeric_limits<double>::quiet_NaN() : (u < 0.7 ? kInfinity : -kInfinity);
}

/// A random problem with start, guess and options; a few of their numbers are none.
template <class P, int Capacity>
void make_case(Random& random, FuzzCase<P, Capacity>& one) {
  static_cast<typename P::Data&>(one.problem) = P::Data::make(random);
  const auto chance = [&](double share) { return random.uniform() < share; };
  const double wide = chance(0.1) ? 100.0 : 1.0;
  for (double& x : one.start) x = chance(0.002) ? not_a_number(random) : wide * random.normal();
  one.guess.horizon = chance(0.1) ? 1 : 2 + static_cast<int>(random.uniform(0.0, Capacity - 2.0));
  const double guess = chance(0.5) ? 0.0 : (chance(0.1) ? 1e6 : 1.0);
  for (auto& u : one.guess.u) {
    for (double& v : u) v = chance(0.002) ? not_a_number(random) : guess * random.normal();
  }
  for (auto& x : one.guess.x) {
    for (double& v : x) v = chance(0.001) ? not_a_number(random) : random.normal();
  }
  constexpr std::array<double, 7> kTolerances{1e-10, 1e-9, 1e-8, 1e-6, 1e-6, 1e-4, 1e-3};
  one.options = {.tolerance = kTolerances[static_cast<std::size_t>(random.uniform(0.0, 7.0))],
                 .max_iterations = chance(0.3) ? 1 + static_cast<int>(random.uniform(0.0, 30.0)) : 500,
                 .may_start_short = !chance(0.2),
                 .start_from_states = chance(0.3),
                 .second_order = !chance(0.2)};
  if constexpr (requires { one.problem.make_hard(random, one.start, 1); })
    one.problem.make_hard(random, one.start, one.guess.horizon);
  one.answer = one.guess;
}

}  // namespace chicane::bench
