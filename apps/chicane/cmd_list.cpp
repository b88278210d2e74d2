// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "chicane/controller/registry.hpp"
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

void print_shelf(Shelf shelf) {
  for (const protocol::Entry& entry : protocol::entries(shelf))
    fmt::print("{:<18} {}\n", entry.name, entry.description);
}

void print_controllers() {
  for (const auto& kind : controller::Registry::kinds()) fmt::print("{:<18} {}\n", kind.name, kind.meaning);
}

std::string default_of(const Parameter& parameter) {
  return protocol::get_text(scenario::Scenario{}, parameter);
}

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

void print_parameters() {
  for (const Parameter& parameter : protocol::list()) {
    fmt::print("{:<42} {:<14} {:<13} {}\n", parameter.key, default_of(parameter), parameter.option.unit.name,
               parameter.option.meaning);
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
