// SPDX-License-Identifier: MIT
// Parser of YAML over yaml-cpp, which no other file includes: checks the bytes, and builds the tree from
// events.
#include "chicane/protocol/yaml_tree.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <map>
#include <sstream>

#include "chicane/base/text.hpp"

namespace chicane::protocol {
namespace {

using Kind = YamlNode::Kind;

constexpr std::size_t kMostBytes = 256U << 10U;  // [byte] of a file; chosen: far more than all settings take

/// Checks on the bytes before a YAML parser gets them.
Result<void> check_bytes(std::string_view text, const std::string& file) {
  if (text.size() > kMostBytes) {
    return fail(ErrorCode::kParse,
                fmt::format("{}: file: got {} bytes, expected at most {}", file, text.size(), kMostBytes));
  }
  int line = 1;
  bool in_indentation = true;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text.substr(i));
    const auto fault = [&](std::string_view got, std::string_view expected) {
      return fail(ErrorCode::kParse,
                  fmt::format("{}:{}: text: got {}, expected {}", file, line, got, expected));
    };
    if (length == 0) return fault(fmt::format("byte 0x{:02x}", static_cast<unsigned char>(text[i])), "UTF-8");
    const char c = text[i];
    if (c == '\t' && in_indentation) return fault("a tab in the indentation", "spaces");
    if (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\r' && c != '\t') {
      return fault(fmt::format("control character 0x{:02x}", static_cast<unsigned char>(c)), "text");
    }
    if (c == '\n') ++line;
    in_indentation = c == '\n' || (in_indentation && c == ' ');
    i += length;
  }
  return {};
}

/// Exception that ends the parser from within an event; parse_yaml() catches it.
struct Refusal {
  int line;
  std::string what;
};

/// Builder of the tree from the events of yaml-cpp.
class TreeBuilder final : public YAML::EventHandler {
 public:
  explicit TreeBuilder(std::string_view text) : text_{text} {}

  [[nodiscard]] YamlTree tree() && {
    if (tree_.root == nullptr) tree_.root = &tree_.nodes.emplace_back();
    return std::move(tree_);
  }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++documents_ == 1) return;
    // yaml-cpp 0.7 does not advance over a comma between documents, and would find empty documents without
    // end.
    const auto at = static_cast<std::size_t>(mark.pos);
    if (at < text_.size() && text_[at] == ',')
      throw Refusal{mark.line + 1, "text: got a comma outside of a list, expected valid YAML"};
    throw Refusal{mark.line + 1, "file: got 2 documents, expected one"};
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    note(anchor, add(mark, Kind::kNothing, "", ""));
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    note(anchor, add(mark, Kind::kScalar, tag, value));
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto known = anchors_.find(anchor);
    if (known == anchors_.end())
      throw Refusal{mark.line + 1, "text: got an alias of what it is part of, expected another"};
    count(mark);
    attach(known->second);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value /*style*/) override {
    open(mark, Kind::kList, tag, anchor);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value /*style*/) override {
    open(mark, Kind::kMap, tag, anchor);
  }
  void OnMapEnd() override { close(); }

 private:
  /// List or map that has not ended.
  struct Open {
    YamlNode* node;
    YAML::anchor_t anchor;
  };

  void count(const YAML::Mark& mark) {
    if (++count_ > YamlTree::kMostNodes)
      throw Refusal{mark.line + 1,
                    fmt::format("file: got more than {} values, expected fewer", YamlTree::kMostNodes)};
  }
  YamlNode* add(const YAML::Mark& mark, Kind kind, const std::string& tag, const std::string& text) {
    count(mark);
    YamlNode* node = &tree_.nodes.emplace_back(
        YamlNode{.kind = kind, .line = mark.line + 1, .text = text, .tag = tag, .children = {}});
    attach(node);
    return node;
  }
  void attach(const YamlNode* node) {
    if (open_.empty()) {
      tree_.root = node;
    } else {
      open_.back().node->children.push_back(node);
    }
  }
  void open(const YAML::Mark& mark, Kind kind, const std::string& tag, YAML::anchor_t anchor) {
    if (open_.size() == YamlTree::kMostDepth) {
      throw Refusal{mark.line + 1, fmt::format("text: got very deep nesting, expected at most {} levels",
                                               YamlTree::kMostDepth)};
    }
    open_.push_back({add(mark, kind, tag, ""), anchor});
  }
  void close() {
    note(open_.back().anchor, open_.back().node);
    open_.pop_back();
  }
  /// Stores the anchor of a node that has ended: an alias within its own node would make a circle.
  void note(YAML::anchor_t anchor, const YamlNode* node) {
    if (anchor != 0) anchors_[anchor] = node;
  }

  std::string_view text_;
  YamlTree tree_;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, const YamlNode*> anchors_;
  std::size_t count_ = 0;
  int documents_ = 0;
};

}  // namespace

Result<YamlTree> parse_yaml(std::string_view text, const std::string& file) {
  if (const Result<void> checked = check_bytes(text, file); !checked) return fail(checked.error());
  const auto refuse = [&](int line, std::string_view what) {
    return fail(ErrorCode::kParse, fmt::format("{}:{}: {}", file, line, what));
  };
  try {
    // The added line is a comment: yaml-cpp 0.7 takes an open quote for closed at a line break that ends the
    // file.
    std::istringstream stream(std::string(text) + "\n#");
    YAML::Parser parser(stream);
    TreeBuilder builder(text);
    while (parser.HandleNextDocument(builder)) {
    }
    return std::move(builder).tree();
  } catch (const Refusal& e) {
    return refuse(e.line, e.what);
  } catch (const YAML::Exception& e) {
    return refuse(e.mark.line + 1, fmt::format("text: got {}, expected valid YAML", e.msg));
  }
}

}  // namespace chicane::protocol
