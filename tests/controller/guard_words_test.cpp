// SPDX-License-Identifier: MIT
#include "chicane/controller/guard_words.hpp"

#include <regex>

#include "chicane/road/reference_line.hpp"
#include "chicane/solver/solution.hpp"
#include "support/chicane_test.hpp"

namespace chicane::controller {
namespace {

/// Names, and sentences short enough for one line of a terminal.
template <class Enum, std::size_t N>
void expect_readable(const std::array<Word<Enum>, N>& words) {
  std::set<std::string_view> names, sentences;
  for (const Word<Enum>& row : words) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_TRUE(sentences.insert(row.sentence).second) << row.name;
    EXPECT_TRUE(std::regex_match(std::string{row.name}, std::regex("[a-z]+(_[a-z]+)*"))) << row.name;
    EXPECT_TRUE(std::regex_match(std::string{row.sentence}, std::regex("[a-z][A-Za-z,' ]*[a-z]")))
        << row.sentence;
    const auto spaces = std::count(row.sentence.begin(), row.sentence.end(), ' ');
    EXPECT_LE(spaces + 1, 14) << row.sentence;
    EXPECT_GE(spaces + 1, 3) << row.sentence;
  }
}

TEST(GuardWords, AreReadableAndTellEveryValueApart) {
  expect_readable(kRungWords);
  expect_readable(kGuardReasonWords);
  expect_readable(solver::kSolveStatusWords);
  expect_readable(road::kSpeedLimiterWords);
}

TEST(GuardWords, NumbersAndNamesThatRecordingsKeep) {
  EXPECT_EQ(static_cast<int>(Rung::kGuardStop), 6);
  EXPECT_EQ(static_cast<int>(GuardReason::kTooFastForSilence), 9);
  EXPECT_EQ(word_of(GuardReason::kNoAnswer).name, "no_answer");
  EXPECT_EQ(word_of(GuardReason::kTooFastForSilence).name, "too_fast_for_silence");
}

}  // namespace
}  // namespace chicane::controller
