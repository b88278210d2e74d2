// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "chicane/recording/branch.hpp"
#include "chicane/recording/replay.hpp"

/// What `chicane replay` says; the keys of the JSON are a contract (docs/recording.md).
namespace chicane::apps {

[[nodiscard]] std::string to_json(const recording::ReplayReport& report);
[[nodiscard]] std::string to_text(const recording::ReplayReport& report);

[[nodiscard]] std::string to_json(const recording::BranchReport& report);
/// Two columns: what was, and what comes of `settings`.
[[nodiscard]] std::string to_text(const recording::BranchReport& report,
                                  const std::vector<std::pair<std::string, std::string>>& settings);

}  // namespace chicane::apps
