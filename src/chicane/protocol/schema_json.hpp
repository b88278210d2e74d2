// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "chicane/protocol/library.hpp"
#include "chicane/protocol/schema.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/sim/fault.hpp"

namespace chicane::protocol {

/// Something to set that exists only while a run goes on, beside the tunables of the schema: pace, a person's
/// hands, a fault.
struct Control {
  std::string_view key;  ///< "manual.steer"
  Option option;         ///< its kind, range and meaning; has no field
  Value initial = false;
  const sim::FaultKind* fault = nullptr;  ///< of a switch for a fault; else null
};

/// Options of controls: on or off, and a number without a unit.
[[nodiscard]] constexpr Option switch_of(std::string_view meaning) {
  return {"", Kind::kBool, {}, 0.0, 0.0, meaning};
}
[[nodiscard]] constexpr Option number_of(double minimum, double maximum, std::string_view meaning) {
  return {"", Kind::kNumber, {}, minimum, maximum, meaning};
}

/// The shelf of a setting whose text may name a file: "preset", "car", "track".
[[nodiscard]] std::optional<Shelf> shelf_of(std::string_view key);

/// What a page needs to draw sliders, as JSON: an array of {"key", "group", "kind": "number" | "integer" |
/// "bool" | "choice" | "text", "unit", "minimum", "maximum", "may_be_infinite", "choices", "default",
/// "start", "meaning", "is_live", "is_fixed"}, for faults "fault": {"group", "duration_s", "strength",
/// "weakest", "strongest", "strength_meaning"}, the schema's rows that `is_offered` lets in, then the
/// controls. `defaults` says what "default" is, `start` with what the run started; controls have no "start".
/// A number that is infinite is the text "inf". Preset, car and track offer what ships. Reads folders.
[[nodiscard]] std::string schema_json(const scenario::Scenario& defaults, const scenario::Scenario& start,
                                      const std::function<bool(const Parameter&)>& is_offered,
                                      std::span<const Control> controls);

}  // namespace chicane::protocol
