// SPDX-License-Identifier: MIT
// Meanings are read alone, in help, dashboard and docs: each starts with a noun or a verb.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>

#include "chicane/protocol/schema.hpp"
#include "command_text.hpp"
#include "plan_wait.hpp"

namespace chicane::apps {
namespace {

constexpr std::string_view kFunctionWords[] = {
    "a",     "also", "an",   "and",  "another", "any",     "as",    "at",    "between", "by",
    "for",   "from", "how",  "in",   "instead", "it",      "its",   "never", "no",      "of",
    "on",    "one",  "only", "or",   "over",    "so",      "that",  "the",   "these",   "this",
    "those", "to",   "what", "when", "where",   "whether", "which", "who",   "with",    "without"};

std::string first_word(std::string_view meaning) {
  std::string word;
  for (const char each : meaning) {
    if (std::isalpha(static_cast<unsigned char>(each)) == 0) break;
    word += static_cast<char>(std::tolower(static_cast<unsigned char>(each)));
  }
  return word;
}

bool is_function_word(const std::string& word) {
  return std::find(std::begin(kFunctionWords), std::end(kFunctionWords), word) != std::end(kFunctionWords);
}

TEST(OptionText, MeaningsOfOptionsStartWithANounOrAVerb) {
  int count = 0;
  for (const CommandText& command : command_texts()) {
    EXPECT_FALSE(is_function_word(first_word(command.summary))) << command.name << ": " << command.summary;
    for (const OptionText& option : command.options) {
      ++count;
      EXPECT_FALSE(is_function_word(first_word(option.help)))
          << command.name << (option.names.empty() ? "" : " " + option.names.back()) << ": " << option.help;
    }
  }
  EXPECT_GT(count, 100);
}

TEST(OptionText, MeaningsOfSettingsStartWithANounOrAVerb) {
  for (const protocol::Parameter& parameter : protocol::list())
    EXPECT_FALSE(is_function_word(first_word(parameter.option.meaning)))
        << parameter.key << ": " << parameter.option.meaning;
}

TEST(PlanLine, SaysHowFarItIsAndWhatIsLeft) {
  const lap_time::PlanProgress half{.work = 5.0, .expected = 10.0};
  EXPECT_EQ(plan_line(half, 8.0, 90.0), "planning the lap: 50 %, about 8 s left");
  const lap_time::PlanProgress late{.work = 60.0, .expected = 10.0};
  EXPECT_EQ(plan_line(late, 120.0, 90.0), "planning the lap: 120 s so far, at most 60 s left");
}

}  // namespace
}  // namespace chicane::apps
