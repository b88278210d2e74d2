// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "chicane/base/result.hpp"

namespace chicane::survey {

/// An element of an XML document. Names are without their namespace's prefix.
struct XmlNode {
  std::string name;
  int line = 1;      ///< where it begins, from 1
  std::string text;  ///< all characters directly inside
  std::vector<std::pair<std::string, std::string>> attributes;
  std::vector<const XmlNode*> children;

  /// The first child of a name; nullptr when there is none.
  [[nodiscard]] const XmlNode* child(std::string_view child_name) const noexcept;
  /// Empty when there is none.
  [[nodiscard]] std::string_view attribute(std::string_view attribute_name) const noexcept;
  /// A finite number; nothing where there is no such attribute, or no number in it.
  [[nodiscard]] std::optional<double> number(std::string_view attribute_name) const noexcept;
};

struct XmlTree {
  static constexpr std::size_t kMostBytes = std::size_t{32} << 20U;
  static constexpr std::size_t kMostNodes = 1'000'000;
  static constexpr std::size_t kMostDepth = 64;

  std::deque<XmlNode> nodes;  ///< addresses stay; the first one is the root
  [[nodiscard]] const XmlNode& root() const noexcept { return nodes.front(); }
};

/// Parses a document of at most 32 MiB. Entities of its own are not expanded, external ones not read. kParse,
/// "FILE:LINE: ...", for text that is not XML, more nodes or deeper nesting.
[[nodiscard]] Result<XmlTree> parse_xml(std::string_view text, const std::string& file);

/// The finite number that text between blanks is; nothing else.
[[nodiscard]] std::optional<double> number_in(std::string_view text) noexcept;

}  // namespace chicane::survey
