// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

#include "chicane/solver/hard_constraints.hpp"
#include "chicane/solver/problem.hpp"
#include "chicane/solver/solution.hpp"

/// Reports of the solver as sentences.

namespace chicane::solver {

namespace detail {
/// Amount with unit and stage: "0.12 m at stage 14".
[[nodiscard]] inline std::string amount(double value, std::string_view unit, int stage) {
  char number[32];
  std::snprintf(number, sizeof(number), "%.3g", value);
  std::string text{number};
  if (!unit.empty()) text.append(" ").append(unit);
  return text + " at stage " + std::to_string(stage);
}
}  // namespace detail

/// A report in one sentence, with the problem's names: "infeasible: right edge exceeded by 0.12 m at stage
/// 14". A constraint without a name is "constraint 1". Allocates: not for the control loop.
template <OcpProblem P>
[[nodiscard]] std::string describe(const P& problem, const SolveReport& report) {
  std::string text{to_string(report.status)};
  if (report.worst_constraint < 0) return text;
  std::string name = "constraint " + std::to_string(report.worst_constraint);
  std::string unit;
  if constexpr (requires { problem.constraint_name(0); })
    name = problem.constraint_name(report.worst_constraint);
  if constexpr (requires { problem.constraint_unit(0); })
    unit = problem.constraint_unit(report.worst_constraint);
  return text + ": " + name + " exceeded by " + detail::amount(report.violation, unit, report.worst_stage);
}

/// A report on a problem with hard constraints: "infeasible: height at the end missed by 0.3 at stage 40".
/// Rows without a name are "equality 0", "terminal equality 1", "terminal constraint 2".
template <HardProblem P>
[[nodiscard]] std::string describe(const P& problem, const HardReport& report) {
  using Kind = HardReport::Kind;
  const int row = report.miss_row;
  std::string name;
  switch (report.kind) {
    case Kind::kNone:
      break;
    case Kind::kEquality:
      name = "equality " + std::to_string(row);
      if constexpr (requires { problem.equality_name(0); }) name = problem.equality_name(row);
      break;
    case Kind::kTerminalEquality:
      name = "terminal equality " + std::to_string(row);
      if constexpr (requires { problem.terminal_equality_name(0); })
        name = problem.terminal_equality_name(row);
      break;
    case Kind::kTerminalConstraint:
      name = "terminal constraint " + std::to_string(row);
      if constexpr (requires { problem.terminal_constraint_name(0); })
        name = problem.terminal_constraint_name(row);
      break;
    case Kind::kConstraint:
      name = "constraint " + std::to_string(row);
      if constexpr (requires { problem.constraint_name(0); }) name = problem.constraint_name(row);
      break;
  }
  if (name.empty() || (usable(report.status) && report.status != SolveStatus::kBudgetSpent))
    return describe(problem, static_cast<const SolveReport&>(report));
  return std::string{to_string(report.status)} + ": " + name + " missed by " +
         detail::amount(report.miss, "", report.miss_stage);
}

}  // namespace chicane::solver
