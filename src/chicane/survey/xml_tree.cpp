// SPDX-License-Identifier: MIT
#include "chicane/survey/xml_tree.hpp"

#include <expat.h>
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <type_traits>

#include "chicane/base/text.hpp"

namespace chicane::survey {
namespace {

std::string without_prefix(std::string_view name) {
  const std::size_t colon = name.rfind(':');
  return std::string(colon == std::string_view::npos ? name : name.substr(colon + 1));
}

/// Builds the tree from expat's events.
class Builder {
 public:
  Builder() : parser_{XML_ParserCreate(nullptr), &XML_ParserFree} {
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(parser_.get(), &begin, &end);
    XML_SetCharacterDataHandler(parser_.get(), &add_text);
    XML_SetEntityDeclHandler(parser_.get(), &refuse_entity);
  }

  Result<XmlTree> build(std::string_view text, const std::string& file) {
    const XML_Status status = XML_Parse(parser_.get(), text.data(), static_cast<int>(text.size()), XML_TRUE);
    if (status != XML_STATUS_OK) {
      const char* const reason =
          reason_ != nullptr ? reason_ : XML_ErrorString(XML_GetErrorCode(parser_.get()));
      return fail(ErrorCode::kParse,
                  fmt::format("{}:{}: got XML that cannot be read: {}", file, line(), reason));
    }
    return std::move(tree_);
  }

 private:
  [[nodiscard]] int line() const { return static_cast<int>(XML_GetCurrentLineNumber(parser_.get())); }
  void stop(const char* reason) {
    reason_ = reason;
    XML_StopParser(parser_.get(), XML_FALSE);
  }

  static void begin(void* self, const XML_Char* name, const XML_Char** attributes) {
    static_cast<Builder*>(self)->begin_node(name, attributes);
  }
  static void end(void* self, const XML_Char* /*name*/) { static_cast<Builder*>(self)->open_.pop_back(); }
  static void add_text(void* self, const XML_Char* text, int size) {
    auto& open = static_cast<Builder*>(self)->open_;
    if (!open.empty()) open.back()->text.append(text, static_cast<std::size_t>(size));
  }
  static void refuse_entity(void* self, const XML_Char*, int, const XML_Char*, int, const XML_Char*,
                            const XML_Char*, const XML_Char*, const XML_Char*) {
    static_cast<Builder*>(self)->stop("entities of its own, which are not read");
  }

  void begin_node(const XML_Char* name, const XML_Char** attributes) {
    if (tree_.nodes.size() == XmlTree::kMostNodes) return stop("more than 1000000 elements");
    if (open_.size() == XmlTree::kMostDepth) return stop("elements nested more than 64 deep");
    XmlNode& node = tree_.nodes.emplace_back();
    node.name = without_prefix(name);
    node.line = line();
    for (; *attributes != nullptr; attributes += 2)
      node.attributes.emplace_back(without_prefix(attributes[0]), attributes[1]);
    if (!open_.empty()) open_.back()->children.push_back(&node);
    open_.push_back(&node);
  }

  std::unique_ptr<std::remove_pointer_t<XML_Parser>, decltype(&XML_ParserFree)> parser_;
  XmlTree tree_;
  std::vector<XmlNode*> open_;
  const char* reason_ = nullptr;
};

}  // namespace

const XmlNode* XmlNode::child(std::string_view child_name) const noexcept {
  const auto found = std::find_if(children.begin(), children.end(),
                                  [&](const XmlNode* each) { return each->name == child_name; });
  return found == children.end() ? nullptr : *found;
}

std::string_view XmlNode::attribute(std::string_view attribute_name) const noexcept {
  for (const auto& [key, value] : attributes)
    if (key == attribute_name) return value;
  return {};
}

std::optional<double> XmlNode::number(std::string_view attribute_name) const noexcept {
  return number_in(attribute(attribute_name));
}

std::optional<double> number_in(std::string_view text) noexcept {
  constexpr std::string_view kBlank = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(kBlank);
  if (begin == std::string_view::npos) return std::nullopt;
  text = text.substr(begin, text.find_last_not_of(kBlank) - begin + 1);
  if (text.starts_with('+')) text.remove_prefix(1);
  return chicane::number_in(text);
}

Result<XmlTree> parse_xml(std::string_view text, const std::string& file) {
  if (text.size() > XmlTree::kMostBytes)
    return fail(ErrorCode::kParse,
                fmt::format("{}: file: got {} bytes of XML, expected at most 32 MiB", file, text.size()));
  return Builder().build(text, file);
}

}  // namespace chicane::survey
