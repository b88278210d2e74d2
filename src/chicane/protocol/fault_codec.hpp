// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/protocol/schema_json.hpp"
#include "chicane/sim/fault.hpp"

namespace chicane::protocol {

/// "half_grip@12+5*0.5": half_grip at 12 s, for 5 s, of strength 0.5. Duration and strength may be left out.
/// kInvalidArgument with what was expected.
[[nodiscard]] Result<sim::FaultEvent> parse_fault(std::string_view text);

/// The value of the switch "fault.half_grip" as an event at 0 s: "true", or "+5*0.5" for a duration of 5 s
/// and a strength of 0.5, each of which may be left out. kInvalidArgument with what was expected.
[[nodiscard]] Result<sim::FaultEvent> read_switch(std::string_view name, std::string_view value);

/// What a scenario file says of one fault, as it is written: {name: half_grip, at_s: 12, for_s: 5, strength:
/// 0.5}. Empty: left out.
struct FaultText {
  std::string name, at, duration, strength;
};
/// kInvalidArgument "faults.for_s: got -1, expected a number in [0.001, 1000000]".
[[nodiscard]] Result<sim::FaultEvent> read_fault(const FaultText& text);

/// `{name: half_grip, at_s: 12, for_s: 5, strength: 0.5}`, which reads back into the same bits.
[[nodiscard]] std::string write_fault(const sim::FaultEvent& event);

/// Names of the bits of telemetry::Frame::active_faults.
[[nodiscard]] std::vector<std::string> fault_names();

/// A switch "fault.half_grip" for each, for viewers.
[[nodiscard]] std::vector<Control> fault_controls();

/// For messages: "one of `chicane list faults`", and the nearest name when a typing mistake explains it.
[[nodiscard]] std::string expected_fault(std::string_view word);

}  // namespace chicane::protocol
