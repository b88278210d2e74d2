// SPDX-License-Identifier: MIT
#include "chicane/sweep/league_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "chicane/base/text.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/sweep/outcome.hpp"
#include "chicane/sweep/trial.hpp"

namespace chicane::sweep {
namespace {

using protocol::Json;

std::string bound_key(const std::string& track, const std::string& car) {
  return protocol::json_text(Json{{"track", track}, {"car", car}});
}
std::string trial_key(const ExternalTrial& trial) {
  return protocol::json_text(Json{{"command", trial.command},
                                  {"track", trial.track},
                                  {"car", trial.car},
                                  {kDisturbanceKey, trial.disturbance}});
}

/// Of the plan alone: each trial says of which command it is.
Json first_line(const League& league) {
  return {{"league", league.name}, {"plan", fmt::format("{:016x}", league.plan.hash())}};
}

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

Json times_of(const telemetry::TimeSummary& times) {
  return {{"p50", std::round(1e7 * times.p50) / 10.0}, {"p99", std::round(1e7 * times.p99) / 10.0}};
}

void read_numbers(const Json& json, LeagueCell& cell) {
  for (const auto& [name, value] : json.items()) {
    if (value.is_number()) cell.numbers[name] = value.get<double>();
    if (value.is_boolean()) cell.numbers[name] = value.get<bool>() ? 1.0 : 0.0;
    if (value.is_object())
      for (const auto& [part, number] : value.items())
        if (number.is_number()) cell.numbers[name + "." + part] = number.get<double>();
  }
}

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
  const Json wanted = first_line(league);
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
  return std::find(keys_.begin(), keys_.end(), bound_key(track, car)) != keys_.end();
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

/// The runs of our own controllers, by their number; those that are missing stay without numbers.
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

/// `trials`: of the last cells.
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
