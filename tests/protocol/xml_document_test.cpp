// SPDX-License-Identifier: MIT
#include "chicane/protocol/detail/foreign_roads.hpp"
#include "support/chicane_test.hpp"

namespace chicane::protocol {
namespace {

TEST(XmlDocument, HasElementsAndNumbersWithTheirLines) {
  const auto xml = test::good(parse_xml(
      "<?xml version='1.0'?>\n<a:road id='7' length=' 12.5 '>\n <x>3</x>\n <x>4</x>\n</a:road>", "f.xml"));
  const pugi::xml_node road = xml->root();
  EXPECT_STREQ(road.name(), "road") << "without the prefix of its namespace";
  EXPECT_EQ(xml->line_of(road), 2);
  EXPECT_EQ(number_at(road, "length"), 12.5);
  EXPECT_EQ(number_at(road, "width", -1.0), -1.0);
  const std::vector<pugi::xml_node> found = xml->find_all("x");
  ASSERT_EQ(found.size(), 2U);
  EXPECT_STREQ(found[1].child_value(), "4");
  EXPECT_EQ(xml->line_of(found[1]), 4);
}

TEST(XmlDocument, SaysWhereTextIsNoXml) {
  EXPECT_THAT(parse_xml("<a>\n<b></a>", "f.xml").error().message,
              HasSubstr("f.xml:2: file: got XML that cannot be read: Start-end tags mismatch"));
  EXPECT_THAT(parse_xml("<a/>\n<a/>", "f.xml").error().message,
              HasSubstr("f.xml:2: file: got XML that cannot"));
  EXPECT_FALSE(parse_xml("", "f.xml"));
}

TEST(XmlDocument, EndsAtItsLimits) {
  const auto fault = [](const std::string& text) { return parse_xml(text, "f.xml").error().message; };
  EXPECT_THAT(fault("<!DOCTYPE a [<!ENTITY b 'bbbb'>]>\n<a>&b;</a>"),
              HasSubstr("f.xml:1: file: got XML that cannot be read: entities of its own"));
  std::string deep;
  for (int i = 0; i < 65; ++i) deep = "<a>" + deep + "</a>";
  EXPECT_THAT(fault(deep), HasSubstr("nested more than 64 deep"));
  std::string many = "<a>";
  for (int i = 0; i < 2'000'001; ++i) many += "<b/>";
  EXPECT_THAT(fault(many + "</a>"), HasSubstr("more than 2000000 tags"));
}

}  // namespace
}  // namespace chicane::protocol
