// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/result.hpp"

namespace chicane::protocol {

/// An XML document whose elements have no namespace prefix. This header is for our own sources and not
/// installed.
struct XmlDocument {
  static constexpr std::size_t kMostBytes = std::size_t{32} << 20U;
  static constexpr std::ptrdiff_t kMostTags = 2'000'000;
  static constexpr int kMostDepth = 64;

  std::string file;
  pugi::xml_document tree = {};
  std::vector<std::ptrdiff_t> line_ends = {};

  [[nodiscard]] pugi::xml_node root() const { return tree.document_element(); }
  /// Where a node begins, from 1.
  [[nodiscard]] int line_of(pugi::xml_node node) const;
  /// All elements of a name, in the order of the document.
  [[nodiscard]] std::vector<pugi::xml_node> find_all(std::string_view name) const;
};

/// Parses a document of at most 32 MiB and 2,000,000 tags. Entities of its own are refused. kParse,
/// "FILE:LINE: …", for text that is not XML, more tags or deeper nesting.
[[nodiscard]] Result<XmlDocument> parse_xml(std::string_view text, const std::string& file);

/// The finite number of an attribute; `otherwise` where there is none.
[[nodiscard]] double number_at(pugi::xml_node node, const char* attribute, double otherwise = 0.0);

}  // namespace chicane::protocol
