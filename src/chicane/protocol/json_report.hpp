// SPDX-License-Identifier: MIT
// Summaries of runs: as JSON for machines, as text for people, and from JSON.
#pragma once

#include <string>
#include <string_view>

#include "chicane/base/result.hpp"
#include "chicane/safety/guard_options.hpp"
#include "chicane/telemetry/metrics.hpp"

namespace chicane::protocol {

/// JSON object with the keys of docs/reference/cli.md; null for values that were not measured. Ends with a
/// line break.
[[nodiscard]] std::string to_json(const telemetry::RunSummary& run);

/// Summary from the JSON of to_json(), for results of runs in other processes. Lacks guard, limit, solver and
/// state_hash. Null becomes not-a-number. Fails with kParse for any other text.
[[nodiscard]] Result<telemetry::RunSummary> read_run(std::string_view json);

/// Text for people: one line for each lap, then the run as a whole.
[[nodiscard]] std::string to_table(const telemetry::RunSummary& run);

/// Names of a run's guard for results, recordings and viewers.
struct GuardFacts {
  std::string mode;  ///< "on", "observe", "off"; empty: not known
  std::string road;  ///< "track", "waypoints"
  int version = 0;   ///< safety::kGuardVersion of the program; 0: not known

  friend bool operator==(const GuardFacts&, const GuardFacts&) = default;
};

/// Names of a guard with these options.
[[nodiscard]] GuardFacts guard_facts(const safety::GuardOptions& guard);

}  // namespace chicane::protocol
