// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "chicane/telemetry/metrics.hpp"

/// What a sweep keeps of a run: nothing that a clock measured.
namespace chicane::sweep {

/// One column of the results.
struct Column {
  std::string_view name;     ///< with its unit: "rms_lateral_error_m"
  std::string_view meaning;  ///< one sentence
  /// As JSON: a number, true, false, null where nothing was measured, a text, a list of numbers or an object
  /// of counts.
  std::string (*text)(const telemetry::RunSummary&) = nullptr;
};

/// Columns of a run that has searched (plan.hpp), before all others: the value found, null where there is
/// none, and how many runs it took. The other columns are those of the run with that value, or of the one
/// with the smallest value.
inline constexpr std::string_view kSearchValue = "search_value";
inline constexpr std::string_view kSearchTrials = "search_trials";

/// All columns, in the order of a line.
[[nodiscard]] std::span<const Column> columns();
/// The column of that name; nullptr when there is none.
[[nodiscard]] const Column* find_column(std::string_view name);

}  // namespace chicane::sweep
