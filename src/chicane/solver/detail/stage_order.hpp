// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include "chicane/solver/detail/pattern.hpp"

namespace chicane::solver {

/// In which order the states of a whole horizon can be simulated, one after the other instead of stage after
/// stage. That is possible where no state needs itself but as a sum, x_i⁺ = x_i + g_i(other states, u), and
/// no two need each other: then the first ones follow from the inputs alone, at all stages, the next ones
/// from those, and so on. A car's speed is the sum of its accelerations, its heading that of its turns, its
/// position that of where it was headed.
template <class Pattern>
struct StageOrder {
  static constexpr std::size_t kNx = Pattern::kNx;

  /// 0: depends on inputs at most; n: on states below n.
  static constexpr std::array<std::size_t, kNx> kLevel = [] {
    std::array<std::size_t, kNx> level{};
    for (std::size_t pass = 0; pass <= kNx; ++pass) {
      for (std::size_t i = 0; i < kNx; ++i) {
        for (std::size_t j = 0; j < kNx; ++j) {
          if (i != j && Pattern::kF[i][j] != Entry::kZero && level[i] <= level[j]) level[i] = level[j] + 1;
        }
      }
    }
    return level;
  }();
  static constexpr std::size_t kLevels = [] {
    std::size_t count = 0;
    for (const std::size_t level : kLevel) count = level >= count ? level + 1 : count;
    return count;
  }();
  /// Whether x_i⁺ = x_i + …
  static constexpr bool is_sum(std::size_t i) noexcept { return Pattern::kF[i][i] == Entry::kOne; }
  /// Whether there is such an order: in a circle of states levels rise for ever.
  static constexpr bool kExists = [] {
    for (std::size_t i = 0; i < kNx; ++i) {
      if (Pattern::kF[i][i] == Entry::kValue) return false;
    }
    return kLevels <= kNx;
  }();
};

}  // namespace chicane::solver
