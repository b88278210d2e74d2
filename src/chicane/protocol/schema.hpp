// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/scenario/scenario.hpp"

/// Everything tunable in one table. YAML files, --set, the command line's help, the dashboard's sliders and
/// the reference page (docs/configuration.md) all read it; to add a tunable is to add one row in schema.cpp.
namespace chicane::protocol {

/// Outside C++ every number carries its unit in the key's suffix. SI value = value outside · factor /
/// divisor.
struct Unit {
  std::string_view name;    ///< for people: "m/s", "ms", "deg"; empty for pure numbers
  std::string_view suffix;  ///< the end of the key: "_mps", "_ms", "_deg"; empty where the name needs none
  double factor = 1.0;
  double divisor = 1.0;
};

enum class Kind { kNumber, kInteger, kBool, kChoice, kText };

/// Outside C++, in the parameter's own unit: number and integer are double, choice and text std::string.
using Value = std::variant<double, bool, std::string>;

/// Where a tunable lives in a Scenario.
using Field = std::variant<double*, int*, std::uint64_t*, bool*, std::string*, controller::LatencyHandling*>;

/// One row of the table.
struct Parameter {
  std::string_view key;  ///< dotted, as in YAML and --set: "cubic_mpc.horizon_steps"
  Unit unit;
  double minimum = 0.0;  ///< in `unit`; numbers and integers only
  double maximum = 0.0;
  std::string_view meaning;  ///< one sentence
  Field (*field)(scenario::Scenario&) = nullptr;
  std::span<const std::string_view> choices{};
  bool may_be_infinite = false;  ///< beside [minimum, maximum], "inf" means no limit

  [[nodiscard]] Kind kind() const;
};

/// All tunables in the order of the reference page: run, controllers, vehicle, world.
[[nodiscard]] std::span<const Parameter> list();
/// Whether a run that goes on can take the change up at its next control step; otherwise it must start anew.
[[nodiscard]] bool is_live(const Parameter& parameter);
/// The row of `key`; nullptr when there is none.
[[nodiscard]] const Parameter* find(std::string_view key);
/// The most similar thing among `known` when a typing mistake could explain `word`; otherwise empty.
[[nodiscard]] std::string_view nearest(std::string_view word, std::span<const std::string_view> known);
/// For messages: " (did you mean cubic_mpc.horizon_steps?)", or empty when nothing is similar.
[[nodiscard]] std::string suggestion(std::string_view key);
/// For messages: "got an unknown key, expected ...", with the suggestion.
[[nodiscard]] std::string unknown_key(std::string_view key);
/// For messages: the first 60 bytes of a stranger's text without control characters; "nothing" when empty.
[[nodiscard]] std::string quoted(std::string_view text);
/// For messages: "an integer in [2, 200]", "a number in [0, 500] ms", "one of pid, stanley", "true or false".
[[nodiscard]] std::string expectation(const Parameter& parameter);

[[nodiscard]] Value get(const scenario::Scenario& scenario, const Parameter& parameter);
/// kInvalidArgument "latency_ms: got 900, expected a number in [0, 500] ms", and no change, for a wrong type
/// or range.
[[nodiscard]] Result<void> set(scenario::Scenario& scenario, const Parameter& parameter, const Value& value);

/// Text in the C locale whatever the environment says, "20", "0.025", "inf", "true", "pid"; same errors as
/// set().
[[nodiscard]] Result<Value> parse(const Parameter& parameter, std::string_view text);
/// The shortest text that set_text() turns back into the same value.
[[nodiscard]] std::string get_text(const scenario::Scenario& scenario, const Parameter& parameter);
/// What --set does: key and text as a user wrote them. kNotFound with a suggestion for an unknown key.
[[nodiscard]] Result<void> set_text(scenario::Scenario& scenario, std::string_view key,
                                    std::string_view text);

/// Two settings that are each in range and exclude each other.
struct Contradiction {
  std::string_view key;  ///< the one to change
  std::string message;   ///< "got 50 ms, expected ... "
};
[[nodiscard]] std::vector<Contradiction> contradictions(const scenario::Scenario& scenario);

}  // namespace chicane::protocol
