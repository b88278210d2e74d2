// SPDX-License-Identifier: MIT
// Commands of the programs `chicane` and `chicane-lab`: one table for help, completion and manual page, and
// the rows of options of each command.
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

/// Function that runs a command.
using Action = ExitCode(const Options& options);
/// Function that makes the rows of options of a command; their targets are in `options`.
using RowsOf = Rows(Options& options);

/// Command of the program.
struct Command {
  std::string_view name;     ///< name as typed
  std::string_view group;    ///< heading in the help
  std::string_view summary;  ///< one line of the help
  std::string_view example;  ///< a command line
  Action* run = nullptr;
  RowsOf* rows = nullptr;    ///< null: the command has no options
  bool is_planning = false;  ///< plans laps or finds limits, and keeps them in a cache
};

/// Commands of `chicane`.
Action drive, serve, simulate, replay, limit, check, list, completion, manual;
/// Commands of `chicane-lab`: many runs, logs and reports.
Action replay_any_logs, report_logs, make_video, compare_league, drive_sweep, merge_results, tune, campaign,
    recover, lane_change, try_claims, import_road, identify_car;
/// Commands that another program runs, which takes the place of this process: chicane-lab (lab/main.cpp) and
/// chicane-bench (bench/program), kEnvironment if they are not built; chicane-ros (ros/main.cpp), kUsage if
/// it is not installed.
Action in_lab, bench, ros;

/// Options of all commands.
RowsOf drive_rows, serve_rows, simulate_rows, replay_rows, report_rows, video_rows, limit_rows, league_rows,
    sweep_rows, merge_rows, tune_rows, campaign_rows, recover_rows, lane_change_rows, claims_rows, bench_rows,
    check_rows, list_rows, import_rows, identify_rows, ros_rows, completion_rows;

/// All commands in the order of the help, with the actions of `chicane` or of `chicane-lab`.
template <bool kIsLab>
inline constexpr Command kCommands[] = {
    {"drive", "Drive", "Controller and simulator in one process, with a dashboard",
     "chicane drive --preset sixty-mph --track lakeside --laps 2 --fast", drive, drive_rows, true},
    {"serve", "Drive", "Controller for an external simulator, as the original program was",
     "chicane serve --preset weighted --port 4567", serve, serve_rows, true},
    {"simulate", "Drive", "Simulator for an external controller, as the original game was",
     "chicane simulate --connect ws://127.0.0.1:4567 --track lakeside --laps 2", simulate, simulate_rows},
    {"replay", "Look", "Show recorded runs, verify them bit for bit, or drive on from within one",
     "chicane replay run.mcap --branch-at 12 --set plant_options.friction_scale=0.5",
     kIsLab ? replay_any_logs : replay, replay_rows, true},
    {"report", "Look", "Recorded runs as one HTML page that needs nothing else",
     "chicane report run.mcap -o run.html", kIsLab ? report_logs : in_lab, report_rows},
    {"video", "Look", "Recorded lap as a film, with the ghost of another one",
     "chicane video run.mcap -o lap.mp4 --ghost other.mcap", kIsLab ? make_video : in_lab, video_rows},
    {"limit", "Compare", "Fastest lap and racing line of a car on a track",
     "chicane limit --track lakeside --car road-car --csv line.csv", limit, limit_rows, true},
    {"league", "Compare", "Controllers and programs compared on tracks, in cars and disturbances",
     "chicane league studies/leagues/shipped.yaml -o league.html", kIsLab ? compare_league : in_lab,
     league_rows, true},
    {"sweep", "Compare", "Many runs from one plan, on many threads and machines",
     "chicane sweep studies/plans/speed-and-latency.yaml --jobs 4", kIsLab ? drive_sweep : in_lab, sweep_rows,
     true},
    {"merge", "Compare", "Results of the parts of a sweep as one file",
     "chicane merge results.*-of-*.jsonl -o results.jsonl", kIsLab ? merge_results : in_lab, merge_rows},
    {"tune", "Compare", "Fastest clean tuning of a preset, searched",
     "chicane tune --preset weighted --evaluations 2000 -o tuned.yaml", kIsLab ? tune : in_lab, tune_rows,
     true},
    {"campaign", "Prove", "Faults at every moment of a lap: where the car leaves the road",
     "chicane campaign --pairs --onsets 3 --for-s 1,2,inf --preset default,race --tracks all --results "
     "campaign.jsonl",
     kIsLab ? campaign : in_lab, campaign_rows, true},
    {"recover", "Prove", "Recovery from anywhere beside the road: whether the car comes back",
     "chicane recover --tracks lakeside,oval --starts 120", kIsLab ? recover : in_lab, recover_rows, true},
    {"lane-change", "Prove", "Highest entry speed of the severe double lane change, ISO 3888-2",
     "chicane lane-change --cars road-car --presets default,stanley", kIsLab ? lane_change : in_lab,
     lane_change_rows},
    {"claims", "Prove", "Claims of five write-ups, each tried on its own terms", "chicane claims B7 D9",
     kIsLab ? try_claims : in_lab, claims_rows, true},
    {"bench", "Prove", "Times of solver and control step on this machine, beside Ipopt's",
     "chicane bench --instances 200 --horizons 10,20", bench, bench_rows},
    {"check", "Tools", "Validate scenarios, presets, cars and tracks, and explain what is wrong",
     "chicane check data/presets/weighted.yaml data/tracks/lakeside.csv --car road-car", check, check_rows,
     true},
    {"list", "Tools", "Presets, tracks, cars, scenarios, controllers and parameters", "chicane list presets",
     list, list_rows},
    {"import", "Tools", "Road from a map, cones, coordinates or another program's file",
     "chicane import map.yaml -o hall.csv --preview hall.html", kIsLab ? import_road : in_lab, import_rows},
    {"identify", "Tools", "Model of a car from logs of driving it",
     "chicane identify run.mcap --car road-car -o mine.yaml", kIsLab ? identify_car : in_lab, identify_rows},
    {"ros", "Tools", "Controller as a ROS 2 node without ROS, or the simulator for one",
     "chicane ros --car f1tenth --track oval --domain 7", ros, ros_rows, true},
    {"completion", "Tools", "Script that completes command lines, for bash, zsh or fish",
     "source <(chicane completion bash)", completion, completion_rows},
    {"manual", "Tools", "Manual page, as roff", "chicane manual | man -l -", manual, nullptr},
};

/// Commands of `chicane`.
[[nodiscard]] inline std::span<const Command> commands() { return kCommands<false>; }

/// Runs the command that the options name, in `chicane` or in `chicane-lab`.
template <bool kIsLab>
[[nodiscard]] ExitCode do_command(const Options& options) {
  for (const Command& command : kCommands<kIsLab>)
    if (command.name == options.command) return command.run(options);
  return kUsage;
}

/// Rows of options of a command, with --no-cache if it plans; their targets are in `options`.
[[nodiscard]] Rows options_of(const Command& command, Options& options);

/// Names of the shelves of `chicane list`.
[[nodiscard]] std::vector<std::string> list_names();
/// Name on a shelf, and its meaning.
struct ListEntry {
  std::string name, meaning;
};
/// All names on a shelf; none for an unknown shelf.
[[nodiscard]] std::vector<ListEntry> list_entries(std::string_view shelf);

/// Function that converts a log of another program to the recording `output`.
using LogConverter = Result<void> (*)(const std::string& file, const Options& options,
                                      const std::string& output);
/// Runs `chicane replay`. `convert` reads logs of other programs; null: no file is such a log.
[[nodiscard]] ExitCode replay_logs(const Options& options, LogConverter convert);

/// Prints an error on stderr, and returns its exit code.
[[nodiscard]] ExitCode report(const Error& error);

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
/// Row of --set. Pre: after all other rows of settings, because the last setting wins.
[[nodiscard]] OptionRow set_row(Options& options);
/// Rows of --json, --track and --jobs.
[[nodiscard]] OptionRow json_row(Options& options);
[[nodiscard]] OptionRow track_row();
[[nodiscard]] OptionRow jobs_row(Options& options);

}  // namespace chicane::apps
