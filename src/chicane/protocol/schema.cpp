// SPDX-License-Identifier: MIT
// Table of all settings, their look-up with suggestions, and their reading and writing as text.
#include "chicane/protocol/schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <deque>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "chicane/base/text.hpp"
#include "chicane/sim/plant_registry.hpp"

namespace chicane::protocol {
namespace {

using scenario::Scenario;
using S = Scenario;

/// Rows of the scenario's own fields.
auto run_options() {
  return std::array{
      option<&S::preset>("preset", "Named controller settings this run starts from."),
      option<&S::track>("track", "Shipped track by name, or a file."),
      option<&S::track_scale>(
          "track_scale", unit::kNone, 0, 10,
          "Size of a shipped track over that of its file; 0 is the car's scale. Files keep their size."),
      option<&S::car>("car", "Shipped car by name, or a file."),
      option<&S::plant>("plant", sim::plant_names(), "Simulated car; normally set by the car file."),
      option<&S::controller>("controller", controller::Registry::kNames,
                             "Name of the controller that drives."),
      option<&S::laps>("laps", unit::kNone, 0, 10000,
                       "Laps to drive, the first from standstill; 0 drives until stopped."),
      option<&S::seed>("seed", unit::kNone, 0, 9007199254740992.0, "Seed of everything random."),
      option<&S::latency>("latency", unit::kMillisecond, 0, 500, "Actuation delay of the simulated car."),
      option<&S::latency_jitter>("latency_jitter", unit::kMillisecond, 0, 500,
                                 "Random delay of each command on top, evenly distributed from 0 to this; "
                                 "unknown to the controller."),
      option<&S::friction_low>(
          "friction_low", unit::kNone, 0, 5,
          "Friction that the car is known to have at least, which a race is planned with; 0 where it is not "
          "known: no race; infinite: vehicle.friction.")
          .or_infinite(),
      option<&S::control_period>("control_period", unit::kMillisecond, 5, 1000, "Time between measurements."),
      option<&S::time_limit>("time_limit", unit::kSecond, 0, 1e7,
                             "Ends the run; 0 allows ten minutes per lap."),
      option<&S::turn_around>("turn_around", unit::kMillisecond, 0, 500,
                              "Pause of the simulator as a client, from reply to next telemetry."),
      option<&S::waypoints_sent>("waypoints_sent", unit::kNone, 2, 32, "Waypoints the telemetry shows."),
  };
}

/// Rows with their keys.
struct Table {
  std::deque<std::string> keys;  ///< texts of Parameter::key
  std::vector<Parameter> rows;

  /// Adds the options of a struct that `owner` finds in a scenario.
  void add(std::string_view group, std::string_view of_controller, std::span<const Option> options,
           void* (*owner)(Scenario&)) {
    for (const Option& option : options) {
      keys.push_back(option_key(group, option));
      rows.push_back({keys.back(), group, of_controller, option, owner});
    }
  }
};

Table make_table() {
  Table table;
  table.add("", "", run_options(), [](Scenario& s) -> void* { return &s; });
  controller::Registry::for_each([&]<class Entry>() {
    table.add(controller::kOptionGroup<Entry>, Entry::kName, Entry::options(),
              [](Scenario& s) -> void* { return &std::get<typename Entry::Options>(s.controllers); });
  });
  table.add("vehicle", "", model::vehicle_options(), [](Scenario& s) -> void* { return &s.vehicle; });
  table.add("plant_params", "", sim::double_track_options(),
            [](Scenario& s) -> void* { return &s.plant_params; });
  table.add("guard", "", safety::guard_options(), [](Scenario& s) -> void* { return &s.guard; });
  table.add("plant_options", "", sim::deviation_options(),
            [](Scenario& s) -> void* { return &s.plant_options; });
  table.add("sensor", "", sim::sensor_options(), [](Scenario& s) -> void* { return &s.sensor; });
  return table;
}

/// Struct of a scenario that has the field of a row, for reading.
void* owner_of(const Scenario& scenario, const Parameter& parameter) {
  return parameter.owner(const_cast<Scenario&>(scenario));  // read only through the result
}

Result<double> parse_number(const Parameter& parameter, std::string_view text) {
  if (parameter.option.may_be_infinite && (text == "inf" || text == ".inf"))
    return std::numeric_limits<double>::infinity();
  if (const std::optional<double> value = number_in(text)) return *value;
  return fail(refusal(parameter.key, printable(text), parameter.option));
}

/// Levenshtein distance: number of letters to insert, remove or replace.
int edit_distance(std::string_view a, std::string_view b) {
  std::vector<int> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    int diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const int substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substituted, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

}  // namespace

std::span<const Parameter> list() {
  static const Table kTable = make_table();
  return kTable.rows;
}

bool is_live(const Parameter& parameter) {
  constexpr std::array<std::string_view, 8> kWhatRuns{"track_scale",  "vehicle.scale", "plant",
                                                      "controller",   "seed",          "control_period_ms",
                                                      "friction_low", "waypoints_sent"};
  return parameter.option.kind != Kind::kText &&  // preset, track, car: names
         parameter.group != "guard" &&            // fixed when a run starts
         parameter.group != "plant_params" &&     // fixed when a run starts, as is the car
         std::find(kWhatRuns.begin(), kWhatRuns.end(), parameter.key) == kWhatRuns.end();
}

bool is_fixed(const Parameter& parameter) {
  return parameter.group == "guard" || parameter.group == "vehicle";
}

const Parameter* find(std::string_view key) {
  constexpr std::pair<std::string_view, std::string_view> kRenamed{"tracking_mpc.turns",
                                                                   "tracking_mpc.iterations"};
  const std::string_view present = key == kRenamed.first ? kRenamed.second : key;
  const auto row =
      std::find_if(list().begin(), list().end(), [&](const Parameter& p) { return p.key == present; });
  return row == list().end() ? nullptr : &*row;
}

const Parameter* find_option(std::string_view controller, std::string_view name) {
  const auto row = std::find_if(list().begin(), list().end(), [&](const Parameter& p) {
    return p.controller == controller && p.option.name == name;
  });
  return row == list().end() ? nullptr : &*row;
}

std::string_view nearest(std::string_view word, std::span<const std::string_view> known) {
  std::string_view best;
  constexpr std::size_t kLongest = 100;  // [byte] chosen: bounds the time; no key is longer
  if (word.size() > kLongest) return best;
  // Accepts fewer changes than this: a quarter of the letters; one in short words, which two changes turn
  // into any other.
  int best_distance = word.size() < 5 ? 2 : std::max(2, static_cast<int>(word.size()) / 4) + 1;
  for (const std::string_view candidate : known) {
    const bool lacks_suffix = candidate.starts_with(word) && candidate.size() > word.size() &&
                              (candidate[word.size()] == '_' || candidate[word.size()] == '-');
    const bool is_swapped = std::is_permutation(word.begin(), word.end(), candidate.begin(), candidate.end());
    const int distance = lacks_suffix ? 0 : is_swapped ? 1 : edit_distance(word, candidate);
    if (distance < best_distance) std::tie(best, best_distance) = std::pair{candidate, distance};
  }
  return best;
}

std::string_view first_of(std::string_view group) {
  const auto row =
      std::find_if(list().begin(), list().end(), [&](const Parameter& p) { return p.group == group; });
  return row == list().end() || group.empty() ? "" : row->key;
}

std::string suggestion(std::string_view key, std::string_view driver) {
  std::vector<std::string_view> in_use;
  std::vector<std::string_view> others;
  for (const Parameter& parameter : list()) {
    const bool is_used = driver.empty() || parameter.controller.empty() || parameter.controller == driver;
    (is_used ? in_use : others).push_back(parameter.key);
  }
  const auto name_of = [](std::string_view each) { return each.substr(each.rfind('.') + 1); };
  for (const auto* keys : {&in_use, &others}) {
    std::string_view best = nearest(key, *keys);
    if (best.empty()) {  // a similar name in another group
      std::vector<std::string_view> names;
      for (const std::string_view known : *keys) names.push_back(name_of(known));
      const std::string_view name = nearest(name_of(key), names);
      const auto it = std::find(names.begin(), names.end(), name);
      if (!name.empty()) best = (*keys)[static_cast<std::size_t>(it - names.begin())];
    }
    if (best.empty()) best = first_of(key);
    if (!best.empty()) return fmt::format(" (did you mean {}?)", best);
  }
  return "";
}

std::string unknown_key(std::string_view key, std::string_view driver) {
  return fmt::format("got an unknown key, expected one of `chicane list parameters`{}",
                     suggestion(key, driver));
}

Value get(const Scenario& scenario, const Parameter& parameter) {
  return chicane::get(parameter.option, owner_of(scenario, parameter));
}

Result<void> set(Scenario& scenario, const Parameter& parameter, const Value& value) {
  return chicane::set(parameter.option, parameter.key, parameter.owner(scenario), value);
}

Result<Value> parse(const Parameter& parameter, std::string_view text) {
  Value value;
  switch (parameter.option.kind) {
    case Kind::kNumber:
    case Kind::kInteger: {
      const Result<double> number = parse_number(parameter, text);
      if (!number) return fail(number.error());
      value = *number;
      break;
    }
    case Kind::kBool:
      if (text != "true" && text != "false")
        return fail(refusal(parameter.key, printable(text), parameter.option));
      value = text == "true";
      break;
    case Kind::kChoice:
    case Kind::kText:
      value = std::string(text);
      break;
  }
  Scenario scratch;
  if (const Result<void> checked = set(scratch, parameter, value); !checked) return fail(checked.error());
  return value;
}

std::string text_of(const Value& value) {
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  return number_text(std::get<double>(value));
}

std::string get_text(const Scenario& scenario, const Parameter& parameter) {
  const Value value = get(scenario, parameter);
  const Option& option = parameter.option;
  if (option.kind != Kind::kNumber) return text_of(value);
  const double number = std::get<double>(value);
  // Prefers 15 digits, which give numbers as people write them, if they have the same bits.
  const std::string rounded = fmt::format("{:.15g}", number);
  const double read = number_in(rounded).value_or(0.0);
  const Value inside = option.read(owner_of(scenario, parameter));
  const bool is_same = option.unit.to_si(read) == std::get<double>(inside);
  return is_same ? rounded : number_text(number);
}

Result<void> set_text(Scenario& scenario, std::string_view key, std::string_view text) {
  const Parameter* parameter = find(key);
  if (parameter == nullptr) {
    return fail(ErrorCode::kNotFound, fmt::format("{}: {}", printable(key), unknown_key(key)));
  }
  const Result<Value> value = parse(*parameter, text);
  return value ? set(scenario, *parameter, *value) : fail(value.error());
}

std::vector<Contradiction> contradictions(const Scenario& scenario) {
  std::vector<Contradiction> found;
  const bool has_params = scenario.plant_params != sim::DoubleTrackParams{};
  if (has_params && scenario.plant != sim::DoubleTrack::kName) {
    found.push_back({"plant", "got " + scenario.plant + ", expected " + std::string(sim::DoubleTrack::kName) +
                                  ", the only one with plant_params"});
  }
  if (scenario.races() && !(scenario.friction_low > 0.0)) {
    found.push_back(
        {"friction_low",
         "got 0, the grip of this car is not known, expected more to race by: log bends nearer to the limit, "
         "or state the least friction that you know it to have (--set friction_low=NUMBER)"});
  }
  const auto* driver = controller::Registry::find(scenario.controller);
  if (driver == nullptr) return found;
  for (OptionContradiction& each : driver->contradictions(scenario.controllers))
    found.push_back({find_option(driver->name, each.option)->key, std::move(each.message)});
  return found;
}

}  // namespace chicane::protocol
