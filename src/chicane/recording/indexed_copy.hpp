// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "chicane/base/result.hpp"
#include "chicane/telemetry/mcap_reader.hpp"

namespace chicane::recording {

/// Copies a recording into a file with an index and no compression, as browsers read it: also one whose
/// writer was killed. `to` must not exist yet. How much there was to read; fails as read_mcap() and
/// McapWriter do.
[[nodiscard]] Result<telemetry::McapReport> indexed_copy(const std::string& from, const std::string& to);

}  // namespace chicane::recording
