// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/protocol/schema.hpp"

namespace chicane::protocol {

/// One setting and where it was written.
struct Assignment {
  const Parameter* parameter = nullptr;
  Value value;
  int line = 0;  ///< from 1; 0 = not from a file
};

/// The settings of one preset, scenario or car file: every value checked by itself, nothing applied yet.
struct Document {
  std::string file;  ///< for messages; empty for settings from the command line
  std::optional<std::vector<sim::FaultEvent>> faults;  ///< the file's `faults:`, which replace earlier ones
  std::optional<std::string> preset;  ///< the file's `preset:`, whose settings come before its own
  int preset_line = 0;                ///< where it stands, as Assignment::line
  std::vector<Assignment> assignments;
};

/// Reads a YAML map of settings, nested (`cubic_mpc: {horizon_steps: 20}`) or dotted
/// (`cubic_mpc.horizon_steps: 20`), with or without the wrapper of ROS 2 parameter files (`/**:
/// {ros__parameters: ...}`). JSON is YAML.
///
/// `faults:` is a list of {name, at_s, for_s, strength} (docs/faults.md); the last two may be left out.
///
/// Numbers have a decimal point in every locale. kParse lists all faults of the file, one on each line,
/// "presets/x.yaml:7: cubic_mpc.horizon_steps: got 500, expected an integer in [2, 200]": unknown, duplicate
/// and misplaced keys, wrong types, values out of range; files that are not UTF-8, indented by tabs, too
/// large, or nested too deeply. Any bytes may be given; memory and time stay bounded.
[[nodiscard]] Result<Document> parse_document(std::string_view text, const std::string& file);

/// "presets/x.yaml:7: ", "presets/x.yaml: " without a line, nothing without a file.
[[nodiscard]] std::string place(const std::string& file, int line);

/// All layers in order, later ones win; then the settings are checked against each other. `scenario` changes
/// completely or, on an error, not at all.
[[nodiscard]] Result<void> apply_layers(std::span<const Document> layers, scenario::Scenario& scenario);

/// A file, opening with `description` as a comment, that parse_document() reads back into the settings in
/// which `scenario` differs from the defaults, or into all of them when it `is_whole`, but for its preset's
/// name.
[[nodiscard]] std::string write_document(const scenario::Scenario& scenario, std::string_view description,
                                         bool is_whole = false);

/// The same for a preset that builds on `scenario.preset`: the settings in which `scenario` differs from
/// `base`, which is what that preset gives with the scenario's car; beside them the car and the track.
[[nodiscard]] std::string write_preset(const scenario::Scenario& scenario, const scenario::Scenario& base,
                                       std::string_view description);

}  // namespace chicane::protocol
