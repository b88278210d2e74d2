// SPDX-License-Identifier: MIT
#include "chicane/base/text.hpp"

#include <gtest/gtest.h>

#include <string_view>

namespace chicane {
namespace {

using std::string_view_literals::operator""sv;

TEST(Utf8, TakesTextOfEveryLength) {
  for (const std::string_view text : {""sv, "a"sv, "\0"sv, "\xc3\xa4"sv, "\xe2\x82\xac"sv,
                                      "\xf0\x9f\x8f\x81"sv, "\xf4\x8f\xbf\xbf"sv, "a\xe2\x82\xac\xc3\xa4"sv})
    EXPECT_TRUE(is_utf8(text)) << text;
}

TEST(Utf8, RefusesTornOverlongAndSurrogateSequences) {
  for (const std::string_view text :
       {"\x80"sv, "\xff"sv, "a\xc3"sv, "\xc0\x80"sv, "\xc1\xbf"sv, "\xe0\x9f\xbf"sv, "\xed\xa0\x80"sv,
        "\xe2\x82"sv, "\xf0\x8f\xbf\xbf"sv, "\xf4\x90\x80\x80"sv, "\xf5\x80\x80\x80"sv, "\xf0\x9f\x8f"sv})
    EXPECT_FALSE(is_utf8(text));
}

}  // namespace
}  // namespace chicane
