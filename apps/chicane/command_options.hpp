// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <utility>

#include "option_row.hpp"

/// The options of each command as rows whose targets are in `options`.
namespace chicane::apps {

[[nodiscard]] Rows drive_rows(Options& options);
[[nodiscard]] Rows serve_rows(Options& options);
[[nodiscard]] Rows simulate_rows(Options& options);
[[nodiscard]] Rows ros_rows(Options& options);
[[nodiscard]] Rows limit_rows(Options& options);
[[nodiscard]] Rows replay_rows(Options& options);
[[nodiscard]] Rows report_rows(Options& options);
[[nodiscard]] Rows video_rows(Options& options);
[[nodiscard]] Rows sweep_rows(Options& options);
[[nodiscard]] Rows league_rows(Options& options);
[[nodiscard]] Rows claims_rows(Options& options);
[[nodiscard]] Rows tune_rows(Options& options);
[[nodiscard]] Rows merge_rows(Options& options);
[[nodiscard]] Rows campaign_rows(Options& options);
[[nodiscard]] Rows recover_rows(Options& options);
[[nodiscard]] Rows lane_change_rows(Options& options);
[[nodiscard]] Rows import_rows(Options& options);
[[nodiscard]] Rows identify_rows(Options& options);
[[nodiscard]] Rows check_rows(Options& options);
[[nodiscard]] Rows list_rows(Options& options);
[[nodiscard]] Rows bench_rows(Options& options);
[[nodiscard]] Rows completion_rows(Options& options);

/// Rows of several groups, one after the other.
[[nodiscard]] inline Rows joined(std::initializer_list<Rows> groups) {
  Rows all;
  for (const Rows& group : groups) all.insert(all.end(), group.begin(), group.end());
  return all;
}

/// Rows of preset, controller, car and speed.
[[nodiscard]] Rows controller_rows(Options& options);
/// Rows of track, laps and seed.
[[nodiscard]] Rows world_rows();
/// --set, behind all other settings: the last one wins.
[[nodiscard]] OptionRow set_row(Options& options);
[[nodiscard]] OptionRow json_row(Options& options);
[[nodiscard]] OptionRow track_row();
/// --jobs.
[[nodiscard]] OptionRow jobs_row(Options& options);

}  // namespace chicane::apps
