// SPDX-License-Identifier: MIT
#include "chicane/base/text.hpp"

#include <bit>
#include <charconv>

#include "chicane/base/random.hpp"
#include "support/chicane_test.hpp"

namespace chicane {
namespace {

TEST(Text, WritesNumbersAsPeopleDo) {
  EXPECT_EQ(number_text(0.0), "0");
  EXPECT_EQ(number_text(-0.0), "-0");
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(1e6), "1000000");
  EXPECT_EQ(number_text(1e15), "1000000000000000");
  EXPECT_EQ(number_text(1e16), "1e+16");
  EXPECT_EQ(number_text(1e-4), "0.0001");
  EXPECT_EQ(number_text(1e-5), "1e-05");
  EXPECT_EQ(number_text(-std::numeric_limits<double>::infinity()), "-inf");
  EXPECT_EQ(number_text(std::numeric_limits<double>::quiet_NaN()), "nan");
}

TEST(Text, EveryNumberReadsBackBitForBit) {
  Random random(3);
  for (int i = 0; i < 10000; ++i) {
    const auto value = std::bit_cast<double>(random.bits());
    if (value != value) continue;
    const std::string text = number_text(value);
    double read = 0.0;
    std::from_chars(text.data(), text.data() + text.size(), read);
    ASSERT_EQ(std::bit_cast<std::uint64_t>(read), std::bit_cast<std::uint64_t>(value)) << text;
  }
}

TEST(Text, RoundsToDigits) {
  EXPECT_EQ(number_text(70.00000000000001, 6), "70");
  EXPECT_EQ(number_text(200.0 / 3.0, 3), "66.7");
  EXPECT_EQ(number_text(0.05, 6), "0.05");
}

TEST(Text, QuotesNoMoreThanFits) {
  EXPECT_EQ(printable(""), "nothing");
  EXPECT_EQ(printable("a\nb\x1b"), "a?b?");
  EXPECT_EQ(printable(std::string(100, 'x')), std::string(60, 'x') + "…");
}

TEST(Text, JoinsWordsWithCommas) {
  EXPECT_EQ(joined({}), "");
  EXPECT_EQ(joined(std::array<std::string_view, 1>{"a"}), "a");
  EXPECT_EQ(joined(std::array<std::string_view, 2>{"a", "b"}), "a, b");
}

TEST(Text, NumbersAreWholeTextsAndFinite) {
  EXPECT_EQ(number_in("-1.5e1"), -15.0);
  for (const char* bad : {"", " 1", "1 ", "+1", "1,5", "0x1", "nan", "inf", "1e999"})
    EXPECT_FALSE(number_in(bad)) << bad;
  EXPECT_EQ(count_in("17"), 17U);
  for (const char* bad : {"", "-1", "+1", "1.0", "99999999999999999999"}) EXPECT_FALSE(count_in(bad)) << bad;
}

TEST(Text, ANumberOutOfItsRangeIsRefusedInOneForm) {
  EXPECT_EQ(number_in("k", "2.5", 0.0, 3.0), 2.5);
  EXPECT_EQ(number_in("k", "3.000001", 0.0, 3.0), 3.0) << "rounding of single precision";
  EXPECT_FALSE(number_in("k", "-1", 0.0, 1e6)) << "rounding of its own border, not of the other";
  for (const char* bad : {"3.1", "three", "nan"}) {
    EXPECT_EQ(number_in("k", bad, 0.0, 3.0).error().message,
              std::string("k: got ") + bad + ", expected a number in [0, 3]");
  }
  EXPECT_EQ(refusal("k", "", "a word").message, "k: got nothing, expected a word");
}

using std::string_view_literals::operator""sv;

TEST(Utf8, TakesSequencesOfEveryLength) {
  for (const std::string_view text :
       {"a"sv, "\0"sv, "\xc3\xa4"sv, "\xe2\x82\xac"sv, "\xf0\x9f\x8f\x81"sv, "\xf4\x8f\xbf\xbf"sv})
    EXPECT_EQ(utf8_length(std::string(text) + "a\xc3\xa4"), text.size()) << text;
}

TEST(Utf8, RefusesTornOverlongAndSurrogateSequences) {
  for (const std::string_view text :
       {"\x80"sv, "\xff"sv, "\xc3"sv, "\xc0\x80"sv, "\xc1\xbf"sv, "\xe0\x9f\xbf"sv, "\xed\xa0\x80"sv,
        "\xe2\x82"sv, "\xf0\x8f\xbf\xbf"sv, "\xf4\x90\x80\x80"sv, "\xf5\x80\x80\x80"sv, "\xf0\x9f\x8f"sv})
    EXPECT_EQ(utf8_length(text), 0U);
}

}  // namespace
}  // namespace chicane
