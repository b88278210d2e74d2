// SPDX-License-Identifier: MIT
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

/// A league compares controllers, ours and those of other programs, on the same tracks, in the same cars and
/// under the same disturbances. Ours drive at the highest speed at which a run is clean: all laps driven, no
/// tyre off the road.

namespace chicane::sweep {

/// Keys of the axes of a league's plan.
inline constexpr std::string_view kEntryKey = "entry";
inline constexpr std::string_view kDisturbanceKey = "disturbance";

/// A controller that is another program. The car is simulated here, in real time, and commanded over a
/// socket.
struct ExternalEntry {
  std::string name{};
  /// Command of a shell that starts the program. Replaced in it: {port} by the port to listen on,
  /// {latency_ms} by the sleep before each answer, {track} by the road, {chicane} by this program. A ROS 2
  /// controller has {domain}, the DDS domain of the car, in place of {port}.
  std::string command{};
  std::vector<std::string> tracks{}, cars{}, disturbances{};  ///< names of its trials
};

/// One run of an external entry.
struct ExternalTrial {
  std::string entry{}, command{}, track{}, car{}, disturbance{};
  Settings settings{};    ///< scenario of the run
  std::string why_not{};  ///< sentence why this trial is impossible; empty: it is possible
};

struct League {
  std::string name{};
  Plan plan{};  ///< runs of our own controllers; axes: entry, track, car, disturbance
  std::vector<ExternalEntry> externals{};
  std::vector<std::string> tracks{}, cars{};
  std::vector<std::pair<std::string, Settings>> disturbances{};  ///< the first one is the undisturbed world

  /// Trials of the external entries. A disturbance by faults is impossible for them, because faults act in
  /// our control loop; one by latency needs {latency_ms} in the command, because the latency is the program's
  /// own.
  [[nodiscard]] std::vector<ExternalTrial> external_trials() const;
};

/// Port of the original simulator's controllers: commands without {port} listen on it.
inline constexpr int kOriginalPort = 4567;
/// Whether the trial is of a ROS 2 controller: its command contains {domain}.
[[nodiscard]] bool is_ros(const ExternalTrial& trial);
/// The command of a trial with all places in braces filled in: {port} and {domain} by `port`.
[[nodiscard]] std::string filled(const ExternalTrial& trial, int port,
                                 const std::string& program = "chicane");

/// Adds `command` as an entry of its own name, on all tracks, in all cars and disturbances.
void add_external(League& league, const std::string& command);

/// Reads a league (docs/sweep.md):
///
///     name: mine against theirs
///     settings: {laps: 2, guard.mode: "off"}            # of all runs
///     search: {speed_mps: {from: 8, to: 80}}            # as in a plan; this when left out
///     entries:
///       mine: {preset: mine.yaml}                       # settings, as in a preset
///       theirs: {server: "./mpc {port}", tracks: [lakeside]}   # a program; tracks, cars, disturbances: some
///     tracks: [lakeside, oval]
///     cars: [udacity, road-car]
///     disturbances: {none: {}, wet: {plant_options.friction_scale: 0.8}}
///
/// kParse lists all faults, each with its line.
[[nodiscard]] Result<League> parse_league(std::string_view text, const std::string& file);

/// Reads a league from a file; kNotFound without one.
[[nodiscard]] Result<League> read_league(const std::string& file);

/// Fastest lap that the plant allows (lap_time/limit.hpp) for car and track of `settings` [s]. Takes up to
/// half a minute. kInvalidArgument also when `stop` is set.
[[nodiscard]] Result<double> bound_of(const Settings& settings, const std::atomic<bool>& stop);

// Results of a league are two files: runs of our own controllers as a sweep has them, the same bytes on every
// machine; and limits, external trials and measured times in a BesideFile.

/// One controller on one track, in one car and disturbance.
struct LeagueCell {
  std::string entry{}, track{}, car{}, disturbance{};
  bool is_external = false;
  bool is_clean = false;
  std::map<std::string, double, std::less<>> numbers{};  ///< values by column; only measured ones
  std::string why{};                                     ///< reason why it is not clean, in a few words
  std::string command{};                                 ///< command line that repeats the run

  /// The number of a column; NaN if it was not measured.
  [[nodiscard]] double number(std::string_view column) const;
};

struct LeagueResults {
  std::vector<LeagueCell> cells{};                                 ///< cells in the order of the league
  std::map<std::pair<std::string, std::string>, double> bounds{};  ///< lap times by track and car [s]
  std::uint64_t missing = 0;                                       ///< number of runs not driven yet
};

/// File of limits, external trials and measured times: one JSON object in each line. The key of a trial is
/// its program's command.
class BesideFile {
 public:
  /// Opens as LineFile::open() does. kInvalidArgument for the file of another league or plan.
  [[nodiscard]] static Result<BesideFile> open(const std::string& path, const League& league);

  [[nodiscard]] bool has_bound(const std::string& track, const std::string& car) const;
  [[nodiscard]] bool has_trial(const ExternalTrial& trial) const;

  /// Adds the limit of a car on a track. kIo. Any thread.
  [[nodiscard]] Result<void> add_bound(const std::string& track, const std::string& car,
                                       const Result<double>& bound);
  [[nodiscard]] Result<void> add_times(std::uint64_t run, const telemetry::RunSummary& summary);
  [[nodiscard]] Result<void> add_trial(const ExternalTrial& trial, const Result<telemetry::RunSummary>& run);

 private:
  LineFile file_{};
  std::vector<std::string> keys_{};  ///< keys of the limits and trials in the file
};

/// Reads both files. Fails as read_runs() does.
[[nodiscard]] Result<LeagueResults> read_results(const League& league, const std::string& results,
                                                 const std::string& beside);

/// Document for the web page (protocol/json.hpp): standings, a table for each track and car, measured times,
/// and the command of each run.
[[nodiscard]] std::string league_document(const League& league, const LeagueResults& results);
/// The tables of league_document() as Markdown, without the commands.
[[nodiscard]] std::string league_markdown(const League& league, const LeagueResults& results);
/// A row for each run, for programs.
[[nodiscard]] ResultTable league_runs(const League& league, const LeagueResults& results);

}  // namespace chicane::sweep
