// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "chicane/safety/guard_options.hpp"

namespace chicane::protocol {

/// Names of a run's guard for results, recordings and viewers.
struct GuardFacts {
  std::string mode;  ///< "on", "observe", "off"; empty: not known
  std::string road;  ///< "track", "waypoints"
  int version = 0;   ///< safety::kGuardVersion of the program; 0: not known

  friend bool operator==(const GuardFacts&, const GuardFacts&) = default;
};

[[nodiscard]] GuardFacts guard_facts(const safety::GuardOptions& guard);

}  // namespace chicane::protocol
