// SPDX-License-Identifier: MIT
#include "chicane/protocol/yaml_tree.hpp"

#include "chicane/protocol/library.hpp"
#include "support/chicane_test.hpp"

namespace chicane::protocol {
namespace {

/// Everything that readers of a tree look at.
std::string written(const YamlNode& node) {
  std::string text = std::to_string(static_cast<int>(node.kind)) + " " + node.text;
  if (node.kind != YamlNode::Kind::kNothing) text += "@" + std::to_string(node.line);
  if (node.is_scalar()) text += node.tag;
  for (const YamlNode* child : node.children) text += "(" + written(*child) + ")";
  return text;
}

/// kinds, lines and texts of both parsers
void expect_same(const std::string& text, const std::string& file) {
  const auto plain = parse_plain_yaml(text, file);
  const auto whole = parse_yaml(text, file);
  ASSERT_TRUE(plain) << plain.error().message;
  ASSERT_TRUE(whole) << whole.error().message;
  EXPECT_EQ(written(*plain->root), written(*whole->root)) << file;
}

TEST(PlainYaml, ReadsAllShippedPresetsAndCarsAsTheWholeParserDoes) {
  int read = 0;
  for (const Shelf shelf : {Shelf::kPreset, Shelf::kCar}) {
    for (const Entry& entry : entries(shelf)) {
      const auto text = test::good(read_file(entry.file));
      expect_same(*text, entry.file);
      ++read;
    }
  }
  EXPECT_GE(read, 12);
}

TEST(PlainYaml, ReadsWhatTheirKindMayHave) {
  for (const std::string text :
       {"", "# nothing\n", "a: 1", "a: 1\nb:\n  c: -2.5 # why\n  d: x#y\ne: .inf\r\n",
        "a:\n    b:\n     c: 1\n    d: 2\n", "a:\nb: 1\n", "a: two words\n\n\n# end\nb: http://x\n"}) {
    expect_same(text, "file.yaml");
  }
}

TEST(PlainYaml, RefusesWhatOnlyTheWholeParserUnderstandsWithItsLine) {
  for (const std::string text :
       {"a: 1\nb: [1, 2]", "a: 1\n- b", "a: 1\nb: \"c\"", "a: 1\n\tb: 2", "a: 1\nb", "a: 1\n  b: 2",
        "a: 1\nb: {c: 1}", "a: 1\nb: &x 1", "a: 1\nb: |", "a: 1\n--- ", "a: 1\nb: c: 2"}) {
    EXPECT_THAT(test::refusal_of(parse_plain_yaml(text, "file.yaml")), StartsWith("file.yaml:2: ")) << text;
  }
}

}  // namespace
}  // namespace chicane::protocol
