// SPDX-License-Identifier: MIT
#include "chicane/protocol/csv_text.hpp"

#include <gmock/gmock.h>

namespace chicane::protocol {
namespace {

using ::testing::ElementsAre;

TEST(CsvText, SplitsByTheSeparatorOfTheLine) {
  EXPECT_EQ(separator_of("1,5; 2,5"), ';');
  EXPECT_EQ(separator_of("1.5, 2.5"), ',');
  EXPECT_EQ(separator_of("1.5\t2.5"), '\t');
  EXPECT_EQ(separator_of("1.5 2.5"), ' ');
  EXPECT_THAT(split(R"("x" ; 2 ;)", ';'), ElementsAre("x", "2", ""));
  EXPECT_THAT(split("1   2", ' '), ElementsAre("1", "2"));
}

TEST(CsvText, ReadsFiniteNumbersOnly) {
  EXPECT_EQ(number("+1.5e1"), 15.0);
  for (const char* bad : {"", "1.5x", "nan", "inf", "1e999", "--1"}) EXPECT_FALSE(number(bad)) << bad;
}

TEST(CsvText, ReadsDecimalCommasWhereCommasSeparateNothing) {
  EXPECT_EQ(number("-1,25", ';'), -1.25);
  EXPECT_FALSE(number("1,25", ','));
  EXPECT_FALSE(number("1,250.5", ';')) << "of thousands";
}

TEST(CsvText, GivesLinesOfAnyEndWithTheirNumbers) {
  CsvLines lines("\xef\xbb\xbf a\r\nb\rc\n\nd");
  for (const char* expected : {"a", "b", "c", "", "d"}) EXPECT_EQ(lines.next(), expected);
  EXPECT_EQ(lines.number(), 5);
  EXPECT_FALSE(lines.next());
}

TEST(CsvText, FindsAWordAmongOthers) {
  EXPECT_TRUE(is_among("y_m", " x y_m "));
  EXPECT_FALSE(is_among("y", " x y_m "));
  EXPECT_FALSE(is_among("", " x y_m "));
}

}  // namespace
}  // namespace chicane::protocol
