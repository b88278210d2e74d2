// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <span>
#include <string_view>

#include "chicane/solver/solution.hpp"

namespace chicane::bench {

/// How many answers of each kind.
struct FuzzTally {
  std::array<long, 6> by_status{};  ///< kNotFinite … kAtFloor
  long wrong = 0;
  double slowest = 0.0;  ///< processor time of the longest solve [s]

  void add(const FuzzTally& o) {
    for (std::size_t i = 0; i < by_status.size(); ++i) by_status[i] += o.by_status[i];
    wrong += o.wrong;
    slowest = std::max(slowest, o.slowest);
  }
  [[nodiscard]] long of(solver::SolveStatus status) const {
    return by_status[static_cast<std::size_t>(static_cast<int>(status) + 3)];
  }
};
inline void print(std::string_view name, const FuzzTally& t) {
  using enum solver::SolveStatus;
  long solves = 0;
  for (const long n : t.by_status) solves += n;
  std::printf("%-28s %8ld %8ld %8ld %8ld %8ld %8ld %8ld %6ld %5.0f ms\n", name.data(), solves, t.of(kOptimal),
              t.of(kAtFloor), t.of(kBudgetSpent), t.of(kStalled), t.of(kInfeasible), t.of(kNotFinite),
              t.wrong, 1e3 * t.slowest);
  std::fflush(stdout);
}

/// One compiled type of problems.
struct FuzzKind {
  std::string_view name;
  FuzzTally (*run)(long count, long first);
};
[[nodiscard]] std::span<const FuzzKind> all_fuzz_kinds();

}  // namespace chicane::bench
