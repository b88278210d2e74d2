// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include "chicane/solver/detail/pattern.hpp"

namespace chicane::test {

/// A linear-quadratic problem as plain numbers, big enough for every pattern below.
struct LqData {
  static constexpr std::size_t kMostStages = 24;
  static constexpr std::size_t kMostStates = 23;
  static constexpr std::size_t kMostInputs = 4;
  static constexpr std::size_t kMostZ = kMostStates + 1 + kMostInputs;

  std::size_t horizon = 0;
  double F[kMostStages][kMostStates][kMostZ]{};
  double L[kMostStages][kMostZ][kMostZ]{};
  double terminal[kMostStates + 1][kMostStates]{};  ///< last row: gradient
  double low[kMostStages][kMostInputs]{};
  double high[kMostStages][kMostInputs]{};
};

struct LqAnswer {
  double dx[LqData::kMostStages + 1][LqData::kMostStates]{};
  double du[LqData::kMostStages][LqData::kMostInputs]{};
  double shift = 0.0;         ///< of the first backward sweep
  int sweeps = 0;             ///< until nothing contradicts; 100 when that does not happen
  bool again_is_same = true;  ///< sweeps begun at the last change gave the bits of whole ones
};

/// States (x, y, ψ, v, e, last input 0, last input 1): sparse, with ones and untouched columns.
struct SparsePattern {
  static constexpr std::size_t kNx = 7;
  static constexpr std::size_t kNu = 2;
  static constexpr std::size_t kNz = 10;
  static constexpr std::array<std::array<solver::Entry, kNz>, kNx> kF = [] {
    using enum solver::Entry;
    std::array<std::array<solver::Entry, kNz>, kNx> f{};
    for (const std::size_t i : {0U, 1U, 2U, 3U}) f[i][i] = kOne;
    for (const std::size_t i : {0U, 1U}) f[i][2] = f[i][3] = kValue;
    f[2][3] = f[2][8] = f[3][9] = kValue;
    f[4][0] = f[4][3] = f[4][8] = kValue;
    f[4][2] = kOne;
    f[5][8] = f[6][9] = kOne;
    return f;
  }();
  static constexpr std::array<std::array<bool, kNz>, kNz> kL = [] {
    std::array<std::array<bool, kNz>, kNz> l{};
    const auto set = [&l](std::size_t i, std::size_t j) { l[i][j] = l[j][i] = true; };
    for (std::size_t i = 0; i < kNz; ++i) {
      set(i, i);
      set(i, 7);
    }
    for (const std::size_t i : {0U, 1U, 3U, 4U}) {
      for (const std::size_t j : {0U, 1U, 3U, 4U}) set(i, j);
    }
    set(2, 3);
    set(2, 8);
    set(3, 8);
    set(5, 8);
    set(6, 9);
    set(8, 9);
    return l;
  }();
};

/// No state depends on another one: F has inputs only.
struct MemorylessPattern : solver::FullPattern<3, 1> {
  static constexpr std::array<std::array<solver::Entry, kNz>, 3> kF = [] {
    std::array<std::array<solver::Entry, kNz>, 3> f{};
    for (auto& row : f) row[4] = solver::Entry::kValue;
    return f;
  }();
};

/// Solves by backward and forward sweeps until nothing contradicts the working set.
template <class Arch, class Pattern>
void solve_lq(const LqData& data, LqAnswer& answer) noexcept;

/// The same, to be built quickly.
template <class Pattern>
struct Compact : Pattern {
  static constexpr bool kIsCompact = true;
};

}  // namespace chicane::test
