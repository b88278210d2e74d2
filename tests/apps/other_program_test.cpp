// SPDX-License-Identifier: MIT
// Commands that are programs of their own, chicane-bench, chicane-ros and chicane-lab, are started wherever
// the program stands. Seen with a copy of the program.

#include <regex>

#include "apps/program_outcome.hpp"
#include "support/chicane_test.hpp"

namespace chicane {
namespace {

class OtherProgram : public ::testing::Test, protected test::Folder {
 protected:
  OtherProgram() {
    fs::create_directories(folder_ / "bin");
    fs::copy_file(CHICANE_PROGRAM, folder_ / "bin/chicane");
  }

  [[nodiscard]] test::Outcome run(const std::string& words) const {
    const std::string where = "'" + folder_.string() + "/";
    return test::shell("PATH=" + where + "path' " + where + "bin/chicane' " + words);
  }
};

TEST_F(OtherProgram, ThatIsMissingIsSaidWithTheWayToHaveIt) {
  struct Missing {
    const char* words;
    int code;
    std::vector<const char*> said;
  };
  for (const auto& [words, code, said] : std::vector<Missing>{
           {"bench", 3, {"./run.sh bench", "--target chicane_bench"}},
           {"ros --car f1tenth", 2, {"apt install ./chicane-ros_*.deb"}},
           {"lane-change",
            3,
            {"chicane lane-change: chicane-lab", "./run.sh lane-change", "--target chicane_lab"}}}) {
    const test::Outcome outcome = run(words);
    EXPECT_EQ(outcome.code, code) << words;
    EXPECT_EQ(outcome.out, "");
    for (const char* each : said) EXPECT_THAT(outcome.err, HasSubstr(each));
  }
}

TEST_F(OtherProgram, IsNotNeededForHelpAndMistakes) {
  for (const auto& [words, said] : std::vector<std::pair<const char*, const char*>>{
           {"bench --help", "--instances"}, {"ros --help", "--odom-topic"}, {"sweep --help", "--shard"}}) {
    const test::Outcome help = run(words);
    EXPECT_EQ(help.code, 0) << words;
    EXPECT_THAT(help.out, HasSubstr(said));
  }
  for (const auto& [words, said] : std::vector<std::pair<const char*, const char*>>{
           {"bench --horizons 10,201", "chicane bench: --horizons"},
           {"bench --instances 0", "chicane bench: --instances"},
           {"ros --domain 500", "chicane ros: "},
           {"sweep plan.yaml --shard 4/3", "chicane sweep: --shard"}}) {
    const test::Outcome mistake = run(words);
    EXPECT_EQ(mistake.code, 2) << words;
    EXPECT_THAT(mistake.err, HasSubstr(said));
  }
}

/// Seen with programs that print their words and end with 7.
TEST_F(OtherProgram, IsStartedWhereverItStandsWithTheWordsGiven) {
  struct Start {
    const char *place, *words, *printed;
  };
  for (const auto& [place, words, printed] :
       std::vector<Start>{{"bin/chicane-bench", "bench --json --horizons 2,200 --instances 3",
                           "--json --horizons 2,200 --instances 3"},
                          {"libexec/chicane/chicane-bench", "bench", ""},
                          {"bin/chicane-ros", "ros --track oval --set 'horizon.steps=12' --domain 7",
                           "--track oval --set horizon.steps=12 --domain 7"},
                          {"libexec/chicane/chicane-ros", "ros --simulate", "--simulate"},
                          {"path/chicane-ros", "ros --simulate", "--simulate"},
                          {"libexec/chicane/chicane-lab", "merge a.jsonl 'b c.jsonl' -o all.jsonl",
                           "merge a.jsonl b c.jsonl -o all.jsonl"},
                          {"bin/chicane-lab", "replay drive.csv", "replay drive.csv"}}) {
    const fs::path file = folder_ / place;
    fs::create_directories(file.parent_path());
    std::ofstream(file) << "#!/bin/sh\necho \"$@\"\nexit 7\n";
    fs::permissions(file, fs::perms::owner_all);
    const test::Outcome outcome = run(words);
    EXPECT_EQ(outcome.code, 7) << place;
    EXPECT_EQ(outcome.out, printed + std::string("\n"));
    fs::remove(file);
  }
}

std::set<std::string> words_of(const std::string& text, const std::string& word) {
  const std::regex pattern(word);
  std::set<std::string> words;
  for (std::sregex_iterator at(text.begin(), text.end(), pattern), end; at != end; ++at)
    words.insert((*at)[1]);
  return words;
}

/// The page of the command line has a row for each command, and names chicane-lab's.
TEST(Lab, IsBuiltByRunShForEachOfItsCommands) {
  const std::string page = test::shell("cat docs/reference/cli.md").out;
  const std::size_t begin = page.find("`chicane-lab` does the work of") + 13;
  const std::set<std::string> named =
      words_of(page.substr(begin, page.find("An installation", begin) - begin), "`([a-z-]+)`");
  EXPECT_TRUE(named.contains("sweep"));
  std::string asked = ". tools/build.sh";
  for (const std::string& command : words_of(page, "\\| `chicane ([a-z-]+)"))
    asked += "; is_of_lab . " + command + " && echo " + command;
  EXPECT_EQ(words_of(test::shell("bash -c '" + asked + "; true'").out, "([a-z-]+)\n"), named);
}

}  // namespace
}  // namespace chicane
