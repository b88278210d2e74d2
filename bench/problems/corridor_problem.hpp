// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>

#include "problems/described_problem.hpp"

namespace chicane::bench {

/// The described problem with a soft corridor low_k <= cte_k <= high_k (linear price 500, quadratic 100):
/// half-width 1.2 m with a window that forces the car at least 0.6 m to one side.
struct CorridorProblem : DescribedProblem {
  static constexpr int kNc = 2;

  int window_begin = 0;
  int window_end = 0;
  double window_side = 1.0;
  double half_width = 1.2;
  double keep_out = 0.6;
  solver::SoftPenalty price{.linear = 500.0, .quadratic = 100.0};

  template <class T>
  std::array<T, kNc> constraint(int k, const std::array<T, kNx>& s, const std::array<T, kNu>&) const {
    double low = -half_width;
    double high = half_width;
    if (k >= window_begin && k < window_end) {
      low = window_side > 0.0 ? keep_out : -2.0;
      high = window_side > 0.0 ? 2.0 : -keep_out;
    }
    return {s[4] - high, low - s[4]};
  }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return price; }
};

/// A random instance of it for a horizon.
struct CorridorInstance {
  CorridorProblem problem;
  std::array<double, DescribedProblem::kNx> start{};
};

inline CorridorInstance random_corridor(Random& random, int horizon) {
  const DescribedInstance plain = random_instance(random, horizon);
  CorridorInstance instance;
  static_cast<DescribedProblem&>(instance.problem) = plain.problem;
  instance.start = plain.start;
  instance.problem.window_begin = horizon / 3;
  instance.problem.window_end = horizon / 3 + std::max(2, horizon / 4);
  instance.problem.window_side = random.uniform() < 0.5 ? 1.0 : -1.0;
  return instance;
}

}  // namespace chicane::bench
