// SPDX-License-Identifier: MIT
#include "chicane/protocol/json.hpp"
#include "support/chicane_test.hpp"

namespace chicane::protocol {
namespace {

TEST(Json, KeepsTheOrderOfItsKeys) {
  const Json json{{"zeta", 1}, {"alpha", {1.5, "two", nullptr, true}}};
  EXPECT_EQ(json_text(json), R"({"zeta":1,"alpha":[1.5,"two",null,true]})");
  EXPECT_EQ(json_text(parse_json(json_text(json))), json_text(json));
}

TEST(Json, IsIndentedByTwoSpaces) {
  EXPECT_EQ(json_text({{"a", {{"b", 1}}}}, JsonLayout::kIndented), "{\n  \"a\": {\n    \"b\": 1\n  }\n}");
}

TEST(Json, WritesAnyBytesAndAnyNumbers) {
  EXPECT_EQ(json_text(Json("\xff|")), "\"\xEF\xBF\xBD|\"");
  EXPECT_EQ(json_text(Json("\xC3\xA9"), JsonLayout::kAscii), "\"\\u00e9\"");
  EXPECT_EQ(json_text(Json(std::numeric_limits<double>::infinity())), "null");
}

TEST(Json, SaysOfAnyTextWhetherItIsJson) {
  for (const char* text : {"", "{", "[1,]", "1 2", "nan", "{\"a\":1}}", "\"\xff\""})
    EXPECT_TRUE(parse_json(text).is_discarded()) << text;
  for (const char* text : {"null", "-1e3", "{}", " [1, {\"a\": []}] ", "\"\\u00e9\""})
    EXPECT_FALSE(parse_json(text).is_discarded()) << text;
  EXPECT_EQ(read_json("[1,]").error().byte, 4U);
  EXPECT_EQ(read_json("[1,2").error().byte, 5U);
  EXPECT_FALSE(read_json("[1e999]").error().byte);
  EXPECT_EQ(read_json("[1,2]").value()[1], 2);
  const std::string deep(100'000, '[');
  EXPECT_TRUE(parse_json(deep).is_discarded());
  EXPECT_FALSE(parse_json(deep + std::string(100'000, ']')).is_discarded());
}

}  // namespace
}  // namespace chicane::protocol
