// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <string>
#include <string_view>
#include <vector>

#include "problems/reference.hpp"

namespace chicane::bench {

/// Of a set of times.
struct Spread {
  double median = 0.0;
  double p99 = 0.0;
  double p999 = 0.0;
};
/// Nearest rank; zeros when there are none.
[[nodiscard]] Spread spread_of(std::vector<double> values);

/// One solver on all instances of a family.
struct SolverColumn {
  std::string name{};  ///< "own", or that of the reference
  Spread time_us{};    ///< CPU time of one converged solve, best of three in a row, over instances
  double without_functions_us =
      0.0;           ///< median without the problem's functions and derivatives; 0 when not measured
  int unsolved = 0;  ///< did not say that it converged
  double mean_iterations = 0.0;
  double mean_sweeps = 0.0;  ///< own only
  /// ‖u − Proj(u − dJ/du)‖∞ of the simulated inputs by forward derivatives of the whole simulation, which
  /// no solver uses; NaN with soft constraints, whose penalty has a kink.
  double median_gradient = 0.0;
  double worst_gradient = 0.0;
  double worst_excess = 0.0;  ///< of our simulated cost over this solver's, relative, at most
};

struct SolveRow {
  std::string_view family;
  int horizon = 0;
  int instances = 0;      ///< that all have solved
  int own_instances = 0;  ///< those, and more: percentiles of a hundred are not worth much
  SolverColumn own{};
  SolverColumn own_shared{};  ///< of those that all have solved
  std::vector<SolverColumn> references{};

  /// Null when that solver did not take part.
  [[nodiscard]] const SolverColumn* reference(std::string_view name) const;
};

/// cold0, coldP, warm, corridor, corridor-warm (docs/benchmarks.md).
[[nodiscard]] const std::vector<std::string_view>& families();

/// How many times as many problems our own solver gets: it takes no time.
inline constexpr int kOwnInstances = 10;

/// Times `instances` seeded problems, the solvers taking turns on each, and then our own on more of them.
/// Ends early, with what there is, when `stop` is set.
[[nodiscard]] SolveRow time_solves(std::string_view family, int horizon, int instances,
                                   References& references, const std::atomic<bool>& stop);

}  // namespace chicane::bench
