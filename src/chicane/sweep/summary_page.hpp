// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "chicane/base/result.hpp"

namespace chicane::sweep {

/// The results of a sweep as a document (protocol/json.hpp).
struct SummaryDocument {
  std::uint64_t runs = 0;
  std::string text{};
};

/// Sums up the results of a sweep, one file or those of its parts: what was driven, one table for each axis,
/// heat maps of pairs of axes, distributions, and the runs with the command that drives each (the first
/// kMostListed). Runs that are missing are left out, and counted. Fails as read_lines() does.
inline constexpr std::size_t kMostListed = 2000;
[[nodiscard]] Result<SummaryDocument> summary_document(const std::vector<std::string>& results);

/// Writes the heat maps of a sweep in letters into a page of Markdown, between the lines
/// `<!-- sweep: NAME -->` and `<!-- end of sweep -->`, which are added where they are not there. The number
/// of runs; fails as summary_document() does; kParse for a page without the second line, kIo.
[[nodiscard]] Result<std::uint64_t> write_maps(const std::vector<std::string>& results,
                                               const std::string& page);

}  // namespace chicane::sweep
