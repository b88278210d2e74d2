// SPDX-License-Identifier: MIT
// Leagues: reads the file of a league, makes the plan of our controllers, and keeps the results of other
// programs in a file beside those of the sweep.
#include "chicane/sweep/league.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "chicane/base/text.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/protocol/yaml_codec.hpp"
#include "chicane/run/make.hpp"
#include "chicane/run/plan_cache.hpp"
#include "chicane/sweep/plan_codec.hpp"
#include "chicane/sweep/trial.hpp"

namespace chicane::sweep {
namespace {

using protocol::YamlEntry;
using protocol::YamlNode;

/// Columns of the results that the page and the tables show.
constexpr std::array kKept{"completed",
                           "end_reason",
                           "laps_completed",
                           "off_track_events",
                           "lap_time_s",
                           "mean_speed_mps",
                           "top_speed_mps",
                           "rms_lateral_error_m",
                           "min_edge_distance_m",
                           "max_lateral_acceleration_mps2",
                           "steering_rate_rms_radps",
                           "mean_iterations",
                           "not_usable"};

/// Reader of one league; collects the faults of the file.
class LeagueReader : private detail::SettingsReader {
 public:
  using SettingsReader::SettingsReader;

  Result<League> read(const YamlNode& root) {
    // Speeds from which every controller is clean on a good road up to more than any car here reaches;
    // chosen.
    league_.plan.search = Search{.key = "speed_mps", .from = 8.0, .to = 80.0, .factor = 1.4};
    std::string about;
    read_map(root, "file", "a league with entries, tracks and cars",
             {{"name", text(league_.name)},
              {"about", text(about)},
              {"settings", settings(league_.plan.fixed)},
              {"search", search(league_.plan.search)},
              {"entries", [this](const YamlEntry& entry) { read_entries(entry); }},
              {"tracks", values("track", league_.tracks)},
              {"cars", values("car", league_.cars)},
              {"disturbances", [this](const YamlEntry& entry) { read_disturbances(entry); }}});
    if (entries_.list.empty() && league_.externals.empty())
      fault(root.line, "entries", "got none, expected some");
    if (league_.tracks.empty()) fault(root.line, "tracks", "got none, expected some");
    if (league_.cars.empty()) fault(root.line, "cars", "got none, expected some");
    if (league_.disturbances.empty()) league_.disturbances.emplace_back("none", Settings{});
    for (ExternalEntry& entry : league_.externals) complete(entry);
    if (!is_faultless()) return fail(error());
    make_plan();
    return std::move(league_);
  }

 private:
  void read_disturbances(const YamlEntry& entry) {
    for (const YamlEntry& each : named(entry))
      read_settings(each.value, league_.disturbances.emplace_back(each.key.text, Settings{}).second);
  }

  /// Entries: with `server` a program, else settings of a controller of ours.
  void read_entries(const YamlEntry& entry) {
    for (const YamlEntry& each : named(entry)) {
      const std::vector<YamlEntry> parts = each.value.entries();
      const bool is_external = std::any_of(parts.begin(), parts.end(),
                                           [](const YamlEntry& part) { return part.key.text == "server"; });
      if (is_external) {
        read_external(each);
      } else {
        entries_.list.push_back(each.key.text);
        read_settings(each.value, entries_.cases.emplace_back());
      }
    }
  }

  void read_external(const YamlEntry& entry) {
    ExternalEntry& external = league_.externals.emplace_back();
    external.name = entry.key.text;
    read_map(entry.value, entry.key.text, "a program",
             {{"server", text(external.command, "a command")},
              {"tracks", values("track", external.tracks)},
              {"cars", values("car", external.cars)},
              {"disturbances",
               list("names", [&](const YamlNode& name) { external.disturbances.push_back(name.text); })}});
  }

  /// Fills in tracks, cars and disturbances that the entry leaves out: all of the league's.
  void complete(ExternalEntry& entry) {
    if (entry.tracks.empty()) entry.tracks = league_.tracks;
    if (entry.cars.empty()) entry.cars = league_.cars;
    std::vector<std::string> known;
    for (const auto& disturbance : league_.disturbances) known.push_back(disturbance.first);
    if (entry.disturbances.empty()) entry.disturbances = known;
    for (const std::string& name : entry.disturbances) {
      if (std::find(known.begin(), known.end(), name) == known.end())
        fault(1, "disturbances",
              fmt::format("got {}, expected one of {}", printable(name), fmt::join(known, ", ")));
    }
  }

  /// Makes the plan of our own controllers.
  void make_plan() {
    Axis entries = list_axis(kEntryKey, entries_.list);
    entries.dimensions.front().cases = entries_.cases;
    Axis disturbances = list_axis(kDisturbanceKey, {});
    disturbances.size = league_.disturbances.size();
    for (const auto& [name, settings] : league_.disturbances) {
      disturbances.dimensions.front().list.push_back(name);
      disturbances.dimensions.front().cases.push_back(settings);
    }
    league_.plan.axes = {std::move(entries), list_axis("track", league_.tracks),
                         list_axis("car", league_.cars), std::move(disturbances)};
    league_.plan.keep.assign(kKept.begin(), kKept.end());
  }

  League league_;
  Dimension entries_;  ///< names and settings of our own controllers
};

/// Whether a command has the place `{name}`.
bool has_place(const std::string& command, std::string_view name) {
  return command.find(fmt::format("{{{}}}", name)) != std::string::npos;
}

}  // namespace

std::vector<ExternalTrial> League::external_trials() const {
  std::vector<ExternalTrial> trials;
  for (const ExternalEntry& entry : externals)
    for (const std::string& track : entry.tracks)
      for (const std::string& car : entry.cars)
        for (const std::string& disturbance : entry.disturbances) {
          ExternalTrial trial{.entry = entry.name,
                              .command = entry.command,
                              .track = track,
                              .car = car,
                              .disturbance = disturbance,
                              .settings = plan.fixed};
          trial.settings.emplace_back("track", track);
          trial.settings.emplace_back("car", car);
          for (const auto& [each, settings] : disturbances) {
            if (each != disturbance) continue;
            for (const auto& setting : settings) {
              if (setting.first.starts_with("fault")) trial.why_not = "faults are in our own control loop";
              if (setting.first == "latency_ms" && !has_place(entry.command, "latency_ms") && !is_ros(trial))
                trial.why_not = "the command has no place {latency_ms}";
              trial.settings.push_back(setting);
            }
          }
          trials.push_back(std::move(trial));
        }
  return trials;
}

bool is_ros(const ExternalTrial& trial) { return has_place(trial.command, "domain"); }

std::string filled(const ExternalTrial& trial, int port, const std::string& program) {
  std::string latency = "100";
  for (const auto& [key, text] : trial.settings)
    if (key == "latency_ms") latency = text;
  std::string command = trial.command;
  for (const auto& [place, text] :
       {std::pair{std::string("{port}"), fmt::format("{}", port)},
        std::pair{std::string("{domain}"), fmt::format("{}", port)},
        std::pair{std::string("{latency_ms}"), latency}, std::pair{std::string("{track}"), trial.track},
        std::pair{std::string("{chicane}"), program}}) {
    for (std::size_t at = command.find(place); at != std::string::npos;
         at = command.find(place, at + text.size()))
      command.replace(at, place.size(), text);
  }
  return command;
}

void add_external(League& league, const std::string& command) {
  ExternalEntry entry{.name = command, .command = command, .tracks = league.tracks, .cars = league.cars};
  for (const auto& disturbance : league.disturbances) entry.disturbances.push_back(disturbance.first);
  league.externals.push_back(std::move(entry));
}

Result<League> parse_league(std::string_view text, const std::string& file) {
  const Result<protocol::YamlTree> tree = protocol::parse_yaml(text, file);
  if (!tree) return fail(tree.error());
  Result<League> league = LeagueReader(file).read(*tree->root);
  if (league && league->name.empty()) league->name = std::filesystem::path(file).stem().string();
  if (league) league->plan.name = league->name;
  return league;
}

Result<League> read_league(const std::string& file) {
  const Result<std::string> text = protocol::read_file(file);
  return text ? parse_league(*text, file) : fail(text.error());
}

Result<double> bound_of(const Settings& settings, const std::atomic<bool>& stop) {
  const Result<scenario::Scenario> scenario = scenario_of(settings);
  if (!scenario) return fail(scenario.error());
  const Result<road::Track> track = run::make_track(*scenario);
  if (!track) return fail(track.error());
  lap_time::PlantLimitOptions options;
  options.wants_witness = false;
  options.go_on = [&](std::string_view, int, double) { return !stop.load(); };
  const Result<lap_time::PlantLimit> limit = run::limit_of(*scenario, *track, options);
  return limit ? Result<double>(limit->bound.lap) : fail(limit.error());
}

namespace {

using protocol::Json;

/// Key of an external trial in the file beside the results.
std::string trial_key(const ExternalTrial& trial) {
  return protocol::json_text(Json{{"command", trial.command},
                                  {"track", trial.track},
                                  {"car", trial.car},
                                  {kDisturbanceKey, trial.disturbance}});
}

/// Error for a file beside the results whose first line is not `wanted`.
Error refusal_of(const std::string& path, const std::string& line, const Json& wanted) {
  const Json got = protocol::parse_json(line);
  if (!got.is_object() || !got.contains("league"))
    return refusal(path, line, "the limits and trials of a league");
  const auto words = [](const Json& first) {
    return fmt::format("{} (plan {})", first.value("league", ""), first.value("plan", ""));
  };
  return {ErrorCode::kInvalidArgument,
          fmt::format("{}: got the limits and trials of {}, expected those of {}; choose another file", path,
                      words(got), words(wanted))};
}

/// Median and 99th percentile, rounded to 0.1 µs.
Json times_of(const telemetry::TimeSummary& times) {
  return {{"p50", std::round(1e7 * times.p50) / 10.0}, {"p99", std::round(1e7 * times.p99) / 10.0}};
}

/// Reads all numbers of a line into a cell: "solve_time_us.p50" of the object solve_time_us.
void read_numbers(const Json& json, LeagueCell& cell) {
  for (const auto& [name, value] : json.items()) {
    if (value.is_number()) cell.numbers[name] = value.get<double>();
    if (value.is_boolean()) cell.numbers[name] = value.get<bool>() ? 1.0 : 0.0;
    if (value.is_object())
      for (const auto& [part, number] : value.items())
        if (number.is_number()) cell.numbers[name + "." + part] = number.get<double>();
  }
}

/// Reason why the run of a line is not clean.
std::string reason_in(const Json& json, const LeagueCell& cell) {
  if (const std::string error = json.value("error", ""); !error.empty()) return error;
  const double events = cell.number("off_track_events");
  if (events > 0.0) return fmt::format("{:g} times off the road", events);
  return json.value("end_reason", "not all laps were driven");
}

}  // namespace

double LeagueCell::number(std::string_view column) const {
  const auto found = numbers.find(column);
  return found == numbers.end() ? std::nan("") : found->second;
}

Result<BesideFile> BesideFile::open(const std::string& path, const League& league) {
  BesideFile beside;
  // The first line has the plan of our own controllers alone, because the key of a trial names its command.
  const Json wanted{{"league", league.name}, {"plan", fmt::format("{:016x}", league.plan.hash())}};
  const auto refuse = [&](const std::string& first) { return refusal_of(path, first, wanted); };
  const auto note = [&](const LinePlace&, const std::string& line) -> Result<void> {
    const Json json = protocol::parse_json(line);
    for (const char* kind : {"limit", "external"})
      if (json.contains(kind)) beside.keys_.push_back(protocol::json_text(json[kind]));
    return {};
  };
  Result<LineFile> file = LineFile::open(path, protocol::json_text(wanted), refuse, note);
  if (!file) return fail(file.error());
  beside.file_ = std::move(*file);
  return beside;
}

bool BesideFile::has_bound(const std::string& track, const std::string& car) const {
  const std::string key = protocol::json_text(Json{{"track", track}, {"car", car}});
  return std::find(keys_.begin(), keys_.end(), key) != keys_.end();
}
bool BesideFile::has_trial(const ExternalTrial& trial) const {
  return std::find(keys_.begin(), keys_.end(), trial_key(trial)) != keys_.end();
}

Result<void> BesideFile::add_bound(const std::string& track, const std::string& car,
                                   const Result<double>& bound) {
  Json json{{"limit", Json{{"track", track}, {"car", car}}}};
  if (bound) json["lap_time_s"] = *bound;
  if (!bound) json["error"] = bound.error().message;
  return file_.append(protocol::json_text(json));
}

Result<void> BesideFile::add_times(std::uint64_t run, const telemetry::RunSummary& summary) {
  return file_.append(
      protocol::json_text(Json{{"run", run}, {"solve_time_us", times_of(summary.solve_time)}}));
}

Result<void> BesideFile::add_trial(const ExternalTrial& trial, const Result<telemetry::RunSummary>& run) {
  std::string line = fmt::format("{{\"external\":{},\"clean\":{}", trial_key(trial),
                                 run && telemetry::completed_on_road(*run));
  if (!run) return file_.append(line + ",\"error\":" + protocol::json_text(Json(run.error().message)) + "}");
  for (const Column& column : columns()) line += fmt::format(",\"{}\":{}", column.name, column.text(*run));
  return file_.append(line +
                      fmt::format(",\"answer_time_us\":{}}}", protocol::json_text(times_of(run->step_time))));
}

namespace {

/// Reads the results of our own controllers; runs that are missing in the file stay without numbers.
Result<void> read_own(const League& league, const std::string& file, LeagueResults& results) {
  std::vector<bool> seen(results.cells.size(), false);
  const auto take = [&](std::uint64_t run, const Json& json) -> Result<void> {
    if (run >= seen.size()) return fail(ErrorCode::kParse, "got a run that is none of the league's");
    LeagueCell& cell = results.cells[run];
    seen[run] = true;
    read_numbers(json, cell);
    const double found = cell.number(kSearchValue);
    cell.is_clean = std::isfinite(found);
    Settings settings = league.plan.settings_of(run);
    if (league.plan.search)
      settings.emplace_back(league.plan.search->key,
                            number_text(cell.is_clean ? found : league.plan.search->from));
    cell.command = command_of(settings);
    cell.why = cell.is_clean ? "" : reason_in(json, cell);
    return {};
  };
  const auto read = read_runs(
      file, [](const Header&) { return Result<void>{}; }, take);
  if (!read) return read;
  results.missing = static_cast<std::uint64_t>(std::count(seen.begin(), seen.end(), false));
  return {};
}

/// Command line that repeats an external trial.
std::string simulate_command(const ExternalTrial& trial) {
  std::string rest;
  if (is_ros(trial)) {
    for (const auto& [key, text] : trial.settings) rest += fmt::format(" --set {}={}", key, text);
    return fmt::format("chicane ros --simulate{} & {}", rest, filled(trial, 0));
  }
  for (const auto& [key, text] : trial.settings)
    if (key != "track" && key != "car" && key != "latency_ms") rest += fmt::format(" --set {}={}", key, text);
  return fmt::format("chicane simulate --server '{}' --track {} --car {}{}", filled(trial, kOriginalPort),
                     trial.track, trial.car, rest);
}

/// Reads one line of the file beside the results: a limit, the times of a run, or an external trial. Pre: the
/// last cells of `results` are those of `trials`, in their order.
void read_beside(const Json& json, const std::vector<ExternalTrial>& trials, LeagueResults& results) {
  if (json.contains("limit") && json.contains("lap_time_s"))
    results.bounds[{json["limit"].value("track", ""), json["limit"].value("car", "")}] = json["lap_time_s"];
  if (json.contains("run")) {
    const auto run = json["run"].get<std::uint64_t>();
    if (run < results.cells.size() && !results.cells[run].is_external) read_numbers(json, results.cells[run]);
  }
  if (!json.contains("external")) return;
  const std::string key = protocol::json_text(json["external"]);
  for (std::size_t i = 0; i < trials.size(); ++i) {
    if (key != trial_key(trials[i])) continue;
    LeagueCell& cell = results.cells[results.cells.size() - trials.size() + i];
    read_numbers(json, cell);
    cell.is_clean = cell.number("clean") == 1.0;
    cell.why = cell.is_clean ? "" : reason_in(json, cell);
  }
}

}  // namespace

Result<LeagueResults> read_results(const League& league, const std::string& results_file,
                                   const std::string& beside) {
  LeagueResults results;
  for (std::uint64_t run = 0; run < league.plan.size(); ++run) {
    const Settings varied = league.plan.at(run);
    results.cells.push_back({.entry = varied[0].second,
                             .track = varied[1].second,
                             .car = varied[2].second,
                             .disturbance = varied[3].second,
                             .why = "not driven yet"});
  }
  if (const Result<void> read = read_own(league, results_file, results); !read) return fail(read.error());
  const std::vector<ExternalTrial> trials = league.external_trials();
  for (const ExternalTrial& trial : trials)
    results.cells.push_back({.entry = trial.entry,
                             .track = trial.track,
                             .car = trial.car,
                             .disturbance = trial.disturbance,
                             .is_external = true,
                             .why = trial.why_not.empty() ? "not driven yet" : trial.why_not,
                             .command = simulate_command(trial)});
  std::ifstream stream(beside, std::ios::binary);
  for (std::string line; std::getline(stream, line);) {
    const Json json = protocol::parse_json(line);
    if (json.is_object()) read_beside(json, trials, results);
  }
  return results;
}

}  // namespace chicane::sweep
