// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "chicane/protocol/schema.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/sim/fault.hpp"

namespace chicane::protocol {

/// Something to set that exists only while a run goes on, beside the tunables of the schema: pace, a person's
/// hands, a fault.
struct Control {
  std::string_view key;  ///< "manual.steer"
  Kind kind = Kind::kBool;
  std::string_view unit;  ///< for people
  double minimum = 0.0;   ///< numbers only
  double maximum = 0.0;
  Value initial = false;
  std::string_view meaning;               ///< one sentence
  const sim::FaultKind* fault = nullptr;  ///< of a switch for a fault; else null
};

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
