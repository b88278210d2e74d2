// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/telemetry/mcap_reader.hpp"

namespace chicane::recording {

/// What to take of a recording.
struct ExcerptOptions {
  std::vector<std::string> topics{};  ///< empty: all
  double rate = 0.0;                  ///< messages of one topic per second at most [Hz]; 0: all
  bool has_attachments = true;        ///< with attachments and metadata
};

/// Copies a recording into a file with an index and no compression, as browsers read it: also one whose
/// writer was killed. `to` must not exist yet. How much there was to read; fails as read_mcap() and
/// McapWriter do.
[[nodiscard]] Result<telemetry::McapReport> excerpt(const std::string& from, const std::string& to,
                                                    const ExcerptOptions& options);

}  // namespace chicane::recording
