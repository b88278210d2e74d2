// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "chicane/protocol/json.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/run/lane_change.hpp"
#include "commands.hpp"
#include "many_runs.hpp"

namespace chicane::apps {
namespace {

using protocol::Json;

constexpr double kKmph = 3.6;

/// The lane change of one car: its lines are planned once for all who drive it.
struct CarOnCourse {
  std::mutex mutex{};
  std::optional<run::LaneChange> change{};

  Result<run::LaneChangeLimit> find_limit(const scenario::Scenario& scenario) {
    const std::lock_guard lock(mutex);
    if (!change) {
      Result<run::LaneChange> created = run::LaneChange::create(scenario.vehicle);
      if (!created) return fail(created.error());
      change.emplace(std::move(*created));
    }
    return change->find_limit(scenario);
  }
};

Json json_of(const run::LaneChangeLimit& limit) {
  return {{"entry_kmph", limit.passed_kmph},
          {"exit_kmph", kKmph * limit.passed.exit_speed},
          {"room_m", limit.passed_kmph > 0 ? Json(limit.passed.room) : Json()},
          {"room_above_m", limit.failed.room},
          {"passed_above", limit.failed.has_passed()}};
}

std::string why_not_faster(const Json& line) {
  const Json& room = line.at("room_above_m");
  if (line.at("passed_above").get<bool>()) return "passed every speed tried";
  return room.is_number() && room.get<double>() < 0.0
             ? fmt::format("a cone is hit by {:.2f} m", -room.get<double>())
             : "does not arrive";
}

void print_row(const std::string& car, const std::string& preset, const Json& line) {
  const Json& room = line.at("room_m");
  fmt::print("{:<16} {:<14} {:>7} {:>11.1f} {:>9.2f}   {}\n", car, preset, line.at("entry_kmph").get<int>(),
             line.at("exit_kmph").get<double>(), room.is_number() ? room.get<double>() : 0.0,
             why_not_faster(line));
}

/// The experiments of all runs; a mistake is reported before anything is driven.
Result<std::vector<scenario::Scenario>> scenarios_of(const Options& options, const sweep::Plan& plan) {
  std::vector<scenario::Scenario> scenarios;
  for (std::uint64_t run = 0; run < plan.size(); ++run) {
    auto settings = options.settings;
    for (auto& setting : plan.at(run)) settings.push_back(std::move(setting));
    Result<scenario::Scenario> scenario = protocol::compose({"", settings});
    if (!scenario) return fail(scenario.error());
    scenarios.push_back(std::move(*scenario));
  }
  return scenarios;
}

/// Cars turn fastest: threads drive different cars.
sweep::Plan plan_of(const Options& options) {
  sweep::Plan plan{.name = "lane-change", .fixed = options.settings, .keep = {"outcome"}};
  plan.axes = {sweep::list_axis("preset", options.lane_change.presets),
               sweep::list_axis("car", options.lane_change.cars)};
  return plan;
}

Result<RunLines> drive(const Options& options, const sweep::Plan& plan, const std::atomic<bool>& stop) {
  const Result<std::vector<scenario::Scenario>> scenarios = scenarios_of(options, plan);
  if (!scenarios) return fail(scenarios.error());
  std::map<std::string, CarOnCourse> courses;
  for (const std::string& car : options.lane_change.cars) courses[car];
  const auto rule = [&](std::uint64_t run, run::Roads&) -> Result<std::optional<std::string>> {
    const scenario::Scenario& scenario = scenarios->at(run);
    const Result<run::LaneChangeLimit> limit = courses.at(scenario.car).find_limit(scenario);
    if (!limit) return fail(limit.error());
    return std::optional(protocol::json_text(json_of(*limit)));
  };
  return drive_runs({.plan = plan, .rule = rule}, options.jobs, options.results_file, stop);
}

/// Prints a row for each car, with a column for each preset.
void print(const Options& options, const RunLines& driven) {
  const auto& [cars, presets] = options.lane_change;
  Json rows = Json::array();
  if (!options.is_json)
    fmt::print("{:<16} {:<14} {:>7} {:>11} {:>9}   {}\n", "car", "preset", "[km/h]", "exit [km/h]",
               "room [m]", "1 km/h faster");
  for (std::size_t car = 0; car < cars.size(); ++car) {
    for (std::size_t preset = 0; preset < presets.size(); ++preset) {
      const auto found = driven.lines.find(preset * cars.size() + car);
      if (found == driven.lines.end()) continue;
      if (!options.is_json) {
        print_row(cars[car], presets[preset], found->second);
        continue;
      }
      Json row{{"car", cars[car]}, {"preset", presets[preset]}};
      for (const char* key : {"entry_kmph", "exit_kmph", "room_m", "room_above_m"})
        row[key] = found->second.at(key);
      rows.push_back(std::move(row));
    }
  }
  if (options.is_json) print_rows(std::move(rows));
}

}  // namespace

ExitCode lane_change(const Options& options) {
  const std::atomic<bool>& wants_stop = begin_many_runs();
  const Result<RunLines> driven = drive(options, plan_of(options), wants_stop);
  if (!driven) return report(driven.error());
  print(options, *driven);
  return driven->progress.is_complete() ? kSuccess : kRunFailed;
}

}  // namespace chicane::apps
