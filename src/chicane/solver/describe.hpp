// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <string>

#include "chicane/solver/problem.hpp"
#include "chicane/solver/solution.hpp"

namespace chicane::solver {

/// A report in one sentence, in the problem's own words: "infeasible: right edge exceeded by 0.12 m at stage
/// 14". Constraints without a name are "constraint 1". Allocates: not for the control loop.
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
  char amount[32];
  std::snprintf(amount, sizeof(amount), "%.3g", report.violation);
  text += ": " + name + " exceeded by " + amount;
  if (!unit.empty()) text += " " + unit;
  return text + " at stage " + std::to_string(report.worst_stage);
}

}  // namespace chicane::solver
