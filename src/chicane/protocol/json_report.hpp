// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "chicane/telemetry/metrics.hpp"

namespace chicane::protocol {

/// One JSON object for machines, keys as in docs/cli.md; null where nothing was measured. Ends with a line
/// break.
[[nodiscard]] std::string to_json(const telemetry::RunSummary& run);

/// The same for people: one line for each lap, then what the run was like.
[[nodiscard]] std::string to_table(const telemetry::RunSummary& run);

}  // namespace chicane::protocol
