// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <string_view>

namespace chicane::bench {

/// Throughput of one family's problems solved in lanes, and one after the other by the single solver, on one
/// core, in turns.
struct BatchRow {
  std::string_view family;
  int horizon = 0;
  int problems = 0;
  double per_second = 0.0;  ///< converged problems of a batch, those handed to the single solver included
  double single_per_second = 0.0;  ///< of the same problems, one by one
  double mean_turns = 0.0;         ///< of a batch
  int handed_over = 0;             ///< given up by a lane
  int unsolved = 0;                ///< of a batch, in the end
  double worst_excess = 0.0;       ///< of the batch's cost over the single solver's, relative, at most

  [[nodiscard]] double ratio() const { return per_second / single_per_second; }
};

/// Times `problems` seeded problems of a family (bench_solves.hpp) with CPU time, the least of some repeats.
/// Pre: horizon <= 50. Fewer repeats when `stop` is set.
[[nodiscard]] BatchRow time_batch(std::string_view family, int horizon, int problems,
                                  const std::atomic<bool>& stop);

}  // namespace chicane::bench
