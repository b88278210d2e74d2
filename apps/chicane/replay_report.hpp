// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "chicane/runtime/branch.hpp"
#include "chicane/runtime/replay.hpp"

/// What `chicane replay` says; the keys of the JSON are a contract (docs/recording.md).
namespace chicane::apps {

[[nodiscard]] std::string to_json(const runtime::ReplayReport& report);
[[nodiscard]] std::string to_text(const runtime::ReplayReport& report);

[[nodiscard]] std::string to_json(const runtime::BranchReport& report);
/// Two columns: what was, and what comes of `settings`.
[[nodiscard]] std::string to_text(const runtime::BranchReport& report,
                                  const std::vector<std::pair<std::string, std::string>>& settings);

}  // namespace chicane::apps
