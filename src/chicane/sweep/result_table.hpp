// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "chicane/base/result.hpp"

/// Results of a sweep as tables: a row for each run, or runs that differ in one setting alone beside each
/// other.
namespace chicane::sweep {

/// A value of RFC 4180, in quotes where it has to be.
[[nodiscard]] std::string csv_cell(const std::string& text);

/// Writes a file of results as comma separated values (RFC 4180): `run`, the keys of the axes, the columns.
/// Lists stand in quotes, as JSON; what was not measured is empty. Memory does not grow with the file.
/// kParse, kIo.
[[nodiscard]] Result<void> write_csv(const std::string& results, const std::string& csv);

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
