// SPDX-License-Identifier: MIT
// Settings in YAML files: reading with all faults, application of layers to a scenario, and writing.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/protocol/schema.hpp"
#include "chicane/protocol/yaml_tree.hpp"

namespace chicane::protocol {

/// Position for messages: "presets/x.yaml:7: ", "presets/x.yaml: " without a line (0), empty without a file.
[[nodiscard]] std::string place(const std::string& file, int line);

/// Node for messages: "a map", "a list", "nothing", or its text, with "in quotes" if it has them in the file.
[[nodiscard]] std::string shown(const YamlNode& node);

/// Reader of the nodes of one file by tables of keys. A mismatch is a fault, "FILE:LINE: KEY: got X, expected
/// Y". Reading goes on after a fault, and error() has all of them, at most kMostFaults.
class YamlReader {
 public:
  static constexpr std::size_t kMostFaults = 50;  ///< chosen: more than anybody reads
  static constexpr double kEver = std::numeric_limits<double>::infinity();  ///< no bound

  /// Function that reads the value of a key.
  using Take = std::function<void(const YamlEntry&)>;
  /// Row of a table of keys.
  struct Key {
    std::string_view name;
    Take take;
  };

  /// Treatment of keys without a row.
  enum class Others { kRefused, kIgnored };

  explicit YamlReader(std::string file) : file_{std::move(file)} {}

  /// Adds the fault "FILE:LINE: KEY: WHAT".
  void fault(int line, std::string_view key, std::string_view what);
  /// Adds the fault "FILE:LINE: MESSAGE" of an error, whose message has the key.
  void fault(int line, const Error& error);
  /// Adds the fault "got NODE, expected EXPECTED" on the node's line.
  void refuse(const YamlNode& node, std::string_view key, std::string_view expected);
  /// Adds the fault "got VALUE, expected EXPECTED" of an entry, on the line of its key.
  void refuse(const YamlEntry& entry, std::string_view expected);
  [[nodiscard]] bool is_faultless() const { return faults_.empty(); }
  [[nodiscard]] bool is_full() const { return faults_.size() >= kMostFaults; }
  /// All faults, a line each; kParse.
  [[nodiscard]] Error error() const;

  /// Reads each key of a map by its row. Faults: a node that is no map ("expected EXPECTED"), a repeated key,
  /// and a key without a row unless `others` ignores it. `name`: of the map, for messages. False after a
  /// fault.
  bool read_map(const YamlNode& node, std::string_view name, std::string_view expected,
                const std::vector<Key>& keys, Others others = Others::kRefused);
  // Functions for rows of read_map(). A refused value leaves `to` unchanged.

  /// One value that is not empty.
  [[nodiscard]] Take text(std::string& to, std::string_view expected = "text");
  /// One of these words.
  [[nodiscard]] Take choice(std::string& to, std::vector<std::string_view> words);
  /// A finite number in [least, most].
  [[nodiscard]] Take number(double& to, double least = -kEver, double most = kEver);
  /// A list of at most `most` nodes, each of which `take` reads. `what`: word for the nodes in messages.
  [[nodiscard]] Take list(std::string what, std::function<void(const YamlNode&)> take,
                          std::size_t most = 1000);

 private:
  std::string file_;
  std::vector<std::string> faults_;
};

/// Value of one setting, and its position.
struct Assignment {
  const Parameter* parameter = nullptr;
  Value value;
  int line = 0;  ///< line in the file, from 1; 0: not from a file
};

/// Settings of one preset, scenario or car file, each value checked by itself.
struct Document {
  std::string file;  ///< name for messages; empty for settings from the command line
  std::optional<std::vector<sim::FaultEvent>> faults;  ///< key `faults:`; replaces those of earlier layers
  std::optional<std::string> preset;  ///< key `preset:`; its settings come before those of the file
  int preset_line = 0;                ///< line of the preset, as Assignment::line
  std::vector<Assignment> assignments;
};

/// Parses a YAML map of settings, nested (`cubic_mpc: {horizon_steps: 20}`) or dotted
/// (`cubic_mpc.horizon_steps: 20`), with or without the wrapper of ROS 2 parameter files (`/**:
/// {ros__parameters: ...}`). JSON is YAML.
///
/// `faults:` is a list of {name, at_s, for_s, strength} (docs/safety.md); the last two may be left out.
///
/// Numbers have a decimal point in every locale. Fails with kParse and all faults of the file, one on each
/// line, "presets/x.yaml:7: cubic_mpc.horizon_steps: got 500, expected an integer in [2, 200]": unknown,
/// duplicate and misplaced keys, wrong types, values out of range; files that are not UTF-8, indented by
/// tabs, too large, or nested too deeply. Any bytes may be given; memory and time stay bounded.
[[nodiscard]] Result<Document> parse_document(std::string_view text, const std::string& file);

/// Applies layers in order, so that later ones override earlier ones; then checks the settings against each
/// other. `scenario` is unchanged after an error.
[[nodiscard]] Result<void> apply_layers(std::span<const Document> layers, scenario::Scenario& scenario);

/// Writes a file with `description` as a comment at the top, from which parse_document() reads the settings
/// of `scenario` that differ from the defaults, or all settings if `is_whole`. The name of the preset is left
/// out.
[[nodiscard]] std::string write_document(const scenario::Scenario& scenario, std::string_view description,
                                         bool is_whole = false);

/// Writes a preset that builds on `scenario.preset`: the settings in which `scenario` differs from `base`,
/// the result of that preset with the scenario's car; then the car and the track.
[[nodiscard]] std::string write_preset(const scenario::Scenario& scenario, const scenario::Scenario& base,
                                       std::string_view description);

}  // namespace chicane::protocol
