// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/protocol/yaml_tree.hpp"
#include "chicane/sweep/plan.hpp"

namespace chicane::sweep::detail {

/// For messages: "a map", "a list", or the text.
[[nodiscard]] std::string shown(const protocol::YamlNode& node);

/// What plans and leagues have in common: settings, the search, and all faults with their lines.
class SettingsReader {
 public:
  explicit SettingsReader(std::string file) : file_{std::move(file)} {}

  void fault(int line, std::string_view key, std::string_view what);
  void fault(int line, const Error& error);
  [[nodiscard]] bool is_faultless() const { return faults_.empty(); }
  /// All faults, a line each.
  [[nodiscard]] Error error() const;

  /// Adds the settings of a map; those of a map within it have its key before theirs.
  void read_settings(const protocol::YamlNode& map, Settings& settings, const std::string& prefix = "");
  /// Whether this may be a value of that key; says why not.
  bool takes(const std::string& key, const protocol::YamlNode& node);
  /// `{speed_mps: {from: 5, to: 80, factor: 1.25, within: 0.03}}`; nothing after a fault.
  std::optional<Search> read_search(const protocol::YamlNode& map);

 private:
  std::string file_;
  std::vector<std::string> faults_;
};

}  // namespace chicane::sweep::detail
