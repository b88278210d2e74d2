// SPDX-License-Identifier: MIT
// Reader of a subset of YAML without a library, for the page in the browser.
#include "chicane/protocol/yaml_tree.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace chicane::protocol {
namespace {

using NodeKind = YamlNode::Kind;

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \r");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \r") - begin + 1);
}

/// Line without its comment, which begins the line or follows a space.
std::string_view without_comment(std::string_view line) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '#' && (i == 0 || line[i - 1] == ' ')) return line.substr(0, i);
  }
  return line;
}

/// Whether a scalar has a meaning that only a whole YAML parser knows: quotes, lists, tags and others.
bool is_special(std::string_view scalar) {
  constexpr std::string_view kIndicators = "\"'[]{}&*!|>%@`,?-";
  return !scalar.empty() && kIndicators.find(scalar.front()) != std::string_view::npos &&
         !(scalar.front() == '-' && scalar.size() > 1 && scalar[1] != ' ' && scalar[1] != '-');
}

/// Reader of plain YAML, line by line.
class PlainReader {
 public:
  explicit PlainReader(const std::string& file) : file_{file} {}

  Result<void> read(std::string_view line) {
    ++line_;
    const std::string_view content = trimmed(without_comment(line));
    if (line.find('\t') != std::string_view::npos) return refuse("a tab");
    if (content.empty()) return {};
    const std::size_t colon = std::min(content.find(": "), content.size());
    const bool opens = colon == content.size() && content.back() == ':';
    if (colon == content.size() && !opens) return refuse("a line without a key");
    const std::string_view key = opens ? content.substr(0, content.size() - 1) : content.substr(0, colon);
    const std::string_view value = opens ? std::string_view{} : trimmed(content.substr(colon + 1));
    if (is_special(key) || is_special(value) || value.find(": ") != std::string_view::npos)
      return refuse(fmt::format("{}", content));
    return place(line.find_first_not_of(' '), key, value);
  }

  [[nodiscard]] YamlTree tree() && {
    if (tree_.root == nullptr) tree_.root = &tree_.nodes.emplace_back();
    return std::move(tree_);
  }

 private:
  /// Map that has not ended.
  struct Open {
    std::size_t indent;
    YamlNode* map;
  };

  tl::unexpected<Error> refuse(std::string_view got) const {
    return fail(ErrorCode::kParse,
                fmt::format("{}:{}: text: got {}, expected `key: value`", file_, line_, got));
  }
  YamlNode* add(NodeKind kind, std::string_view text) {
    return &tree_.nodes.emplace_back(YamlNode{.kind = kind,
                                              .line = line_,
                                              .text = std::string(text),
                                              .tag = kind == NodeKind::kScalar ? "?" : "",
                                              .children = {}});
  }

  /// Adds a key and its value to the open map of this indentation; begins a map below the last key for a
  /// deeper one.
  Result<void> place(std::size_t indent, std::string_view key, std::string_view value) {
    while (!open_.empty() && open_.back().indent > indent) open_.pop_back();
    if (open_.empty() || open_.back().indent < indent) {
      const bool is_first = tree_.root == nullptr;
      if (open_.empty() != is_first || (!is_first && waiting_ == nullptr))
        return refuse("another indentation");
      if (open_.size() == YamlTree::kMostDepth) return refuse("very deep nesting");
      YamlNode* map = is_first ? add(NodeKind::kMap, "") : waiting_;
      map->kind = NodeKind::kMap;
      map->line = line_;
      if (is_first) tree_.root = map;
      open_.push_back({indent, map});
    }
    YamlNode* name = add(NodeKind::kScalar, key);
    YamlNode* content = add(value.empty() ? NodeKind::kNothing : NodeKind::kScalar, value);
    open_.back().map->children.push_back(name);
    open_.back().map->children.push_back(content);
    waiting_ = value.empty() ? content : nullptr;
    return {};
  }

  const std::string& file_;
  int line_ = 0;
  YamlTree tree_;
  std::vector<Open> open_;       ///< the outermost first
  YamlNode* waiting_ = nullptr;  ///< value of the last key, if its line has none
};

}  // namespace

Result<YamlTree> parse_plain_yaml(std::string_view text, const std::string& file) {
  PlainReader reader(file);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (const Result<void> read = reader.read(text.substr(0, end)); !read) return fail(read.error());
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return std::move(reader).tree();
}

}  // namespace chicane::protocol
