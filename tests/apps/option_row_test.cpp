// SPDX-License-Identifier: MIT
#include "option_row.hpp"

#include "commands.hpp"
#include "support/chicane_test.hpp"

namespace chicane::apps {
namespace {

TEST(OptionRow, HelpFitsEightyColumns) {
  const auto is_narrow = [](const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      const auto columns = std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xc0) != 0x80; });
      const bool is_one_word = line.find(' ', line.find_first_not_of(' ')) == std::string::npos;
      EXPECT_TRUE(columns <= 80 || is_one_word || line.starts_with("Example: ")) << line;
    }
  };
  is_narrow(program_help());
  Options scratch;
  for (const Command& command : commands())
    is_narrow(command_help(command.name, command.summary, options_of(command, scratch), command.example));
}

TEST(OptionRow, TakesWhatItsRuleAllowsAndSaysWhatItExpects) {
  double pace = 0.0;
  int lap = 0;
  std::vector<int> horizons{1};
  std::string word;
  std::vector<std::pair<std::string, std::string>> settings;
  const auto fault = [&](const OptionRow& row, std::vector<std::string> given) {
    return assign(row, given, settings);
  };
  const OptionRow number{"--pace", "X", "Pace", &pace, between(0.05, 20.0)};
  EXPECT_EQ(fault(number, {"2.5"}), "");
  EXPECT_EQ(pace, 2.5);
  EXPECT_EQ(fault(number, {"21"}), "got 21, expected a number in [0.05, 20]");
  EXPECT_EQ(fault(number, {"nan"}), "got nan, expected a number in [0.05, 20]");
  EXPECT_EQ(fault(number, {""}), "got nothing, expected a number in [0.05, 20]");
  EXPECT_EQ(fault(number, {"1", "2"}), "got it 2 times (1, 2), expected once");
  EXPECT_EQ(fault({"--lap", "N", "Lap", &lap, kPositive}, {"0"}), "got 0, expected a whole number > 0");
  EXPECT_EQ(fault({"--lap", "N", "Lap", &lap}, {"99999999999"}), "got 99999999999, expected a whole number");
  EXPECT_EQ(fault({"--horizons", "N,...", "Horizons", &horizons}, {"10,20"}), "");
  EXPECT_EQ(horizons, (std::vector<int>{10, 20}));
  const OptionRow kind{"--kind", "KIND", "Kind", &word, one_of({"a", "b"}) | kShown};
  EXPECT_EQ(fault(kind, {"c"}), "got c, expected one of a, b");
  EXPECT_EQ(fault(kind, {"b"}), "");
  EXPECT_EQ(notes(kind), " (one of a, b; default b)");
  EXPECT_EQ(fault({"--laps", "N", "Laps", Setting{"laps"}}, {"3"}), "");
  EXPECT_EQ(settings.back(), (std::pair<std::string, std::string>{"laps", "3"}));
}

}  // namespace
}  // namespace chicane::apps
