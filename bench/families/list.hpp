// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/solver/solution.hpp"
#include "problems/cpu_time.hpp"
#include "problems/optimality.hpp"

namespace chicane::bench {

/// Start of a solve: trivial inputs with the states of their simulation, or with states on a straight
/// line.
enum class NaiveStart { kIdle, kLine };
[[nodiscard]] constexpr std::string_view to_string(NaiveStart start) noexcept {
  return start == NaiveStart::kIdle ? "idle" : "line";
}

/// Results of Ipopt by family, start and seed; kept in a file, as Ipopt takes minutes.
using References = std::map<std::string, Outcome>;

struct FamilyRequest {
  int instances = 200;
  int first = 0;
  double tolerance = 1e-6;
  int max_iterations = 1000;
  bool with_ipopt = false;
  bool with_peers = false;        ///< fatrop and HPIPM, too
  int ipopt_instances = 1 << 30;  ///< Ipopt solves the first so many, and what is not solved
  bool is_impossible = false;     ///< the instances that leave no solution
};

/// Solvers: ours is the first. kHotIpopt: from its own multipliers of the cycle before, in closed loop.
enum Peer { kOurs, kHpipm, kFatrop, kIpopt, kHotIpopt, kPeers };

/// One solve of ours, what an independent check finds of it, and what others make of the same problem.
struct FamilySolve {
  int seed = 0;
  solver::SolveReport report;
  KktResidual kkt;
  bool is_false = false;             ///< optimal, though the check does not agree
  std::array<Outcome, kPeers> by{};  ///< ours is solved where it is optimal

  [[nodiscard]] bool has(solver::SolveStatus status) const { return report.status == status; }
  [[nodiscard]] bool is_usable() const { return solver::usable(report.status); }
  /// Largest of what the check leaves of an optimum.
  [[nodiscard]] double worst() const {
    return std::max({kkt.stationarity, kkt.defect, kkt.outside, kkt.miss});
  }
};
using FamilySolves = std::vector<FamilySolve>;

/// A family and how it is measured.
struct Family {
  std::string_view name;
  FamilySolves (*solve)(const FamilyRequest&, NaiveStart, References&);
  FamilySolves (*drive)(const FamilyRequest&);  ///< null: no problem that goes on
  bool has_impossible = false;                  ///< FamilyRequest::is_impossible
};
[[nodiscard]] std::span<const Family> all_families();

}  // namespace chicane::bench
