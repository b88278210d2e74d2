// SPDX-License-Identifier: MIT
// Table of all settings, by which files, command line, help and dashboard read, write and describe them.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/option.hpp"
#include "chicane/base/result.hpp"
#include "chicane/scenario/scenario.hpp"

/// The table has the rows of each options struct (base/option.hpp) under their keys in YAML files, --set, the
/// command line's help, the dashboard's sliders and docs/reference/configuration.md. A new setting is a new
/// row beside its field.
namespace chicane::protocol {

using Kind = OptionKind;
using Value = OptionValue;

/// Row of the table.
struct Parameter {
  std::string_view key;         ///< dotted, as in YAML and --set: "pure_pursuit.lookahead_time_s"
  std::string_view group;       ///< part of the key before the dot; empty for the run's own
  std::string_view controller;  ///< controller that has the option: "pure-pursuit"; else empty
  Option option;
  void* (*owner)(scenario::Scenario&) = nullptr;  ///< the options struct in a scenario
};

/// All rows in the order of the reference page: run, controllers, vehicle, world.
[[nodiscard]] std::span<const Parameter> list();
/// Whether a change applies from the next control step of a run on; else the run must restart.
[[nodiscard]] bool is_live(const Parameter& parameter);
/// Whether the operator alone may set it, at the start: settings of the guard, and of the car's model, on
/// which the guard and the limits of commands depend. Viewers see the value; simulated futures may vary it.
[[nodiscard]] bool is_fixed(const Parameter& parameter);
/// Row of `key`; null if there is none. Finds a key that was renamed in this version also by its old name, as
/// files and recordings of the last version have it.
[[nodiscard]] const Parameter* find(std::string_view key);
/// Row of a controller's option, find_option("pure-pursuit", "lookahead_time"); null if there is none.
[[nodiscard]] const Parameter* find_option(std::string_view controller, std::string_view name);
/// Most similar word among `known` if a typing mistake explains `word`; else empty.
[[nodiscard]] std::string_view nearest(std::string_view word, std::span<const std::string_view> known);
/// First key of a group: "guard.mode" of "guard"; empty if there is no such group.
[[nodiscard]] std::string_view first_of(std::string_view group);
/// Suggestion for messages: " (did you mean cubic_mpc.horizon_steps?)"; empty if no key is similar. `driver`:
/// controller that drives, whose options are suggested before those of others.
[[nodiscard]] std::string suggestion(std::string_view key, std::string_view driver = {});
/// Fault of an unknown key for messages: "got an unknown key, expected ...", with the suggestion.
[[nodiscard]] std::string unknown_key(std::string_view key, std::string_view driver = {});
/// Value of a setting, in the unit of its key.
[[nodiscard]] Value get(const scenario::Scenario& scenario, const Parameter& parameter);
/// Sets a value. Fails with kInvalidArgument "latency_ms: got 900, expected a number in [0, 500] ms", and
/// changes nothing, for a wrong type or a value out of range.
[[nodiscard]] Result<void> set(scenario::Scenario& scenario, const Parameter& parameter, const Value& value);

/// Value of a text: "20", "0.025", "inf", "true", "pid", with a decimal point in every locale. Fails as set()
/// does.
[[nodiscard]] Result<Value> parse(const Parameter& parameter, std::string_view text);
/// Text that parse() turns back into the same value.
[[nodiscard]] std::string text_of(const Value& value);
/// Shortest text that set_text() turns back into the same value.
[[nodiscard]] std::string get_text(const scenario::Scenario& scenario, const Parameter& parameter);
/// Sets a value by key and text, as --set does. Fails as parse() does, and with kNotFound and a suggestion
/// for an unknown key.
[[nodiscard]] Result<void> set_text(scenario::Scenario& scenario, std::string_view key,
                                    std::string_view text);

/// Contradiction of two settings, each of which is in range.
struct Contradiction {
  std::string_view key;  ///< key of the setting to change
  std::string message;   ///< "got 50 ms, expected ... "
};
/// All contradictions of a scenario.
[[nodiscard]] std::vector<Contradiction> contradictions(const scenario::Scenario& scenario);

}  // namespace chicane::protocol
