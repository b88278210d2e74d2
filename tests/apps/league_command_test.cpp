// SPDX-License-Identifier: MIT
// A league from outside, with programs that it starts and ends itself.
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "apps/program_outcome.hpp"
#include "support/chicane_test.hpp"
#include "support/folder.hpp"

namespace chicane {
namespace {

class LeagueCommand : public testing::Test, protected test::Folder {
 protected:
  /// Its exit code; what it says is in said_.
  int league(const std::string& entries, const std::string& options, const std::string& before = "") {
    std::ofstream(folder_ / "l.yaml") << "settings: {laps: 0, time_limit_s: 1.5}\n"
                                         "search: {speed_mps: {from: 9, to: 10}}\n"
                                         "tracks: [oval]\ncars: [udacity]\nentries:\n"
                                      << entries;
    const std::string here = folder_.string();
    said_ = test::shell(before + test::kProgram + "league '" + here + "/l.yaml' --results '" + here +
                        "/r.jsonl' " + options);
    return said_.code;
  }

  test::Outcome said_;
};

TEST_F(LeagueCommand, DrivesOurControllersAndAProgramOverTheWire) {
  const std::string entries =
      "  ours: {preset: pid}\n"
      "  theirs: {server: \"{chicane} serve --preset pid --latency-ms {latency_ms} --port {port}\"}\n";
  const std::string options = "-o '" + (folder_ / "l.html").string() + "' --patience-s 60 --json";
  ASSERT_EQ(league(entries, options), 0) << said_.err;
  const auto rows = nlohmann::json::parse(said_.out);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0]["clean"], true);
  EXPECT_EQ(rows[0]["search_value"], 10.0);
  EXPECT_EQ(rows[1]["entry"], "theirs");
  EXPECT_EQ(rows[1]["clean"], true) << said_.err;
  EXPECT_GT(rows[1]["top_speed_mps"], 0.0);
  EXPECT_THAT(content("l.html"), HasSubstr("Standings"));
  EXPECT_THAT(content("r.jsonl"), HasSubstr("\"search_value\":10"));
  ASSERT_EQ(league(entries, options), 0) << said_.err;
  EXPECT_THAT(said_.err, HasSubstr("1 of 1 runs, 1 of them found")) << "what is done is not done again";
  EXPECT_THAT(said_.err, Not(HasSubstr("in real time")));
}

TEST_F(LeagueCommand, TakesAProgramInAnotherLanguage) {
  if (std::system("python3 -c 'import asyncio' 2>/dev/null") != 0)
    GTEST_SKIP() << "python3 is not installed, which the example is written in";
  const std::string program =
      "--server 'python3 examples/05_any_language.py --port {port} --latency-ms {latency_ms}'";
  ASSERT_EQ(league("  ours: {preset: pid}\n", program + " --patience-s 60 --json"), 0) << said_.err;
  const auto rows = nlohmann::json::parse(said_.out);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[1]["clean"], true) << said_.err;
  EXPECT_GT(rows[1]["top_speed_mps"], 1.0) << "it was driven, and not refused";
}

TEST_F(LeagueCommand, SaysInWordsWhyAProgramDoesNotDrive) {
  ASSERT_EQ(
      league("  ours: {preset: pid}\n  gone: {server: \"exit 3 # {port}\"}\n", "--patience-s 0.5 --json"), 0)
      << said_.err;
  const auto rows = nlohmann::json::parse(said_.out);
  EXPECT_EQ(rows[1]["clean"], false);
  EXPECT_THAT(std::string(rows[1]["why_not"]), HasSubstr("the program does not listen on port"));
}

TEST_F(LeagueCommand, RefusesALeagueWithFaultsAndOneThatIsNotThere) {
  EXPECT_EQ(league("  ours: {preset: 1, nonsense: 2}\n", ""), 2);
  EXPECT_THAT(said_.err, HasSubstr("l.yaml:6: nonsense"));
}

TEST_F(LeagueCommand, LeavesAPageThatItCannotReplace) {
  const std::string entries = "  ours: {preset: pid}\n", page = (folder_ / "old.html").string();
  ASSERT_EQ(league(entries, ""), 0) << said_.err;
  std::ofstream(page) << "old\n";
  EXPECT_EQ(league(entries, "-o '" + page + "'", "ulimit -f 2; "), 3);
  EXPECT_THAT(said_.err, HasSubstr(page + ": cannot be written: File too large"));
  EXPECT_EQ(content("old.html"), "old\n");
}

TEST_F(LeagueCommand, SaysAtOnceThatAPageCannotBeWritten) {
  EXPECT_EQ(league("  ours: {preset: pid}\n", "-o /nowhere/l.html"), 3);
  EXPECT_THAT(said_.err, HasSubstr("/nowhere/l.html: cannot be written: No such file or directory"));
  EXPECT_THAT(said_.err, Not(HasSubstr("1 of 1 runs"))) << "before anything is driven";
}

}  // namespace
}  // namespace chicane
