// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "chicane/base/result.hpp"

namespace chicane::bench {

/// Problems of a recorded closed loop whose optima another solver found to 1e-10.
struct GoldenRow {
  std::string set;    ///< "30mps_N20"
  std::string start;  ///< what the solver starts from: "cold0" or "coldP" (docs/benchmarks.md)
  int nodes = 0;      ///< states of the horizon
  int problems = 0;
  int unsolved = 0;           ///< we did not say that it converged
  int agree = 0;              ///< objectives equal to 1e-8 of the golden one, or of 1 where that is less
  int relaxed = 0;            ///< of ours, compared as if bounds were moved outwards like the golden one's
  int better = 0;             ///< ours is lower by more: another local optimum
  int worse = 0;              ///< ours is higher by more
  double worst_excess = 0.0;  ///< of our objective over the golden one, by the same measure
  double median_first_steer = 0.0;  ///< difference of the first steering angle among those that agree [rad]
  double worst_first_steer = 0.0;
  double median_us = 0.0;
};

/// Solves the sets golden_<set>.csv of a folder, each with the cycles in lap_<speed>.csv, from inputs of
/// zero and from those of a path-following law. kNotFound when there are none; kParse "file:line: …" for what
/// cannot be read.
[[nodiscard]] Result<std::vector<GoldenRow>> solve_golden(const std::string& folder,
                                                          const std::atomic<bool>& stop);

}  // namespace chicane::bench
