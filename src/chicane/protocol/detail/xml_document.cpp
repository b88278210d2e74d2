// SPDX-License-Identifier: MIT
#include "chicane/protocol/detail/xml_document.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "chicane/protocol/csv_text.hpp"
#include "chicane/protocol/detail/road_rows.hpp"

namespace chicane::protocol {
namespace {

/// Visits the elements in the order of the document.
template <typename Visit>
struct Walker : pugi::xml_tree_walker {
  explicit Walker(Visit each) : visit{each} {}
  bool for_each(pugi::xml_node& node) override {
    return node.type() != pugi::node_element || visit(node, depth());
  }
  Visit visit;
};

int line_at(const XmlDocument& xml, std::ptrdiff_t offset) {
  const auto end = std::lower_bound(xml.line_ends.begin(), xml.line_ends.end(), offset);
  return static_cast<int>(end - xml.line_ends.begin()) + 1;
}

}  // namespace

int XmlDocument::line_of(pugi::xml_node node) const { return line_at(*this, node.offset_debug()); }

std::vector<pugi::xml_node> XmlDocument::find_all(std::string_view name) const {
  std::vector<pugi::xml_node> found;
  Walker walker([&](pugi::xml_node node, int) {
    if (node.name() == name) found.push_back(node);
    return true;
  });
  pugi::xml_node(tree).traverse(walker);
  return found;
}

Result<XmlDocument> parse_xml(std::string_view text, const std::string& file) {
  XmlDocument xml{.file = file};
  const auto refuse = [&](std::ptrdiff_t at, std::string_view why) {
    return fail(fault_of(file, line_at(xml, at), "file", fmt::format("XML that cannot be read: {}", why),
                         "a document of one course"));
  };
  if (text.size() > XmlDocument::kMostBytes) return refuse(0, "more than 32 MiB");
  if (std::count(text.begin(), text.end(), '<') > XmlDocument::kMostTags)
    return refuse(0, "more than 2000000 tags");
  for (std::size_t i = text.find('\n'); i != std::string_view::npos; i = text.find('\n', i + 1))
    xml.line_ends.push_back(static_cast<std::ptrdiff_t>(i));
  if (const std::size_t at = text.find("<!ENTITY"); at != std::string_view::npos)
    return refuse(static_cast<std::ptrdiff_t>(at), "entities of its own, which are not read");
  const pugi::xml_parse_result parsed = xml.tree.load_buffer(text.data(), text.size());
  if (!parsed) return refuse(parsed.offset, parsed.description());
  if (const pugi::xml_node next = xml.root().next_sibling())
    return refuse(next.offset_debug(), "a second root element");
  Walker walker([](pugi::xml_node node, int depth) {
    const std::string name = node.name();
    if (const std::size_t colon = name.rfind(':'); colon != std::string::npos)
      node.set_name(name.substr(colon + 1).c_str());
    return depth < XmlDocument::kMostDepth;
  });
  if (!xml.tree.traverse(walker)) return refuse(0, "elements nested more than 64 deep");
  return xml;
}

double number_at(pugi::xml_node node, const char* attribute, double otherwise) {
  return number(trim(node.attribute(attribute).value())).value_or(otherwise);
}

}  // namespace chicane::protocol
