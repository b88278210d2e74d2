// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/result.hpp"
#include "option_row.hpp"
#include "options.hpp"

namespace chicane::apps {

struct Command {
  std::string_view name;
  std::string_view group;  ///< heading in the help
  std::string_view summary;
  std::string_view example;
  ExitCode (*run)(const Options&) = nullptr;
  Rows (*rows)(Options& options) = nullptr;  ///< null: it has no options
  bool is_planning = false;                  ///< plans laps or finds limits, which it may cache
};

/// All commands, in the order of the help, group by group.
[[nodiscard]] std::span<const Command> commands();

/// Options of a command, with the planning options if it plans; their targets are in `options`.
[[nodiscard]] Rows options_of(const Command& command, Options& options);

[[nodiscard]] ExitCode drive(const Options& options);
[[nodiscard]] ExitCode serve(const Options& options);
[[nodiscard]] ExitCode simulate(const Options& options);
[[nodiscard]] ExitCode limit(const Options& options);
[[nodiscard]] ExitCode check(const Options& options);
[[nodiscard]] ExitCode list(const Options& options);
/// Shelves that `chicane list` accepts.
[[nodiscard]] std::vector<std::string> list_names();
/// Name on a shelf, and its meaning.
struct ListEntry {
  std::string name, meaning;
};
[[nodiscard]] std::vector<ListEntry> list_entries(std::string_view shelf);
[[nodiscard]] ExitCode completion(const Options& options);
[[nodiscard]] ExitCode manual(const Options& options);

/// Reads a log of another program into a recording, `output`.
using LogConverter = Result<void> (*)(const std::string& file, const Options& options,
                                      const std::string& output);
/// Shows recordings, verifies them or drives on from within one. A log of another program is in_lab()'s.
[[nodiscard]] ExitCode replay(const Options& options);
/// The same with logs of other programs, which `convert` reads; null: there are none.
[[nodiscard]] ExitCode replay_logs(const Options& options, LogConverter convert);
/// A LogConverter of chicane-lab: positions, speeds and commands of the car. --track gives the road for laps
/// and progress; without it a lap ends where the car has been before. Values that the log lacks are NaN. One
/// sentence on stderr sums up the findings. kParse for a file that is neither a ROS 2 bag with odometry nor a
/// CSV table of a car.
[[nodiscard]] Result<void> convert_foreign_log(const std::string& file, const Options& options,
                                               const std::string& output);

/// Becomes the program chicane-ros (ros/main.cpp); kUsage where that is not installed.
[[nodiscard]] ExitCode ros(const Options& options);
/// Becomes the program chicane-bench (bench/program); kEnvironment where that is not built.
[[nodiscard]] ExitCode bench(const Options& options);
/// Becomes the program chicane-lab (lab/main.cpp); kEnvironment where that is not built.
[[nodiscard]] ExitCode in_lab(const Options& options);

/// The commands of chicane-lab: many runs, logs and reports.
[[nodiscard]] ExitCode import_road(const Options& options);
[[nodiscard]] ExitCode identify_car(const Options& options);
[[nodiscard]] ExitCode report_logs(const Options& options);
[[nodiscard]] ExitCode make_video(const Options& options);
[[nodiscard]] ExitCode drive_sweep(const Options& options);
[[nodiscard]] ExitCode merge_results(const Options& options);
[[nodiscard]] ExitCode try_claims(const Options& options);
[[nodiscard]] ExitCode compare_league(const Options& options);
[[nodiscard]] ExitCode tune(const Options& options);
[[nodiscard]] ExitCode campaign(const Options& options);
[[nodiscard]] ExitCode recover(const Options& options);
[[nodiscard]] ExitCode lane_change(const Options& options);

/// Says the error on stderr; which exit code it is.
[[nodiscard]] ExitCode report(const Error& error);

// The options of each command as rows whose targets are in `options`.

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
