// SPDX-License-Identifier: MIT
// Reader of plans from YAML, and the parts of the reader that plans, leagues and claims share.
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
///       - sample: {method: sobol, count: 64, seed: 3} # or latin-hypercube: fills ranges and lists evenly
///         latency_ms: {from: 50, to: 150}
///       - grip: {cases: {dry: {}, wet: {plant_options.friction_scale: 0.7}}}  # names for settings
///     search: {speed_mps: {from: 5, to: 80}}          # each run looks for its largest clean value
///     marks: [{speed_mph: 40, grip: dry}]             # places that the maps of the report mark
///     keep: [lap_time_s, off_track_events]            # columns; all when left out
///
/// kParse lists all faults, each with its line: unknown keys, values that no run could take, plans of more
/// than Plan::kMostRuns. Memory and time stay bounded, whatever the bytes (protocol/yaml_tree.hpp).
[[nodiscard]] Result<Plan> parse_plan(std::string_view text, const std::string& file);

/// Reads a plan from a file. kNotFound without the file; otherwise fails as parse_plan().
[[nodiscard]] Result<Plan> read_plan(const std::string& file);

}  // namespace chicane::sweep

namespace chicane::sweep::detail {

/// Adds a text to a hash, its length first: "ab", "c" and "a", "bc" differ.
inline void add_text(Fnv& hash, std::string_view text) {
  hash.add(static_cast<std::uint64_t>(text.size()));
  for (const char c : text) hash.add(static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
}

/// Reader of the parts that plans, leagues and claims share: settings, named entries, values and the search.
class SettingsReader : public protocol::YamlReader {
 public:
  using YamlReader::YamlReader;

  /// Adds the settings of a map. The key of a nested map becomes the prefix of its keys: {sensor:
  /// {yaw_noise_deg: 1}} is sensor.yaw_noise_deg.
  void read_settings(const protocol::YamlNode& map, Settings& settings, const std::string& prefix = "");
  /// Whether `node` may be a value of `key`. If not, adds a fault with the reason.
  bool takes(const std::string& key, const protocol::YamlNode& node);

  /// Entries of a map whose keys are names that the file chooses. Faults: no map, more than kMostNames
  /// entries, a repeated name.
  std::vector<protocol::YamlEntry> named(const protocol::YamlEntry& entry);
  static constexpr std::size_t kMostNames = 1000;  ///< bounds memory and time; chosen

  // Readers for the rows of read_map(): each fills its target, or adds a fault.

  /// Whole number in [least, 2^32 - 1].
  [[nodiscard]] Take count(std::uint64_t& to, std::uint64_t least);
  /// Map of settings.
  [[nodiscard]] Take settings(Settings& to);
  /// List of values of `key`.
  [[nodiscard]] Take values(const std::string& key, std::vector<std::string>& to);
  /// Search such as `{speed_mps: {from: 5, to: 80, factor: 1.25, within: 0.03}}`; empty after a fault.
  [[nodiscard]] Take search(std::optional<Search>& to);

 private:
  std::optional<Search> read_search(const protocol::YamlNode& map);
};

}  // namespace chicane::sweep::detail
