// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace chicane::bench {

/// Where a solve starts: from trivial inputs, simulated, or from trivial inputs and a straight line of
/// states.
enum class NaiveStart { kIdle, kLine };
[[nodiscard]] constexpr std::string_view to_string(NaiveStart start) noexcept {
  return start == NaiveStart::kIdle ? "idle" : "line";
}

namespace detail {
inline double at_share(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}
}  // namespace detail

/// What Ipopt found of one instance.
struct ReferenceAnswer {
  bool is_solved = false;
  bool is_impossible = false;  ///< it ended where the misses have a local minimum
  double cost = 0.0;           ///< then: the sum of the misses of its inputs, simulated
  double time = 0.0;
  int iterations = 0;
  double time_in_functions = 0.0;  ///< 0 of what comes from a file
};
/// By family, start and seed; kept in a file, as Ipopt takes minutes.
using References = std::map<std::string, ReferenceAnswer>;

struct FamilyRequest {
  int instances = 200;
  int first = 0;
  double tolerance = 1e-6;
  int max_iterations = 1000;
  bool with_ipopt = false;
  bool with_peers = false;        ///< fatrop and HPIPM, too
  int ipopt_instances = 1 << 30;  ///< Ipopt solves the first so many, and what is not solved
  bool is_impossible = false;     ///< the instances that leave no solution
  bool each = false;              ///< a line for each instance
};

/// Time of a solver for an instance; infinite where it did not solve it.
struct SolveTime {
  double total = std::numeric_limits<double>::infinity();  ///< [s]
  double free = total;                                     ///< without the problem's functions
  double cost = 0.0;
};
inline constexpr std::array<const char*, 4> kSolvers{"ours", "HPIPM", "fatrop", "Ipopt"};

/// One row of the table.
struct FamilyRow {
  std::string_view family;
  NaiveStart start = NaiveStart::kIdle;
  int instances = 0, optimal = 0, at_floor = 0, usable = 0;
  int reference = 0, both = 0;  ///< solved by Ipopt; by both
  int lower = 0, higher = 0;    ///< costs more than 1 % (and 1e-6) from Ipopt's
  int false_optimal = 0;
  int infeasible = 0, reference_infeasible = 0, both_infeasible = 0;
  int further = 0;  ///< infeasible by both, with a sum of misses more than 1e-4 above Ipopt's
  double iterations = 0.0, time = 0.0, most_time = 0.0, ratio = 0.0, least_ratio = 0.0;
  double worst_residual = 0.0;  ///< of those that are optimal, by the independent check
  double floor_residual = 0.0;  ///< and of those at the floor
  std::vector<std::array<SolveTime, kSolvers.size()>> compared{};  ///< times for each instance, with peers
};

/// A family in closed loop: each solve starts from the answer of the one before, a stage later.
struct LoopRow {
  std::string_view family;
  int solves = 0, optimal = 0, usable = 0;
  int reference = 0, both = 0;  ///< of those: solved by Ipopt from the same start; by both
  int higher = 0;               ///< costs more than 1 % (and 1e-6) above Ipopt's
  double iterations = 0.0, time = 0.0, most_time = 0.0;
  double ratio = 0.0, least_ratio = 0.0;  ///< Ipopt's time over ours: median, first percentile
  double warm_ratio = 0.0;                ///< median with Ipopt's multipliers, too
};

}  // namespace chicane::bench
