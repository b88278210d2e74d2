// SPDX-License-Identifier: MIT
#include "chicane/survey/xml_tree.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace chicane::survey {
namespace {

using ::testing::HasSubstr;

TEST(XmlTree, HasElementsTextAndNumbersWithTheirLines) {
  const auto tree = parse_xml(
      "<?xml version='1.0'?>\n<a:road id='7' length=' 12.5 '>\n <x>3</x>\n <x>4</x>\n</a:road>", "f.xml");
  ASSERT_TRUE(tree) << tree.error().message;
  const XmlNode& road = tree->root();
  EXPECT_EQ(road.name, "road") << "without the prefix of its namespace";
  EXPECT_EQ(road.line, 2);
  EXPECT_EQ(road.attribute("id"), "7");
  EXPECT_EQ(road.number("length"), 12.5);
  EXPECT_EQ(road.number("width"), std::nullopt);
  ASSERT_EQ(road.children.size(), 2U);
  EXPECT_EQ(road.children[1]->text, "4");
  EXPECT_EQ(road.children[1]->line, 4);
  EXPECT_EQ(road.child("y"), nullptr);
}

TEST(XmlTree, SaysWhereTextIsNoXml) {
  EXPECT_THAT(parse_xml("<a>\n<b></a>", "f.xml").error().message,
              HasSubstr("f.xml:2: got XML that cannot be read: mismatched tag"));
  EXPECT_FALSE(parse_xml("", "f.xml"));
}

TEST(XmlTree, EndsAtItsLimits) {
  const auto entity = parse_xml("<!DOCTYPE a [<!ENTITY b 'bbbb'>]>\n<a>&b;</a>", "f.xml");
  ASSERT_FALSE(entity);
  EXPECT_THAT(entity.error().message, HasSubstr("f.xml:1: got XML that cannot be read: entities of its own"));
  std::string deep;
  for (int i = 0; i < 1000; ++i) deep += "<a>";
  EXPECT_THAT(parse_xml(deep, "f.xml").error().message, HasSubstr("nested more than 64 deep"));
  std::string many = "<a>";
  for (int i = 0; i < 1'000'001; ++i) many += "<b/>";
  EXPECT_THAT(parse_xml(many + "</a>", "f.xml").error().message, HasSubstr("more than 1000000 elements"));
}

}  // namespace
}  // namespace chicane::survey
