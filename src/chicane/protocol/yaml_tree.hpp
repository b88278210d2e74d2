// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/result.hpp"

namespace chicane::protocol {

struct YamlEntry;

/// One node of a YAML document.
struct YamlNode {
  enum class Kind : std::uint8_t { kNothing, kScalar, kList, kMap };

  Kind kind = Kind::kNothing;
  int line = 1;      ///< line on which it begins, from 1
  std::string text;  ///< text of a scalar
  std::string tag;   ///< "?" for a plain scalar, "!" for one in quotes, else the tag that was written
  std::vector<const YamlNode*> children;  ///< items of a list; of a map: key, value, key, value, …

  [[nodiscard]] bool is_scalar() const { return kind == Kind::kScalar; }
  [[nodiscard]] bool is_list() const { return kind == Kind::kList; }
  [[nodiscard]] bool is_map() const { return kind == Kind::kMap; }
  /// Entries of a map in written order: keys may repeat.
  [[nodiscard]] std::vector<YamlEntry> entries() const;
};

struct YamlEntry {
  const YamlNode& key;
  const YamlNode& value;
};

inline std::vector<YamlEntry> YamlNode::entries() const {
  std::vector<YamlEntry> all;
  all.reserve(children.size() / 2);
  for (std::size_t i = 0; is_map() && i + 1 < children.size(); i += 2)
    all.push_back({*children[i], *children[i + 1]});
  return all;
}

/// The nodes of one document. An alias is the node it refers to, so that walkers must count their steps.
struct YamlTree {
  /// Limit of nodes in one document, aliases not followed.
  static constexpr std::size_t kMostNodes = 50000;
  static constexpr std::size_t kMostDepth = 8;

  std::deque<YamlNode> nodes;      ///< addresses stay
  const YamlNode* root = nullptr;  ///< an empty file's: kNothing
};

/// Parses one document of at most 256 KiB event by event: memory and time are proportional to the text and
/// end at the limits above (docs/decisions/0016-yaml-by-events.md). kParse, "FILE:LINE: …", for text that is
/// not YAML or not UTF-8, indented by tabs, several documents, deeper nesting, more nodes, an alias of
/// nothing or of its own parent.
[[nodiscard]] Result<YamlTree> parse_yaml(std::string_view text, const std::string& file);

/// Parses the subset of YAML in shipped presets and cars: maps of plain scalars, nested by spaces, with
/// comments. Gives the tree that parse_yaml() gives. For builds without yaml-cpp (apps/page): its files are
/// our own, so that this is a check and no defence. kParse, "FILE:LINE: ...", for everything else that YAML
/// has: lists, quotes, braces, tags, anchors, several documents, tabs.
[[nodiscard]] Result<YamlTree> parse_plain_yaml(std::string_view text, const std::string& file);

}  // namespace chicane::protocol
