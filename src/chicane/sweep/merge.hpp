// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "chicane/base/result.hpp"

namespace chicane::sweep {

struct MergeSummary {
  std::uint64_t runs = 0;
  std::uint64_t repeated = 0;  ///< that came twice, with the same results
};

/// Joins the files of a sweep's shards, in whatever order and however many, into `output`: the first line,
/// then one line for each run in the order of the plan, the same bytes whichever process drove which run.
/// `output` appears whole or not at all, and may be one of the files.
///
/// kInvalidArgument for files of different plans or programs, for missing runs, which are named, and for a
/// run with two different results; kParse for lines that are none; kIo.
[[nodiscard]] Result<MergeSummary> merge(const std::vector<std::string>& files, const std::string& output);

/// "17-20, 33 and 5 more", of numbers that rise.
[[nodiscard]] std::string ranges_text(const std::vector<std::uint64_t>& numbers, std::uint64_t more = 0);

}  // namespace chicane::sweep
