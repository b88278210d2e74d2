// SPDX-License-Identifier: MIT
// One run of a sweep: its settings, the columns that its results keep (none that a clock measured), and the
// command and link that repeat it.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "chicane/base/result.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/sweep/plan.hpp"
#include "chicane/telemetry/metrics.hpp"

namespace chicane::sweep {

/// Column of the results.
struct Column {
  std::string_view name;     ///< name with its unit: "rms_lateral_error_m"
  std::string_view meaning;  ///< one sentence
  /// JSON of the value: a number, true, false, null if nothing was measured, a text, a list of numbers or an
  /// object of counts.
  std::string (*text)(const telemetry::RunSummary&) = nullptr;
};

/// Columns of a run with a search (plan.hpp), before all others: the largest clean value, null if no value
/// was clean, and the number of runs driven for it. All other columns describe the run with that value, or
/// with the smallest value tried if none was clean.
inline constexpr std::string_view kSearchValue = "search_value";
inline constexpr std::string_view kSearchTrials = "search_trials";

/// All columns, in the order of a line.
[[nodiscard]] std::span<const Column> columns();
/// The column of that name; nullptr when there is none.
[[nodiscard]] const Column* find_column(std::string_view name);

// One run of a sweep, as settings: the keys of the schema, and
//
//   scenario                        a scenario by name or file, which all other settings win over
//   speed_mph, speed_mps            the reference of whichever controller drives
//   fault                           NAME@S+S*X, as `drive --fault`; may come several times
//   fault.name, fault.at_s,         the same in parts, for axes; the last two may be left out
//   fault.for_s, fault.strength

/// Whether `text` may be the value of `key` in some run. kNotFound for an unknown key, with a suggestion;
/// kInvalidArgument with the expectation.
[[nodiscard]] Result<void> check_setting(std::string_view key, const std::string& text);

/// The experiment that `settings` ask for; later ones win.
[[nodiscard]] Result<protocol::Request> request_of(const Settings& settings);

/// The scenario of request_of(). Fails as protocol::compose() does.
[[nodiscard]] Result<scenario::Scenario> scenario_of(const Settings& settings);

/// One word of a shell, quoted if it has special characters.
[[nodiscard]] std::string shell_word(const std::string& text);

/// The command that drives it again: `chicane drive --fast --preset weighted --set laps=2 …`.
[[nodiscard]] std::string command_of(const Settings& settings);

/// The address at which the dashboard of `chicane drive` offers to drive it (docs/viewer.md):
/// `http://localhost:4567/#run?preset=weighted&latency_ms=130`. Empty if a link cannot hold it: files,
/// scenarios, faults, and settings that no run could take.
[[nodiscard]] std::string link_of(const Settings& settings);

}  // namespace chicane::sweep
