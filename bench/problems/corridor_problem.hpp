// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <string_view>
#include <tuple>

#include "problems/described_problem.hpp"

namespace chicane::bench {

/// The described problem with a soft corridor low_k <= cte_k <= high_k (linear penalty 500, quadratic 100):
/// half-width 1.2 m with a window that forces the car at least 0.6 m to one side.
struct CorridorProblem : DescribedProblem {
  static constexpr int kNc = 2;

  int window_begin = 0;
  int window_end = 0;
  double window_side = 1.0;
  double half_width = 1.2;
  double keep_out = 0.6;
  solver::SoftPenalty penalty{.linear = 500.0, .quadratic = 100.0};

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
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return penalty; }
};

/// The same problem in the solver's structured form. cte_{k+1} is an output of stage k, so each bound stands
/// one stage earlier; the last stage has none, as the end has none.
struct StructuredCorridorProblem : StructuredDescribedProblem {
  static constexpr int kNc = 2;
  static constexpr std::size_t kCapacity = 200;
  static constexpr double kFar = 1e3;  ///< [m]

  solver::StageData<kCapacity> low;
  solver::StageData<kCapacity> high;
  solver::SoftPenalty penalty;

  StructuredCorridorProblem() = default;
  StructuredCorridorProblem(const CorridorProblem& plain, double cte, int horizon)
      : StructuredDescribedProblem(plain, cte), penalty(plain.penalty) {
    for (int k = 0; k < horizon; ++k) {
      const std::array<double, 2> excess =
          plain.constraint(k + 1, std::array<double, DescribedProblem::kNx>{}, std::array<double, 2>{});
      const bool is_last = k == horizon - 1;
      high[static_cast<std::size_t>(k)] = is_last ? kFar : -excess[0];
      low[static_cast<std::size_t>(k)] = is_last ? -kFar : excess[1];
    }
  }

  template <class K, class X, class U>
  auto constraint(K k, const X& s, const U&) const {
    const auto cte = next_cte(s);
    return std::make_tuple(cte - high.at(k), low.at(k) - cte);
  }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return penalty; }
  [[nodiscard]] static std::string_view constraint_name(int c) { return c == 0 ? "left edge" : "right edge"; }
  [[nodiscard]] static std::string_view constraint_unit(int) { return "m"; }
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
