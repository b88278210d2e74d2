// SPDX-License-Identifier: MIT
// The manual page and the shells' completion name what the program's own help names.

#include <regex>

#include "apps/program_outcome.hpp"
#include "support/chicane_test.hpp"

namespace chicane {
namespace {

using ::testing::IsSupersetOf;
using ::testing::UnorderedElementsAre;

const std::string& kQuotedProgram = test::kProgram;

/// What bash says in the root of the source tree.
std::string bash(const std::string& words) {
  return test::shell("bash 2>&1 <<'END'\n" + words + "\nEND\ntrue").out;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> commands() {
  std::vector<std::string> names;
  bool is_list = false;
  for (const std::string& line : lines_of(bash(kQuotedProgram + " --help"))) {
    if (is_list && line.starts_with("  ") && line[2] != ' ')
      names.push_back(line.substr(2, line.find(' ', 2) - 2));
    is_list = is_list || line == "Drive:";
  }
  return names;
}

/// "--preset", ... of the help of a command.
std::set<std::string> options_of(const std::string& command) {
  std::set<std::string> options;
  const std::regex entry("^  (?:-\\w,)?(--[a-z-]+)");
  for (const std::string& line : lines_of(bash(kQuotedProgram + " " + command + " --help"))) {
    if (std::smatch match; std::regex_search(line, match, entry)) options.insert(match[1]);
  }
  options.erase("--help");
  return options;
}

/// What bash completes the last word to.
std::vector<std::string> completed(const std::vector<std::string>& words) {
  std::string line = "eval \"$(" + kQuotedProgram + " completion bash)\"; COMP_WORDS=(" + kQuotedProgram;
  for (const std::string& word : words) line += " '" + word + "'";
  line += "); COMP_CWORD=" + std::to_string(words.size()) + "; _chicane; printf '%s\\n' \"${COMPREPLY[@]}\"";
  return lines_of(bash(line));
}

std::string without_dashes_of_roff(std::string page) {
  for (std::size_t at = 0; (at = page.find("\\-", at)) != std::string::npos;) page.erase(at, 1);
  return page;
}

TEST(CommandText, EveryCommandHasAnExampleOfItsOwnAndARowInTheDocs) {
  const std::string page = bash("cat docs/reference/cli.md");
  for (const std::string& command : commands()) {
    const std::string help = bash(kQuotedProgram + " " + command + " --help");
    EXPECT_TRUE(std::regex_search(help, std::regex("Example: .*chicane " + command + "\\b"))) << command;
    EXPECT_TRUE(std::regex_search(page, std::regex("\\| `chicane " + command + "[ `]"))) << command;
  }
}

TEST(CommandText, WithoutACommandSixLinesForANewcomer) {
  const std::vector<std::string> lines = lines_of(bash(kQuotedProgram));
  ASSERT_EQ(lines.size(), 6U);
  for (const std::string& line : lines) EXPECT_TRUE(line.starts_with("chicane ")) << line;
}

TEST(CommandText, TheHelpIsRead) {
  EXPECT_THAT(commands(), IsSupersetOf({"drive", "serve", "replay", "list", "completion", "manual"}));
  EXPECT_THAT(options_of("drive"), IsSupersetOf({"--preset", "--laps", "--fast", "--set"}));
  EXPECT_THAT(options_of("report"), ElementsAre("--car", "--compare", "--drive-topic", "--odom-topic",
                                                "--output", "--page", "--track"));
}

TEST(CommandText, TheManualNamesEveryCommandAndOption) {
  const std::string page = without_dashes_of_roff(bash(kQuotedProgram + " manual"));
  for (const std::string& command : commands()) {
    const std::size_t begin = page.find(".SS chicane " + command + "\n");
    ASSERT_NE(begin, std::string::npos) << command;
    const std::string section = page.substr(begin, page.find("\n.S", begin + 1) - begin);
    for (const std::string& option : options_of(command))
      EXPECT_THAT(section, HasSubstr("\\fB" + option + "\\fR")) << command;
  }
}

TEST(CommandText, TheManualIsCorrectRoff) {
  if (!bash("command -v groff").starts_with("/")) GTEST_SKIP() << "groff is not installed";
  EXPECT_EQ(bash(kQuotedProgram + " manual | groff -man -Kutf8 -Tutf8 -ww -z"), "");
}

TEST(CommandText, BashCompletesEveryOption) {
  EXPECT_THAT(completed({""}), IsSupersetOf(commands()));
  for (const std::string& command : commands()) {
    const std::set<std::string> expected = options_of(command);
    const std::vector<std::string> offered = completed({command, "--"});
    EXPECT_THAT(offered, IsSupersetOf(expected)) << command;
    EXPECT_EQ(offered.size(), expected.size() + 1) << command << ": and --help";
  }
}

TEST(CommandText, BashCompletesValues) {
  EXPECT_THAT(completed({"dr"}), ElementsAre("drive"));
  EXPECT_THAT(completed({"drive", "--pre"}), ElementsAre("--preset"));
  EXPECT_THAT(completed({"drive", "--preset", "sixty"}), ElementsAre("sixty-mph"));
  EXPECT_THAT(completed({"drive", "--track", "lakes"}), ElementsAre("lakeside"));
  EXPECT_THAT(completed({"drive", "--set", "latency"}),
              UnorderedElementsAre("latency_ms=", "latency_jitter_ms="));
  EXPECT_THAT(completed({"drive", "first"}), ElementsAre("first-lap"));
  EXPECT_THAT(completed({"list", "para"}), ElementsAre("parameters"));
  EXPECT_THAT(completed({"completion", ""}), ElementsAre("bash", "zsh", "fish"));
  EXPECT_THAT(completed({"check", "READ"}), Contains("README.md"));
}

TEST(CommandText, FishCompletesValues) {
  if (!bash("command -v fish").starts_with("/")) GTEST_SKIP() << "fish is not installed";
  const auto complete = [](const std::string& line) {
    return bash("PATH=$(dirname " + kQuotedProgram + "):$PATH fish -c \"source (" + kQuotedProgram +
                " completion fish | psub); complete -C 'chicane " + line + "' | string split -f1 \\t\"");
  };
  EXPECT_EQ(complete("drive --pres"), "--preset\n");
  EXPECT_EQ(complete("list para"), "parameters\n");
  EXPECT_EQ(complete("check READ"), "README.md\n");
}

TEST(CommandText, OtherShellsAcceptTheirScripts) {
  for (const std::string shell : {"bash", "zsh", "fish"}) {
    if (!bash("command -v " + shell).starts_with("/")) continue;
    EXPECT_EQ(bash(shell + " -n <(" + kQuotedProgram + " completion " + shell + ")"), "") << shell;
  }
  const std::string words = bash(kQuotedProgram + " completion zsh -- chicane drive");
  for (const std::string& option : options_of("drive")) EXPECT_THAT(words, HasSubstr(option + "\t"));
}

}  // namespace
}  // namespace chicane
