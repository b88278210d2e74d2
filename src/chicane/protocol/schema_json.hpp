// SPDX-License-Identifier: MIT
// Settings, controls and faults of a run as JSON for the dashboard, and faults as text in files and options.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/protocol/schema.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/sim/fault.hpp"

namespace chicane::protocol {

/// Control of a running run that is no setting: pace, manual driving, a fault.
struct Control {
  std::string_view key;  ///< "manual.steer"
  Option option;         ///< kind, range and meaning; without a field
  Value initial = false;
  const sim::FaultKind* fault = nullptr;  ///< fault that the control switches; null: none
};

/// Option of a control that is on or off, and, below, of one that is a number without a unit.
[[nodiscard]] constexpr Option switch_of(std::string_view meaning) {
  return {"", Kind::kBool, {}, 0.0, 0.0, meaning};
}
[[nodiscard]] constexpr Option number_of(double minimum, double maximum, std::string_view meaning) {
  return {"", Kind::kNumber, {}, minimum, maximum, meaning};
}

/// Shelf of a setting that names a file: "preset", "car", "track"; none for others.
[[nodiscard]] std::optional<Shelf> shelf_of(std::string_view key);

/// Settings as JSON, for a page that draws sliders: an array of {"key", "group", "kind": "number" | "integer"
/// | "bool" | "choice" | "text", "unit", "minimum", "maximum", "may_be_infinite", "choices", "default",
/// "start", "meaning", "is_live", "is_fixed"}, for faults "fault": {"group", "duration_s", "strength",
/// "weakest", "strongest", "strength_meaning"}. First come the schema's rows for which `is_offered` is true,
/// then the controls, which have no "start". "default" is the value in `defaults`, "start" that in `start`,
/// with which the run began. An infinite number is the text "inf". Preset, car and track have the shipped
/// names as choices. Reads folders.
[[nodiscard]] std::string schema_json(const scenario::Scenario& defaults, const scenario::Scenario& start,
                                      const std::function<bool(const Parameter&)>& is_offered,
                                      std::span<const Control> controls);

/// Event from "half_grip@12+5*0.5": half_grip at 12 s, for 5 s, with strength 0.5. Duration and strength may
/// be left out. Fails with kInvalidArgument and the expectation.
[[nodiscard]] Result<sim::FaultEvent> parse_fault(std::string_view text);

/// Event at 0 s from the value of the control "fault.half_grip": "true", or "+5*0.5" for a duration of 5 s
/// and a strength of 0.5, each of which may be left out. Fails with kInvalidArgument and the expectation.
[[nodiscard]] Result<sim::FaultEvent> read_switch(std::string_view name, std::string_view value);

/// Texts of a fault in a scenario file: {name: half_grip, at_s: 12, for_s: 5, strength: 0.5}; empty for those
/// left out.
struct FaultText {
  std::string name, at, duration, strength;
};
/// Event from its texts. Fails with kInvalidArgument "faults.for_s: got -1, expected a number in [0.001,
/// 1000000]".
[[nodiscard]] Result<sim::FaultEvent> read_fault(const FaultText& text);

/// Text `{name: half_grip, at_s: 12, for_s: 5, strength: 0.5}`, from which YAML reads the same bits.
[[nodiscard]] std::string write_fault(const sim::FaultEvent& event);

/// Names of the bits of telemetry::Frame::active_faults.
[[nodiscard]] std::vector<std::string> fault_names();

/// Control "fault.half_grip" for each kind of fault, for viewers.
[[nodiscard]] std::vector<Control> fault_controls();

/// Expected word for messages: "one of `chicane list faults`", with the nearest name if a typing mistake
/// explains the word.
[[nodiscard]] std::string expected_fault(std::string_view word);

}  // namespace chicane::protocol
