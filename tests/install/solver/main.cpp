// SPDX-License-Identifier: MIT
#include <chicane/base/instruction_set.hpp>
#include <chicane/version.hpp>
#include <cmath>
#include <cstdio>

#include "puck_solver.hpp"

/// Every instruction set of this processor finds the same plan.
int main() {
  using chicane::InstructionSet;
  std::printf("chicane %s\n", chicane::kVersion.data());
  for (const InstructionSet set :
       {InstructionSet::kBaseline, InstructionSet::kAvx2, InstructionSet::kAvx512, InstructionSet::kNeon}) {
    if (!chicane::is_available(set)) continue;
    const auto solver =
        chicane::with_instructions(set, [](auto arch) { return make_puck_solver<decltype(arch)>(); });
    const Plan plan = solver->solve();
    std::printf("%s: %s, at %.3f m with %.3f m/s\n", to_string(set).data(),
                to_string(plan.report.status).data(), plan.position, plan.speed);
    if (!usable(plan.report.status) || std::fabs(plan.position - 1.0) > 0.01 || std::fabs(plan.speed) > 0.01)
      return 1;
  }
  return 0;
}
