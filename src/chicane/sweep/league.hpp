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
#include "chicane/telemetry/metrics.hpp"

/// Controllers, each on all tracks, in all cars and disturbances, at the fastest speed at which it is clean.

namespace chicane::sweep {

/// Keys of the axes of a league's plan.
inline constexpr std::string_view kEntryKey = "entry";
inline constexpr std::string_view kDisturbanceKey = "disturbance";

/// A controller that is a program of its own, driven over the wire, at its own speed and in real time.
struct ExternalEntry {
  std::string name{};
  /// Of a shell; starts it. {port}, {latency_ms}, {track} and {chicane} stand for what it shall listen to,
  /// the sleep before each answer, the road, and the program that reads this. A ROS 2 controller has {domain}
  /// in place of {port}: the DDS domain in which the car is.
  std::string command{};
  std::vector<std::string> tracks{}, cars{}, disturbances{};  ///< on which it is tried
};

/// One run of an external entry.
struct ExternalTrial {
  std::string entry{}, command{}, track{}, car{}, disturbance{};
  Settings settings{};    ///< of the world
  std::string why_not{};  ///< it cannot be tried, in one sentence; empty: it can
};

struct League {
  std::string name{};
  Plan plan{};  ///< of our own controllers; its axes are entry, track, car, disturbance
  std::vector<ExternalEntry> externals{};
  std::vector<std::string> tracks{}, cars{};
  std::vector<std::pair<std::string, Settings>> disturbances{};  ///< the first one is the undisturbed world

  /// The runs of the external entries. A disturbance by faults, or by a latency that the command has no place
  /// for, cannot be made for them: the latency is the controller's own, and faults are in our control loop.
  [[nodiscard]] std::vector<ExternalTrial> external_trials() const;
};

/// Port of the original's controllers, which commands without {port} listen to.
inline constexpr int kOriginalPort = 4567;
/// It is a ROS 2 controller: the command has the place {domain}.
[[nodiscard]] bool is_ros(const ExternalTrial& trial);
/// The command with `port` for {port} and {domain}, and what its other places in braces stand for.
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

/// The same of a file; kNotFound when there is none.
[[nodiscard]] Result<League> read_league(const std::string& file);

/// The fastest lap that the plant of a car allows on a track (lap_time/limit.hpp), in seconds; what
/// `settings` say of car and track. Takes up to half a minute. kInvalidArgument also when `stop` is set.
[[nodiscard]] Result<double> bound_of(const Settings& settings, const std::atomic<bool>& stop);

// What a league has found. The runs of our own controllers are the results of a sweep, the same bytes on
// every machine; times that a clock measured, and the limits, stand in a file of their own.

/// One controller on one track, in one car and disturbance.
struct LeagueCell {
  std::string entry{}, track{}, car{}, disturbance{};
  bool is_external = false;
  bool is_clean = false;
  std::map<std::string, double, std::less<>> numbers{};  ///< by column; what was not measured is not there
  std::string why{};                                     ///< it is not clean, in a few words
  std::string command{};                                 ///< that drives it again

  /// Not-a-number where it was not measured.
  [[nodiscard]] double number(std::string_view column) const;
};

struct LeagueResults {
  std::vector<LeagueCell> cells{};                                 ///< in the order of the league
  std::map<std::pair<std::string, std::string>, double> bounds{};  ///< by track and car [s]
  std::uint64_t missing = 0;                                       ///< runs that were not driven yet
};

/// The file beside the results: one JSON object in each line, a trial under its program's command.
class BesideFile {
 public:
  /// As LineFile::open(). kInvalidArgument for the file of another league or plan.
  [[nodiscard]] static Result<BesideFile> open(const std::string& path, const League& league);

  [[nodiscard]] bool has_bound(const std::string& track, const std::string& car) const;
  [[nodiscard]] bool has_trial(const ExternalTrial& trial) const;

  /// Any thread; kIo.
  [[nodiscard]] Result<void> add_bound(const std::string& track, const std::string& car,
                                       const Result<double>& bound);
  [[nodiscard]] Result<void> add_times(std::uint64_t run, const telemetry::RunSummary& summary);
  [[nodiscard]] Result<void> add_trial(const ExternalTrial& trial, const Result<telemetry::RunSummary>& run);

 private:
  LineFile file_{};
  std::vector<std::string> keys_{};  ///< of limits and trials that are there
};

/// Both files. Fails as read_lines() does.
[[nodiscard]] Result<LeagueResults> read_results(const League& league, const std::string& results,
                                                 const std::string& beside);

/// A document (protocol/json.hpp): the standings, a table for each track and car, times that were
/// measured, and the command of each run.
[[nodiscard]] std::string league_document(const League& league, const LeagueResults& results);
/// The same tables for a page of docs/, without the commands.
[[nodiscard]] std::string league_markdown(const League& league, const LeagueResults& results);
/// A row for each run (RFC 4180).
[[nodiscard]] std::string league_csv(const LeagueResults& results);
/// A list of objects, one for each run, with the columns of the CSV table.
[[nodiscard]] std::string league_json(const LeagueResults& results);

}  // namespace chicane::sweep
