// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "chicane/base/result.hpp"

/// Runs of a sweep that differ in one setting alone, beside each other.
namespace chicane::sweep {

/// A lap that takes longer by this share is worse.
inline constexpr double kSlower = 0.01;

struct Comparison {
  std::string table{};        ///< of Markdown, a row for each pair
  std::uint64_t pairs = 0;    ///< of which both runs are there
  std::uint64_t worse = 0;    ///< of them
  std::uint64_t missing = 0;  ///< runs without the other one
};

/// Compares each run with the one that has `value` for `key` and is otherwise the same: laps, times off the
/// road, and the guard's reasons. A run is worse where it leaves the road or does not complete its laps and
/// the other one does neither, or where its laps take kSlower longer in the mean. Needs the columns
/// completed, off_track_events and lap_times_s; guard_reasons is shown where it is kept. kInvalidArgument for
/// a key that is no axis; otherwise fails as read_lines() does.
[[nodiscard]] Result<Comparison> compare(const std::vector<std::string>& results, const std::string& key,
                                         const std::string& value);

}  // namespace chicane::sweep
