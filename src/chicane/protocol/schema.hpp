// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/option.hpp"
#include "chicane/base/result.hpp"
#include "chicane/scenario/scenario.hpp"

/// Table of all settings: the rows of each options struct (base/option.hpp) under the keys of YAML files,
/// --set, the command line's help, the dashboard's sliders and docs/reference/configuration.md. A new setting
/// is a new row beside its field.
namespace chicane::protocol {

using Kind = OptionKind;
using Value = OptionValue;

/// One row of the table.
struct Parameter {
  std::string_view key;         ///< dotted, as in YAML and --set: "pure_pursuit.lookahead_time_s"
  std::string_view group;       ///< part of the key before the dot; empty for the run's own
  std::string_view controller;  ///< controller that has the option: "pure-pursuit"; else empty
  Option option;
  void* (*owner)(scenario::Scenario&) = nullptr;  ///< the options struct in a scenario
};

/// All tunables in the order of the reference page: run, controllers, vehicle, world.
[[nodiscard]] std::span<const Parameter> list();
/// Whether a run takes the change up at its next control step; otherwise it must restart.
[[nodiscard]] bool is_live(const Parameter& parameter);
/// Whether only the operator may set it, at the start: the guard, and the car's model, which the guard and
/// the limits of its commands follow from. Viewers see the value; futures that only predict may vary it.
[[nodiscard]] bool is_fixed(const Parameter& parameter);
/// The row of `key`; nullptr when there is none. Finds a key renamed in this version by its old name, too, so
/// that files and recordings of the last version keep their meaning.
[[nodiscard]] const Parameter* find(std::string_view key);
/// The row of a controller's option: find_option("pure-pursuit", "lookahead_time").
[[nodiscard]] const Parameter* find_option(std::string_view controller, std::string_view name);
/// The most similar thing among `known` when a typing mistake could explain `word`; otherwise empty.
[[nodiscard]] std::string_view nearest(std::string_view word, std::span<const std::string_view> known);
/// The first key of a group: "guard.mode" of "guard"; empty where there is no such group.
[[nodiscard]] std::string_view first_of(std::string_view group);
/// Suggestion for messages: " (did you mean cubic_mpc.horizon_steps?)"; empty if no key is similar. Given the
/// driver, options of other controllers come last: they would have no effect.
[[nodiscard]] std::string suggestion(std::string_view key, std::string_view driver = {});
/// Fault of an unknown key for messages: "got an unknown key, expected ...", with the suggestion.
[[nodiscard]] std::string unknown_key(std::string_view key, std::string_view driver = {});
[[nodiscard]] Value get(const scenario::Scenario& scenario, const Parameter& parameter);
/// Sets a value. kInvalidArgument "latency_ms: got 900, expected a number in [0, 500] ms", and no change, for
/// a wrong type or range.
[[nodiscard]] Result<void> set(scenario::Scenario& scenario, const Parameter& parameter, const Value& value);

/// Text in the C locale whatever the environment says, "20", "0.025", "inf", "true", "pid"; same errors as
/// set().
[[nodiscard]] Result<Value> parse(const Parameter& parameter, std::string_view text);
/// Text that parse() turns back into the same value.
[[nodiscard]] std::string text_of(const Value& value);
/// The shortest text that set_text() turns back into the same value.
[[nodiscard]] std::string get_text(const scenario::Scenario& scenario, const Parameter& parameter);
/// Sets a value as --set does: key and text as a user wrote them. kNotFound with a suggestion for an unknown
/// key.
[[nodiscard]] Result<void> set_text(scenario::Scenario& scenario, std::string_view key,
                                    std::string_view text);

/// Two settings that are each in range and exclude each other.
struct Contradiction {
  std::string_view key;  ///< the one to change
  std::string message;   ///< "got 50 ms, expected ... "
};
[[nodiscard]] std::vector<Contradiction> contradictions(const scenario::Scenario& scenario);

}  // namespace chicane::protocol
