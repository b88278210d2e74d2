// SPDX-License-Identifier: MIT
// `chicane list` prints what is shipped and built in: presets, tracks, cars, controllers and so on. `chicane
// check` reports mistakes in files.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "chicane/base/math.hpp"
#include "chicane/controller/registry.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/protocol/schema.hpp"
#include "chicane/protocol/track_codec.hpp"
#include "chicane/protocol/yaml_codec.hpp"
#include "chicane/road/track.hpp"
#include "chicane/sim/fault.hpp"
#include "chicane/sim/plant_registry.hpp"
#include "commands.hpp"
#include "experiment.hpp"
#include "option_row.hpp"

namespace chicane::apps {
namespace {

using protocol::Parameter;
using protocol::Shelf;

/// Prints a label and its meaning: in one line for programs, in lines of 80 columns on a terminal. `columns`:
/// width of the label.
void print_entry(std::string_view label, std::string_view meaning, std::size_t columns) {
  constexpr std::size_t kWide = 40;  // [columns] a longer label gets its meaning on the next line; chosen
  fmt::print("{}", label);
  print_sentence(stdout, meaning, columns > kWide ? 4 : columns, columns);
}

/// Files of one kind, with their descriptions.
template <Shelf shelf>
std::vector<ListEntry> file_entries() {
  std::vector<ListEntry> found;
  for (const protocol::Entry& entry : protocol::entries(shelf))
    found.push_back({entry.name, entry.description});
  return found;
}

/// Entries of a registry whose kinds have a name and a meaning.
template <class Kinds>
std::vector<ListEntry> registry_entries(const Kinds& kinds) {
  std::vector<ListEntry> found;
  for (const auto& kind : kinds) found.push_back({std::string(kind.name), std::string(kind.meaning)});
  return found;
}

/// Settings of the schema.
std::vector<ListEntry> parameter_entries() {
  std::vector<ListEntry> found;
  for (const Parameter& parameter : protocol::list())
    found.push_back({std::string(parameter.key), std::string(parameter.option.meaning)});
  return found;
}

/// Prints names with their meanings.
void print_names(const std::vector<ListEntry>& entries) {
  for (const ListEntry& entry : entries) print_entry(fmt::format("{:<18} ", entry.name), entry.meaning, 19);
}

/// Prints the cars; as Markdown the table of docs/reference/shipped.md.
void print_cars(bool is_markdown) {
  if (!is_markdown) return print_names(file_entries<Shelf::kCar>());
  fmt::print(
      "| car | mass [kg] | length × width [m] | wheelbase [m] | smallest radius [m] | grip [m/s²] | "
      "downforce at 50 m/s | drive [m/s²], [W/kg] | brakes [m/s²] | steering [deg/s], lag [ms] |\n"
      "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
  for (const protocol::Entry& entry : protocol::entries(Shelf::kCar)) {
    const Result<scenario::Scenario> scenario = protocol::compose({"", {{"car", entry.name}}});
    if (!scenario) continue;  // `chicane check` reports the fault
    const model::VehicleParams& car = scenario->vehicle;
    const double front_axle_radius = car.wheelbase() / std::tan(car.steer_limit);
    fmt::print(
        "| `{}` | {:.4g} | {:.3g} × {:.3g} | {:.3g} | {:.3g} | {:.3g} | {:.0f} % | {:.3g}, {:.3g} | {:.3g} | "
        "{:.3g}, {:.3g} |\n",
        entry.name, car.mass, car.length, car.width, car.wheelbase(),
        std::hypot(front_axle_radius, car.rear_axle), car.cornering_friction() * car.load_constant,
        100.0 * (car.load(50.0) / car.load_constant - 1.0), car.drive_acceleration, car.drive_power_per_mass,
        std::min(car.brake_acceleration, car.cornering_friction() * car.load_constant),
        radians_to_degrees(car.steer_rate_limit), 1e3 * car.steer_lag);
  }
}

/// Default of a setting as text.
std::string default_of(const Parameter& parameter) {
  return protocol::get_text(scenario::Scenario{}, parameter);
}

/// Allowed values of a setting as text.
std::string range_of(const Parameter& parameter) {
  switch (parameter.option.kind) {
    case protocol::Kind::kChoice:
      return fmt::format("{}", fmt::join(parameter.option.choices, ", "));
    case protocol::Kind::kBool:
      return "true, false";
    case protocol::Kind::kText:
      return "text";
    case protocol::Kind::kNumber:
    case protocol::Kind::kInteger:
      break;
  }
  return fmt::format("{} … {}{}", parameter.option.minimum, parameter.option.maximum,
                     parameter.option.may_be_infinite ? ", inf" : "");
}

/// Prints docs/reference/configuration.md.
void print_configuration_page() {
  fmt::print(
      "# Configuration\n\n"
      "Everything tunable, made by `chicane list parameters --markdown`. A key is the same in presets, "
      "scenarios and cars\n"
      "(`presets/`, `scenarios/`, `cars/`: YAML), in `--set key=value`, and on the dashboard. Numbers "
      "outside the program carry\n"
      "their unit in the key; `chicane check FILE` explains what is wrong with a file.\n\n"
      "Later layers win: the defaults below, the car's file, the preset (with the presets it builds on by "
      "`preset: NAME`), the\n"
      "scenario file, the command line.\n");
  std::string_view group = "-";
  for (const Parameter& parameter : protocol::list()) {
    if (parameter.group != group) {
      group = parameter.group;
      fmt::print("\n## {}\n\n| key | default | unit | range | meaning |\n|---|---|---|---|---|\n",
                 group.empty() ? "The run" : group);
    }
    fmt::print("| `{}` | {} | {} | {} | {} |\n", parameter.key, default_of(parameter),
               parameter.option.unit.name, range_of(parameter), parameter.option.meaning);
  }
}

/// Default strength of a fault; empty for a fault without strength.
std::string strength_of(const sim::FaultKind& kind) {
  return kind.strength_meaning.empty() ? "" : fmt::format("{}", kind.strength);
}

/// Prints the faults; as Markdown the table of docs/reference/shipped.md.
void print_faults(bool is_markdown) {
  if (is_markdown)
    fmt::print(
        "| fault | what happens | for [s] | strength | range | what it is |\n|---|---|---|---|---|---|\n");
  for (const sim::FaultKind& kind : sim::fault_kinds()) {
    const std::string range =
        kind.strength_meaning.empty() ? "" : fmt::format("{} … {}", kind.weakest, kind.strongest);
    if (is_markdown) {
      fmt::print("| `{}` | {} | {} | {} | {} | {} |\n", kind.name, kind.meaning, kind.duration,
                 strength_of(kind), range, kind.strength_meaning);
    } else {
      const std::string strength =
          kind.strength_meaning.empty() ? "" : fmt::format(" Strength: {}.", kind.strength_meaning);
      print_entry(fmt::format("{:<18} {:>4} s  {:<4} ", kind.name, kind.duration, strength_of(kind)),
                  std::string(kind.meaning) + strength, 32);
    }
  }
}

/// Prints a line for each setting; as Markdown docs/reference/configuration.md.
void print_parameters(bool is_markdown) {
  if (is_markdown) return print_configuration_page();
  for (const Parameter& parameter : protocol::list()) {
    print_entry(fmt::format("{:<42} {:<14} {:<13} ", parameter.key, default_of(parameter),
                            parameter.option.unit.name),
                parameter.option.meaning, 72);
  }
}

/// One list of `chicane list`, such as the cars.
struct List {
  std::string_view name;
  std::vector<ListEntry> (*entries)();
  void (*print)(bool is_markdown) = nullptr;                ///< null: prints names and meanings
  bool is_in_overview = true;                               ///< shown by `chicane list` without a name
  Result<void> (*check)() = [] { return Result<void>(); };  ///< error if the files cannot be read

  /// Prints the list.
  void show(bool is_markdown) const { print != nullptr ? print(is_markdown) : print_names(entries()); }
};

/// List of files.
template <Shelf shelf>
constexpr List list_of(std::string_view name, void (*print)(bool) = nullptr) {
  return {name, file_entries<shelf>, print, true, [] { return protocol::check_shelf(shelf); }};
}

constexpr std::array kLists{
    list_of<Shelf::kPreset>("presets"),
    list_of<Shelf::kTrack>("tracks"),
    list_of<Shelf::kCar>("cars", print_cars),
    list_of<Shelf::kScenario>("scenarios"),
    List{"controllers", [] { return registry_entries(controller::Registry::kinds()); }},
    List{"plants", [] { return registry_entries(sim::plants()); }},
    List{"faults", [] { return registry_entries(sim::fault_kinds()); }, print_faults, false},
    List{"parameters", parameter_entries, print_parameters, false},
};

}  // namespace

std::vector<std::string> list_names() {
  std::vector<std::string> names;
  for (const List& list : kLists) names.emplace_back(list.name);
  return names;
}

std::vector<ListEntry> list_entries(std::string_view shelf) {
  for (const List& list : kLists)
    if (list.name == shelf) return list.entries();
  return {};
}

ExitCode list(const Options& options) {
  const bool is_overview = options.shelf.empty();
  std::string_view separator;
  for (const List& list : kLists) {
    if (!is_overview && list.name != options.shelf) continue;
    if (const auto readable = list.check(); !readable) return report(readable.error());
    if (is_overview && !list.is_in_overview) continue;
    if (is_overview) fmt::print("{}{}\n", std::exchange(separator, "\n"), list.name);
    list.show(options.is_markdown && !is_overview);
  }
  return kSuccess;
}

namespace {

constexpr double kStraight = 1e-6;  // [1/m] curvature below which a road is straight: rounding; chosen

/// Length in metres as text, with a digit more below 3 m (chosen), as on roads of model cars.
std::string metres(double length) { return fmt::format("{:.{}f}", length, length < 3.0 ? 2 : 1); }

/// Road of a run in words.
std::string road_in_words(const road::Track& track) {
  const double length = track.centre().length();
  const double step = std::min(1.0, length / 1000.0);  // [m] between samples; chosen
  double narrowest = track.left_width(0.0) + track.right_width(0.0);
  double sharpest = 0.0;
  for (double s = 0.0; s < length; s += step) {
    narrowest = std::min(narrowest, track.left_width(s) + track.right_width(s));
    sharpest = std::max(sharpest, std::abs(track.centre().at(s).curvature));
  }
  std::string text = fmt::format(
      "{} track, {:.1f} m long, at least {} m wide, {}", track.centre().is_closed() ? "closed" : "open",
      length, metres(narrowest),
      sharpest > kStraight ? fmt::format("tightest radius {} m", metres(1.0 / sharpest)) : "straight");
  if (track.crossings() > 0)
    text += fmt::format(", crosses itself in {} {}", track.crossings(),
                        track.crossings() == 1 ? "place" : "places");
  if (!track.centre().is_closed()) text += fmt::format(", {:.1f} m from start to finish", track.lap_length());
  return text;
}

/// Whether a file is a car: it has a plant, and only keys that a car file may have. Any other file is a
/// preset or scenario.
bool is_car(const protocol::Document& document, const std::string& file) {
  const auto& settings = document.assignments;
  const bool has_plant =
      std::any_of(settings.begin(), settings.end(),
                  [](const protocol::Assignment& setting) { return setting.parameter->key == "plant"; });
  return has_plant && !document.preset && protocol::compose({"", {{"car", file}}}).has_value();
}

/// Adds a file to the request. Returns its kind in words; an empty text for a track.
Result<std::string> add_file(const std::string& file, protocol::Request& request) {
  if (protocol::track_format_of(file) != nullptr) {
    request.settings.emplace_back("track", file);
    return std::string{};
  }
  const Result<std::string> text = protocol::read_file(file);
  if (!text) return fail(text.error());
  if (protocol::is_foreign_track(*text)) {
    request.settings.emplace_back("track", file);
    return std::string{};
  }
  const Result<protocol::Document> document = protocol::parse_document(*text, file);
  if (!document) return fail(document.error());
  const bool holds_car = is_car(*document, file);
  if (holds_car) {
    request.settings.emplace_back("car", file);
  } else {
    request.scenario_file = file;
  }
  return fmt::format("{}, {} settings", holds_car ? "car" : "preset or scenario",
                     document->assignments.size());
}

/// Checks one file together with the settings of the command line, as `drive` does. Returns what it is, in
/// words.
Result<std::string> check_file(const std::string& file, protocol::Request request) {
  Result<std::string> found = add_file(file, request);
  if (!found) return found;
  const auto run = prepared(request);
  if (!run) {
    const std::string& message = run.error().message;
    return fail(run.error().code, message.starts_with(file) ? message : fmt::format("{}: {}", file, message));
  }
  print_notices((*run)->scenario());
  return found->empty() ? road_in_words((*run)->track()) : found;
}

/// Checks the settings of the command line alone.
ExitCode check_experiment(const protocol::Request& request) {
  if (request.settings.empty() && request.speed_mps.empty() && request.faults.empty())
    return report({ErrorCode::kInvalidArgument, "check: got nothing, expected files or settings"});
  const auto run = prepared(request);
  if (!run) return report(run.error());
  const scenario::Scenario& scenario = (*run)->scenario();
  print_notices(scenario);
  fmt::print("ok, {} ({}) drives {} on {}\n", scenario.preset, scenario.controller, scenario.car,
             scenario.track);
  return kSuccess;
}

}  // namespace

ExitCode check(const Options& options) {
  const protocol::Request request = request_of(options);
  if (options.files.empty()) return check_experiment(request);
  ExitCode worst = kSuccess;
  for (const std::string& file : options.files) {
    const Result<std::string> found = check_file(file, request);
    if (found) {
      fmt::print("{}: ok, {}\n", file, *found);
    } else {
      worst = std::max(worst, report(found.error()));
    }
  }
  return worst;
}

}  // namespace chicane::apps
