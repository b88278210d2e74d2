// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "chicane/protocol/library.hpp"
#include "chicane/protocol/schema.hpp"
#include "chicane/sim/fault.hpp"
#include "commands.hpp"

namespace chicane::apps {
namespace {

using protocol::Parameter;
using protocol::Shelf;

constexpr std::array<std::pair<std::string_view, Shelf>, 4> kShelves{{{"presets", Shelf::kPreset},
                                                                      {"tracks", Shelf::kTrack},
                                                                      {"cars", Shelf::kCar},
                                                                      {"scenarios", Shelf::kScenario}}};

constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kControllers{
    {{"tracking-mpc", "ours: arc-length reference, yaw lag, commands in flight, planned speed"},
     {"cubic-mpc", "the one the write-ups describe: kinematic bicycle, cubic in the car's frame"},
     {"pid", "steering on the cross-track error"},
     {"pure-pursuit", "steering along the circle through a point ahead"},
     {"stanley", "steering by heading error and front-axle cross-track error"}}};

void print_shelf(Shelf shelf) {
  for (const protocol::Entry& entry : protocol::entries(shelf))
    fmt::print("{:<18} {}\n", entry.name, entry.description);
}

void print_controllers() {
  for (const auto& [name, description] : kControllers) fmt::print("{:<18} {}\n", name, description);
}

std::string default_of(const Parameter& parameter) {
  return protocol::get_text(scenario::Scenario{}, parameter);
}

std::string range_of(const Parameter& parameter) {
  switch (parameter.kind()) {
    case protocol::Kind::kChoice:
      return fmt::format("{}", fmt::join(parameter.choices, ", "));
    case protocol::Kind::kBool:
      return "true, false";
    case protocol::Kind::kText:
      return "text";
    case protocol::Kind::kNumber:
    case protocol::Kind::kInteger:
      break;
  }
  return fmt::format("{} … {}{}", parameter.minimum, parameter.maximum,
                     parameter.may_be_infinite ? ", inf" : "");
}

void print_parameters() {
  for (const Parameter& parameter : protocol::list()) {
    fmt::print("{:<42} {:<14} {:<13} {}\n", parameter.key, default_of(parameter), parameter.unit.name,
               parameter.meaning);
  }
}

/// docs/configuration.md.
void print_page() {
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
  std::string group = "-";
  for (const Parameter& parameter : protocol::list()) {
    const std::size_t dot = parameter.key.find('.');
    const std::string own(dot == std::string_view::npos ? "" : parameter.key.substr(0, dot));
    if (own != group) {
      fmt::print("\n## {}\n\n| key | default | unit | range | meaning |\n|---|---|---|---|---|\n",
                 own.empty() ? "The run" : own);
      group = own;
    }
    fmt::print("| `{}` | {} | {} | {} | {} |\n", parameter.key, default_of(parameter), parameter.unit.name,
               range_of(parameter), parameter.meaning);
  }
}

std::string strength_of(const sim::FaultKind& kind) {
  return kind.strength_meaning.empty() ? "" : fmt::format("{}", kind.strength);
}

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
      fmt::print("{:<18} {:>4} s  {:<4} {}{}\n", kind.name, kind.duration, strength_of(kind), kind.meaning,
                 kind.strength_meaning.empty() ? "" : fmt::format(" Strength: {}.", kind.strength_meaning));
    }
  }
}

}  // namespace

ExitCode list(const Options& options) {
  if (options.shelf == "parameters") {
    options.is_markdown ? print_page() : print_parameters();
  } else if (options.shelf == "faults") {
    print_faults(options.is_markdown);
  } else if (options.shelf == "controllers") {
    print_controllers();
  } else if (!options.shelf.empty()) {
    const auto* const row = std::find_if(kShelves.begin(), kShelves.end(),
                                         [&](const auto& shelf) { return shelf.first == options.shelf; });
    print_shelf(row->second);
  } else {
    for (const auto& [name, shelf] : kShelves) {
      fmt::print("{}\n", name);
      print_shelf(shelf);
      fmt::print("\n");
    }
    fmt::print("controllers\n");
    print_controllers();
  }
  return kSuccess;
}

}  // namespace chicane::apps
