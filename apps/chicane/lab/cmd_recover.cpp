// SPDX-License-Identifier: MIT
// `chicane recover`, which drives many starts beside the road; and `chicane lane-change`, which finds the
// highest speed of a double lane change.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "chicane/base/math.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/run/lane_change.hpp"
#include "chicane/run/make.hpp"
#include "chicane/run/way_back.hpp"
#include "commands.hpp"
#include "lab/many_runs.hpp"

namespace chicane::apps {
namespace {

using protocol::Json;
using run::WayBackOutcome;

/// One car on one track, with its starts and their results.
struct CarOnTrack {
  std::string track, car;
  scenario::Scenario scenario{};
  std::vector<run::StartPose> starts{};
  std::vector<std::pair<int, Json>> outcomes{};  ///< number of a start from 1, and its line of results

  /// Number of starts that came back to the road.
  [[nodiscard]] auto back() const {
    return std::count_if(outcomes.begin(), outcomes.end(),
                         [](const auto& each) { return each.second.at("is_back").template get<bool>(); });
  }
};

/// Number of a line of results; infinite for null.
double time_in(const Json& line, const char* key) {
  const Json& value = line.at(key);
  return value.is_null() ? WayBackOutcome::kNever : value.get<double>();
}

/// Error, in words.
std::string verdict(const Json& line) {
  const double least_edge = time_in(line, "least_edge_m");
  if (least_edge < 0.0) return fmt::format("leaves it again by {:.2f} m", -least_edge);
  if (!(time_in(line, "back_s") < WayBackOutcome::kNever)) return "does not come back";
  return "comes back, and does not drive on";
}

/// Command that drives one start again.
std::string command_of(const Options& options, const CarOnTrack& pair, int number) {
  std::string text = fmt::format("chicane recover --tracks {} --cars {} --starts {} --seed {} --only {}",
                                 pair.track, pair.car, options.recover.starts, options.recover.seed, number);
  for (const auto& [key, value] : options.settings) text += fmt::format(" --set {}={}", key, value);
  return text;
}

/// Adds the row of one kind of starts.
void add_kind(sweep::ResultTable& table, const CarOnTrack& pair, std::string_view kind) {
  int starts = 0, back = 0;
  double slowest_back = 0.0, slowest = 0.0, farthest = 0.0;
  for (const auto& [number, line] : pair.outcomes) {
    if (line.at("start") != kind) continue;
    ++starts;
    farthest = std::max(farthest, line.at("farthest_m").get<double>());
    if (!line.at("is_back").get<bool>()) continue;
    ++back;
    slowest_back = std::max(slowest_back, time_in(line, "back_s"));
    slowest = std::max(slowest, time_in(line, "lapping_s"));
  }
  if (starts > 0) table.add({pair.track, pair.car, kind, starts, back, slowest_back, slowest, farthest});
}

/// Prints the table, and the command of each start that did not come back.
void print_table(const Options& options, const std::vector<CarOnTrack>& pairs) {
  sweep::ResultTable table({"track", "car", "start", "starts{>}", "back{>}", "back [s]{>.1}",
                            "lapping [s]{>.1}", "farthest [m]{>.1}"});
  for (const CarOnTrack& pair : pairs)
    for (const std::string_view kind : run::kStartKindNames) add_kind(table, pair, kind);
  print_table(options, table);
  for (const CarOnTrack& pair : pairs) {
    for (const auto& [number, line] : pair.outcomes) {
      if (line.at("is_back").get<bool>()) continue;
      fmt::print("\n{} {}, start {}, {}: {}\n  {}\n", pair.track, pair.car, number,
                 line.at("start").get<std::string>(), verdict(line), command_of(options, pair, number));
    }
  }
}

/// Prints all results as JSON.
void print_json(const std::vector<CarOnTrack>& pairs) {
  Json all = Json::array();
  for (const CarOnTrack& pair : pairs) {
    Json outcomes = Json::array();
    for (const auto& [number, line] : pair.outcomes) {
      Json outcome{{"number", number}};
      for (const auto& [key, value] : line.items())
        if (key != "run" && key != "settings") outcome[key] = value;
      outcomes.push_back(std::move(outcome));
    }
    all.push_back({{"track", pair.track},
                   {"car", pair.car},
                   {"starts", pair.outcomes.size()},
                   {"back", pair.back()},
                   {"outcomes", std::move(outcomes)}});
  }
  print_rows(std::move(all));
}

/// Result of a start, for its line.
Json json_of(const WayBackOutcome& outcome) {
  const model::State& start = outcome.start.state;
  return {{"start", run::kStartKindNames[static_cast<std::size_t>(outcome.start.kind)]},
          {"x_m", start.x},
          {"y_m", start.y},
          {"yaw_deg", radians_to_degrees(start.psi)},
          {"vx_mps", start.vx},
          {"vy_mps", start.vy},
          {"yaw_rate_degps", radians_to_degrees(start.r)},
          {"is_back", outcome.has_come_back()},
          {"back_s", outcome.back},
          {"lapping_s", outcome.lapping},
          {"farthest_m", outcome.farthest},
          {"least_edge_m", outcome.least_edge}};
}

/// Car and track with their starts.
Result<CarOnTrack> pair_of(const Options& options, const std::string& track, const std::string& car) {
  auto settings = options.settings;
  settings.emplace_back("track", track);
  settings.emplace_back("car", car);
  Result<scenario::Scenario> scenario = protocol::compose({"", settings});
  if (!scenario) return fail(scenario.error());
  const Result<road::Track> road = run::make_track(*scenario);
  if (!road) return fail(road.error());
  auto starts = run::start_poses(*road, options.recover.starts, options.recover.seed);
  if (options.recover.only > static_cast<int>(starts.size()))
    return fail(ErrorCode::kInvalidArgument, fmt::format("--only: got {}, expected a start from 1 to {}",
                                                         options.recover.only, starts.size()));
  return CarOnTrack{track, car, std::move(*scenario), std::move(starts)};
}

/// All cars on all tracks, in the order of the plan; consecutive runs of the plan are starts of one pair.
Result<std::vector<CarOnTrack>> pairs_of(const Options& options) {
  std::vector<CarOnTrack> pairs;
  for (const std::string& track : options.recover.tracks) {
    for (const std::string& car : options.recover.cars) {
      Result<CarOnTrack> pair = pair_of(options, track, car);
      if (!pair) return fail(pair.error());
      pairs.push_back(std::move(*pair));
    }
  }
  return pairs;
}

/// Numbers of the starts to drive.
std::vector<int> numbers_of(const Options::Recover& recover) {
  if (recover.only > 0) return {recover.only};
  std::vector<int> numbers;
  for (int number = 1; number <= recover.starts; ++number) numbers.push_back(number);
  return numbers;
}

/// Plan with a run for each start.
sweep::Plan plan_of(const Options& options, const std::vector<int>& numbers) {
  std::vector<std::string> texts;
  for (const int number : numbers) texts.push_back(std::to_string(number));
  sweep::Plan plan{.name = "recover", .fixed = options.settings, .keep = {"outcome"}};
  plan.fixed.emplace_back("starts", std::to_string(options.recover.starts));
  plan.fixed.emplace_back("start_seed", std::to_string(options.recover.seed));
  plan.axes = {sweep::list_axis("track", options.recover.tracks),
               sweep::list_axis("car", options.recover.cars),
               sweep::list_axis("start_number", std::move(texts))};
  return plan;
}

/// Drives all starts, and stores their results in the pairs. False if it was stopped.
Result<bool> drive_back(const Options& options, std::vector<CarOnTrack>& pairs,
                        const std::atomic<bool>& stop) {
  const std::vector<int> numbers = numbers_of(options.recover);
  const auto rule = [&](std::uint64_t run, run::Roads& roads) -> Result<std::optional<std::string>> {
    const CarOnTrack& pair = pairs[run / numbers.size()];
    const auto start = static_cast<std::size_t>(numbers[run % numbers.size()]) - 1;
    const Result<WayBackOutcome> outcome = run::drive_back(pair.scenario, pair.starts[start], roads);
    if (!outcome) return fail(outcome.error());
    return std::optional(protocol::json_text(json_of(*outcome)));
  };
  Result<RunLines> driven = drive_runs({.plan = plan_of(options, numbers), .rule = rule, .what = "starts"},
                                       options.jobs, options.results_file, stop);
  if (!driven) return fail(driven.error());
  for (auto& [run, line] : driven->lines)
    pairs[run / numbers.size()].outcomes.emplace_back(numbers[run % numbers.size()], std::move(line));
  return driven->progress.is_complete();
}

}  // namespace

ExitCode recover(const Options& options) {
  const std::atomic<bool>& wants_stop = begin_many_runs();
  Result<std::vector<CarOnTrack>> pairs = pairs_of(options);
  if (!pairs) return report(pairs.error());
  const Result<bool> is_whole = drive_back(options, *pairs, wants_stop);
  if (!is_whole) return report(is_whole.error());
  if (options.is_json) {
    print_json(*pairs);
  } else {
    print_table(options, *pairs);
  }
  const bool are_all_back = std::all_of(pairs->begin(), pairs->end(), [](const CarOnTrack& pair) {
    return static_cast<std::size_t>(pair.back()) == pair.outcomes.size();
  });
  return are_all_back && *is_whole ? kSuccess : kRunFailed;
}

namespace {

constexpr double kKmph = 3.6;  // km/h for 1 m/s

/// Lane change of one car, which is planned once for all controllers.
struct CarOnCourse {
  std::mutex mutex{};                       ///< guards `change`
  std::optional<run::LaneChange> change{};  ///< empty: not planned yet

  /// Highest speed of a controller.
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

/// Result of a car and preset, for its line.
Json json_of(const run::LaneChangeLimit& limit) {
  return {{"entry_kmph", limit.passed_kmph},
          {"exit_kmph", kKmph * limit.passed.exit_speed},
          {"room_m", limit.passed_kmph > 0 ? Json(limit.passed.room) : Json()},
          {"room_above_m", limit.failed.room},
          {"passed_above", limit.failed.has_passed()}};
}

/// Event at the next higher speed, in words.
std::string why_not_faster(const Json& line) {
  const Json& room = line.at("room_above_m");
  if (line.at("passed_above").get<bool>()) return "passed every speed tried";
  return room.is_number() && room.get<double>() < 0.0
             ? fmt::format("a cone is hit by {:.2f} m", -room.get<double>())
             : "does not arrive";
}

/// Scenarios of all runs: a mistake is reported before anything is driven.
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

/// Plan with a run for each preset and car. Consecutive runs are of different cars, so that threads do not
/// wait for each other's car.
sweep::Plan plan_of(const Options& options) {
  sweep::Plan plan{.name = "lane-change", .fixed = options.settings, .keep = {"outcome"}};
  plan.axes = {sweep::list_axis("preset", options.lane_change.presets),
               sweep::list_axis("car", options.lane_change.cars)};
  return plan;
}

/// Drives all runs.
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

/// Table with a row for each car and preset.
sweep::ResultTable table_of(const Options& options, const RunLines& driven) {
  const auto& [cars, presets] = options.lane_change;
  sweep::ResultTable table({"car=car", "preset=preset", "entry_kmph=[km/h]{>}", "exit_kmph=exit [km/h]{>.1}",
                            "room_m=room [m]{>.2}", "room_above_m=", "  1 km/h faster"});
  for (std::size_t car = 0; car < cars.size(); ++car) {
    for (std::size_t preset = 0; preset < presets.size(); ++preset) {
      const auto found = driven.lines.find(preset * cars.size() + car);
      if (found == driven.lines.end()) continue;
      const Json& line = found->second;
      table.add({cars[car], presets[preset], line.at("entry_kmph"), line.at("exit_kmph"), line.at("room_m"),
                 line.at("room_above_m"), "  " + why_not_faster(line)});
    }
  }
  return table;
}

}  // namespace

ExitCode lane_change(const Options& options) {
  const std::atomic<bool>& wants_stop = begin_many_runs();
  const Result<RunLines> driven = drive(options, plan_of(options), wants_stop);
  if (!driven) return report(driven.error());
  print_table(options, table_of(options, *driven));
  return driven->progress.is_complete() ? kSuccess : kRunFailed;
}

}  // namespace chicane::apps
