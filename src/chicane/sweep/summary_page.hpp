// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "chicane/base/result.hpp"

namespace chicane::sweep {

struct PageSummary {
  std::uint64_t runs = 0;
  std::size_t bytes = 0;  ///< of the page
};

/// Writes the results of a sweep, one file or those of its parts, as one HTML page that needs neither network
/// nor program: what was driven, one table for each axis, heat maps of pairs of axes, distributions, and the
/// runs with the command that drives each (the first kMostListed). Runs that are missing are left out, and
/// counted. Fails as read_lines() does; kIo.
inline constexpr std::size_t kMostListed = 2000;
[[nodiscard]] Result<PageSummary> write_page(const std::vector<std::string>& results,
                                             const std::string& page);

/// Writes the heat maps of a sweep in letters into a page of Markdown, between the lines
/// `<!-- sweep: NAME -->` and `<!-- end of sweep -->`, which are added where they are not there. Fails as
/// write_page() does; kParse for a page without the second line.
[[nodiscard]] Result<PageSummary> write_maps(const std::vector<std::string>& results,
                                             const std::string& page);

}  // namespace chicane::sweep
