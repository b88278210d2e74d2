// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "chicane/base/result.hpp"
#include "chicane/telemetry/metrics.hpp"

namespace chicane::protocol {

/// One JSON object for machines, keys as in docs/reference/cli.md; null where nothing was measured. Ends with
/// a line break.
[[nodiscard]] std::string to_json(const telemetry::RunSummary& run);

/// What to_json() wrote, for results of runs in other processes: all but guard, limit, solver and state_hash.
/// Null is not-a-number. kParse where it is no such object.
[[nodiscard]] Result<telemetry::RunSummary> read_run(std::string_view json);

/// The same for people: one line for each lap, then what the run was like.
[[nodiscard]] std::string to_table(const telemetry::RunSummary& run);

}  // namespace chicane::protocol
