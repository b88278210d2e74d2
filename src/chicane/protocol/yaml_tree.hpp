// SPDX-License-Identifier: MIT
// YAML documents as trees of nodes, and the two parsers that make them.
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

/// Node of a YAML document.
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

/// Key and value of a map.
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

/// Nodes of one document. An alias is the node that it refers to: a walk over the tree can meet a node many
/// times, and must count its steps.
struct YamlTree {
  /// Limit of nodes in one document, aliases not followed.
  static constexpr std::size_t kMostNodes = 50000;
  /// Limit of nesting.
  static constexpr std::size_t kMostDepth = 8;

  std::deque<YamlNode> nodes;      ///< a deque, in which addresses do not change
  const YamlNode* root = nullptr;  ///< kNothing for an empty file
};

/// Parses one document of at most 256 KiB event by event: memory and time are proportional to the text and
/// bounded by the limits of YamlTree (docs/decisions/0016-yaml-by-events.md). Fails with kParse, "FILE:LINE:
/// …", for text that is not YAML or not UTF-8, indentation by tabs, several documents, deeper nesting, more
/// nodes, an alias of nothing or of its own parent.
[[nodiscard]] Result<YamlTree> parse_yaml(std::string_view text, const std::string& file);

/// Parses the subset of YAML in shipped presets and cars: maps of plain scalars, nested by spaces, with
/// comments. The tree equals that of parse_yaml(). For builds without yaml-cpp (apps/page), which read
/// shipped files alone: no defence against others. Fails with kParse, "FILE:LINE: ...", for everything
/// else that YAML has: lists, quotes, braces, tags, anchors, several documents, tabs.
[[nodiscard]] Result<YamlTree> parse_plain_yaml(std::string_view text, const std::string& file);

}  // namespace chicane::protocol
