// SPDX-License-Identifier: MIT
// A league compares controllers, ours and those of other programs, on the same tracks, in the same cars and
// under the same disturbances. Ours drive at the highest speed at which all laps are driven and no tyre
// leaves the road.
#pragma once

#include <atomic>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/sweep/plan.hpp"
#include "chicane/sweep/result_file.hpp"
#include "chicane/sweep/result_table.hpp"
#include "chicane/telemetry/metrics.hpp"

namespace chicane::sweep {

/// Keys of the axes of a league's plan.
inline constexpr std::string_view kEntryKey = "entry";
inline constexpr std::string_view kDisturbanceKey = "disturbance";

/// Controller that is another program. This program simulates its car in real time, and gets its commands
/// over a socket.
struct ExternalEntry {
  std::string name{};
  /// Command of a shell that starts the program, with places that filled() replaces: {port} by the port to
  /// listen on, {latency_ms} by the sleep before each answer, {track} by the road, {chicane} by this program.
  /// The command of a ROS 2 controller has {domain}, the DDS domain of the car, in place of {port}.
  std::string command{};
  std::vector<std::string> tracks{}, cars{}, disturbances{};  ///< where and how it drives
};

/// One run of an external entry: a controller on a track, in a car and disturbance.
struct ExternalTrial {
  std::string entry{}, command{}, track{}, car{}, disturbance{};
  Settings settings{};    ///< settings of its scenario
  std::string why_not{};  ///< reason why the trial is impossible, a sentence; empty: it is possible
};

/// Plan of a league.
struct League {
  std::string name{};
  Plan plan{};  ///< runs of our own controllers; axes: entry, track, car, disturbance
  std::vector<ExternalEntry> externals{};  ///< controllers that are other programs
  std::vector<std::string> tracks{}, cars{};
  /// Settings by name; the first one stands for no disturbance.
  std::vector<std::pair<std::string, Settings>> disturbances{};

  /// Trials of the external entries. Disturbances by faults are impossible, because faults act in our control
  /// loop. Disturbances by latency need {latency_ms} in the command, because the program itself sleeps,
  /// except of ROS 2 controllers.
  [[nodiscard]] std::vector<ExternalTrial> external_trials() const;
};

/// Port on which programs without {port} in their command listen: that of the Udacity simulator.
inline constexpr int kOriginalPort = 4567;
/// Whether the program of a trial is a ROS 2 controller: its command contains {domain}.
[[nodiscard]] bool is_ros(const ExternalTrial& trial);
/// Command of a trial with all places in braces replaced: {port} and {domain} by `port`, {chicane} by
/// `program`.
[[nodiscard]] std::string filled(const ExternalTrial& trial, int port,
                                 const std::string& program = "chicane");

/// Adds an external entry, named by its command, on all tracks, in all cars and disturbances.
void add_external(League& league, const std::string& command);

/// Reads a league (docs/sweep.md):
///
///     name: mine against theirs
///     settings: {laps: 2, guard.mode: "off"}            # of all runs
///     search: {speed_mps: {from: 8, to: 80}}            # as in a plan; optional, default as shown
///     entries:
///       mine: {preset: mine.yaml}                       # settings, as in a preset
///       theirs: {server: "./mpc {port}", tracks: [lakeside]}
///           # external program; tracks, cars, disturbances: optional, default all
///     tracks: [lakeside, oval]
///     cars: [udacity, road-car]
///     disturbances: {none: {}, wet: {plant_options.friction_scale: 0.8}}
///
/// kParse lists all faults, each with its line.
[[nodiscard]] Result<League> parse_league(std::string_view text, const std::string& file);

/// Reads a league from a file; kNotFound without one.
[[nodiscard]] Result<League> read_league(const std::string& file);

/// Time of the fastest lap that the plant allows for car and track of `settings` (lap_time/limit.hpp) [s].
/// Takes up to half a minute. kInvalidArgument also when `stop` is set.
[[nodiscard]] Result<double> bound_of(const Settings& settings, const std::atomic<bool>& stop);

// A league has two files of results: the file of a sweep with the runs of our own controllers, the same bytes
// on every machine; and a BesideFile with limits, external trials and measured times.

/// Result of one controller on one track, in one car and disturbance.
struct LeagueCell {
  std::string entry{}, track{}, car{}, disturbance{};
  bool is_external = false;                              ///< its controller is another program
  bool is_clean = false;                                 ///< all laps driven, no tyre off the road
  std::map<std::string, double, std::less<>> numbers{};  ///< values by column; only measured ones
  std::string why{};      ///< reason why it is not clean, in a few words; empty: it is
  std::string command{};  ///< command line that repeats the run

  /// Number of a column; NaN if it was not measured.
  [[nodiscard]] double number(std::string_view column) const;
};

/// Results of a league, from both files.
struct LeagueResults {
  std::vector<LeagueCell> cells{};  ///< cells in the order of the league
  /// Times of the fastest laps by track and car [s].
  std::map<std::pair<std::string, std::string>, double> bounds{};
  std::uint64_t missing = 0;  ///< number of our own runs not driven yet
};

/// File beside the results of the sweep, with limits, external trials and measured times: one JSON object in
/// each line. A trial is identified by its command, track, car and disturbance.
class BesideFile {
 public:
  /// Opens as LineFile::open() does. kInvalidArgument for the file of another league or plan.
  [[nodiscard]] static Result<BesideFile> open(const std::string& path, const League& league);

  /// Whether the file had the limit of a car on a track when it was opened.
  [[nodiscard]] bool has_bound(const std::string& track, const std::string& car) const;
  /// Whether the file had the result of a trial when it was opened.
  [[nodiscard]] bool has_trial(const ExternalTrial& trial) const;

  /// Adds the limit of a car on a track. This and the two functions below fail with kIo, and may be called
  /// from any thread.
  [[nodiscard]] Result<void> add_bound(const std::string& track, const std::string& car,
                                       const Result<double>& bound);
  /// Adds the times of our controller in a run of the sweep.
  [[nodiscard]] Result<void> add_times(std::uint64_t run, const telemetry::RunSummary& summary);
  /// Adds the result of an external trial.
  [[nodiscard]] Result<void> add_trial(const ExternalTrial& trial, const Result<telemetry::RunSummary>& run);

 private:
  LineFile file_{};
  /// Keys, as JSON, of the limits and trials in the file when it was opened.
  std::vector<std::string> keys_{};
};

/// Reads both files. Fails as read_runs() does.
[[nodiscard]] Result<LeagueResults> read_results(const League& league, const std::string& results,
                                                 const std::string& beside);

/// HTML document of a league (protocol/json.hpp): standings, a table for each track and car, measured times,
/// and the command of each run.
[[nodiscard]] std::string league_document(const League& league, const LeagueResults& results);
/// The tables of league_document() as Markdown, without the commands.
[[nodiscard]] std::string league_markdown(const League& league, const LeagueResults& results);
/// Table with a row for each run, for CSV and JSON.
[[nodiscard]] ResultTable league_runs(const League& league, const LeagueResults& results);

}  // namespace chicane::sweep
