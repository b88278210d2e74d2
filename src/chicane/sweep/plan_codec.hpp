// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/random.hpp"
#include "chicane/base/result.hpp"
#include "chicane/protocol/yaml_codec.hpp"
#include "chicane/sweep/plan.hpp"

namespace chicane::sweep {

/// Reads a plan (docs/sweep.md has the grammar):
///
///     name: dt at lower speed
///     settings: {preset: fast-short-step, laps: 3}    # of all runs, as in a preset
///     axes:                                           # each run has one value of each
///       - speed_mph: [30, 40, 50]                     # a list
///       - track: [oval, ../tracks/*.csv]              # of tracks also a folder
///       - cubic_mpc.step_length_s: {from: 0.02, to: 0.2, count: 10, scale: log}
///       - cubic_mpc.horizon_steps: [125, 25]          # two keys of one axis change together
///         cubic_mpc.step_length_s: [0.005, 0.025]
///       - sample: {method: sobol, count: 64, seed: 3} # or latin-hypercube: ranges and lists are filled
///       evenly
///         latency_ms: {from: 50, to: 150}
///       - grip: {cases: {dry: {}, wet: {plant_options.friction_scale: 0.7}}}  # names for settings
///     search: {speed_mps: {from: 5, to: 80}}          # each run looks for its largest clean value
///     marks: [{speed_mph: 40, grip: dry}]             # places that the maps of the report mark
///     keep: [lap_time_s, off_track_events]            # columns; all when left out
///
/// kParse lists all faults, each with its line: unknown keys, values that no run could take, plans of more
/// than Plan::kMostRuns. Memory and time stay bounded, whatever the bytes (protocol/yaml_tree.hpp).
[[nodiscard]] Result<Plan> parse_plan(std::string_view text, const std::string& file);

/// The same of a file; kNotFound when there is none.
[[nodiscard]] Result<Plan> read_plan(const std::string& file);

}  // namespace chicane::sweep

namespace chicane::sweep::detail {

/// Adds a text with its length, so that the next one cannot merge with it.
inline void add_text(Fnv& hash, std::string_view text) {
  hash.add(static_cast<std::uint64_t>(text.size()));
  for (const char c : text) hash.add(static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
}

/// Parts that plans, leagues and claims share: settings, and the search.
class SettingsReader : public protocol::YamlReader {
 public:
  using YamlReader::YamlReader;

  /// Adds the settings of a map; in a nested map its key becomes the prefix.
  void read_settings(const protocol::YamlNode& map, Settings& settings, const std::string& prefix = "");
  /// Whether this may be a value of that key; says why not.
  bool takes(const std::string& key, const protocol::YamlNode& node);

  /// The entries of a map whose keys are names of the file's own. Faults: no map, more than kMostNames, a
  /// name that comes twice.
  std::vector<protocol::YamlEntry> named(const protocol::YamlEntry& entry);
  static constexpr std::size_t kMostNames = 1000;

  // Rows of read_map().

  /// A whole number in [least, 2^32 - 1].
  [[nodiscard]] Take count(std::uint64_t& to, std::uint64_t least);
  [[nodiscard]] Take settings(Settings& to);
  /// A list of values of `key`.
  [[nodiscard]] Take values(const std::string& key, std::vector<std::string>& to);
  /// `{speed_mps: {from: 5, to: 80, factor: 1.25, within: 0.03}}`; nothing after a fault.
  [[nodiscard]] Take search(std::optional<Search>& to);

 private:
  std::optional<Search> read_search(const protocol::YamlNode& map);
};

}  // namespace chicane::sweep::detail
