// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "chicane/protocol/yaml_codec.hpp"
#include "chicane/sweep/plan.hpp"

namespace chicane::sweep::detail {

/// What plans, leagues and claims have in common: settings, and the search.
class SettingsReader : public protocol::YamlReader {
 public:
  using YamlReader::YamlReader;

  /// Adds the settings of a map; those of a map within it have its key before theirs.
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
