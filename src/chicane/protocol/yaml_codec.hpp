// SPDX-License-Identifier: MIT
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

/// Place for messages: "presets/x.yaml:7: ", "presets/x.yaml: " without a line, nothing without a file.
[[nodiscard]] std::string place(const std::string& file, int line);

/// Node for messages: "a map", "a list", "nothing", or its text, quoted as in the file.
[[nodiscard]] std::string shown(const YamlNode& node);

/// Reads the nodes of one file by tables of keys. A mismatch is a fault, "FILE:LINE: KEY: got X, expected Y";
/// reading continues, and all faults, at most kMostFaults, make one error.
class YamlReader {
 public:
  static constexpr std::size_t kMostFaults = 50;
  static constexpr double kEver = std::numeric_limits<double>::infinity();

  /// Takes a key with its value.
  using Take = std::function<void(const YamlEntry&)>;
  struct Key {
    std::string_view name;
    Take take;
  };

  enum class Others { kRefused, kIgnored };

  explicit YamlReader(std::string file) : file_{std::move(file)} {}

  void fault(int line, std::string_view key, std::string_view what);
  /// `error` has the key in its message.
  void fault(int line, const Error& error);
  /// Adds the fault "got NODE, expected EXPECTED" on the node's line.
  void refuse(const YamlNode& node, std::string_view key, std::string_view expected);
  /// The same of an entry's value, on the line of its key.
  void refuse(const YamlEntry& entry, std::string_view expected);
  [[nodiscard]] bool is_faultless() const { return faults_.empty(); }
  [[nodiscard]] bool is_full() const { return faults_.size() >= kMostFaults; }
  /// All faults, a line each; kParse.
  [[nodiscard]] Error error() const;

  /// Reads each key of a map by its row, at most once. Faults: no map ("expected EXPECTED"), a repeated key,
  /// a key without a row unless such keys are ignored. `name`: name of the map for messages. False after a
  /// fault.
  bool read_map(const YamlNode& node, std::string_view name, std::string_view expected,
                const std::vector<Key>& keys, Others others = Others::kRefused);
  // Rows of read_map(). `to` is as it was where the value is refused.

  /// One value that is not empty.
  [[nodiscard]] Take text(std::string& to, std::string_view expected = "text");
  /// One of these words.
  [[nodiscard]] Take choice(std::string& to, std::vector<std::string_view> words);
  /// A finite number in [least, most].
  [[nodiscard]] Take number(double& to, double least = -kEver, double most = kEver);
  /// A list of at most `most` nodes, each taken by `take`. `what`: the word for them.
  [[nodiscard]] Take list(std::string what, std::function<void(const YamlNode&)> take,
                          std::size_t most = 1000);

 private:
  std::string file_;
  std::vector<std::string> faults_;
};

/// One setting and where it was written.
struct Assignment {
  const Parameter* parameter = nullptr;
  Value value;
  int line = 0;  ///< line from 1; 0 = not from a file
};

/// The settings of one preset, scenario or car file: every value checked by itself, nothing applied yet.
struct Document {
  std::string file;  ///< name for messages; empty for settings from the command line
  std::optional<std::vector<sim::FaultEvent>> faults;  ///< the file's `faults:`, which replace earlier ones
  std::optional<std::string> preset;  ///< the file's `preset:`, whose settings come before its own
  int preset_line = 0;                ///< line of the preset, as Assignment::line
  std::vector<Assignment> assignments;
};

/// Reads a YAML map of settings, nested (`cubic_mpc: {horizon_steps: 20}`) or dotted
/// (`cubic_mpc.horizon_steps: 20`), with or without the wrapper of ROS 2 parameter files (`/**:
/// {ros__parameters: ...}`). JSON is YAML.
///
/// `faults:` is a list of {name, at_s, for_s, strength} (docs/safety.md); the last two may be left out.
///
/// Numbers have a decimal point in every locale. kParse lists all faults of the file, one on each line,
/// "presets/x.yaml:7: cubic_mpc.horizon_steps: got 500, expected an integer in [2, 200]": unknown, duplicate
/// and misplaced keys, wrong types, values out of range; files that are not UTF-8, indented by tabs, too
/// large, or nested too deeply. Any bytes may be given; memory and time stay bounded.
[[nodiscard]] Result<Document> parse_document(std::string_view text, const std::string& file);

/// All layers in order, later ones win; then the settings are checked against each other. `scenario` changes
/// completely or, on an error, not at all.
[[nodiscard]] Result<void> apply_layers(std::span<const Document> layers, scenario::Scenario& scenario);

/// A file, opening with `description` as a comment, that parse_document() reads back into the settings in
/// which `scenario` differs from the defaults, or into all of them when it `is_whole`, but for its preset's
/// name.
[[nodiscard]] std::string write_document(const scenario::Scenario& scenario, std::string_view description,
                                         bool is_whole = false);

/// Writes a preset that builds on `scenario.preset`: the settings in which `scenario` differs from `base`,
/// the result of that preset with the scenario's car; then the car and the track.
[[nodiscard]] std::string write_preset(const scenario::Scenario& scenario, const scenario::Scenario& base,
                                       std::string_view description);

}  // namespace chicane::protocol
