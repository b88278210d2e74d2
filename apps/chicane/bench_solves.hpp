// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace chicane::apps {

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
  Spread time_us;    ///< CPU time of one converged solve, best of three in a row, over instances
  Spread linear_us;  ///< the same without the problem's functions and derivatives; zeros when not measured
  int unsolved = 0;  ///< did not say that it converged
  double mean_turns = 0.0;
  /// ‖u − Proj(u − dJ/du)‖∞ of the simulated inputs by forward derivatives of the whole simulation, which
  /// neither solver uses; NaN with soft constraints, whose penalty has a kink.
  double median_gradient = 0.0;
  double worst_gradient = 0.0;
  double worst_excess = 0.0;  ///< of the simulated cost over the other solver's, relative; own over Ipopt's
};

struct SolveRow {
  std::string_view family;
  int horizon = 0;
  int instances = 0;
  SolverColumn own{};
  std::optional<SolverColumn> ipopt{};       ///< same start
  std::optional<SolverColumn> ipopt_warm{};  ///< with the multipliers of the cycle before, shifted
};

/// cold0, coldP, warm, corridor, corridor-warm (docs/benchmarks.md).
[[nodiscard]] const std::vector<std::string_view>& families();
/// Version of the Ipopt in this program; empty without.
[[nodiscard]] std::string ipopt_version();

inline constexpr int kLongestHorizon = 200;

/// Times `instances` seeded problems, the solvers taking turns on each. Ends early, with what there is, when
/// `stop` is set.
[[nodiscard]] SolveRow time_solves(std::string_view family, int horizon, int instances, bool with_ipopt,
                                   const std::atomic<bool>& stop);

}  // namespace chicane::apps
