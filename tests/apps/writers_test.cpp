// SPDX-License-Identifier: MIT
// Files that the program writes as a whole: replaced or left, and one sentence when they cannot be written.

#include "program_outcome.hpp"
#include "support/chicane_test.hpp"

namespace chicane {
namespace {

using test::chicane_program;
using test::shell;

/// Results of 40 runs, and what is written of them.
class Writers : public ::testing::Test, protected test::Folder {
 protected:
  Writers() {
    const std::string plan = write("plan.yaml",
                                   "settings: {preset: pid, laps: 0, time_limit_s: 0.2}\n"
                                   "axes: [{seed: {from: 1, to: 20, step: 1}}, {speed_mph: [20, 30]}]\n");
    const auto driven = chicane_program("sweep '" + plan + "' -o '" + results() + "'");
    EXPECT_EQ(driven.code, 0) << driven.err;
  }
  [[nodiscard]] std::string results() const { return path("r.jsonl"); }
  /// Words of the program up to the name of the file, and its ending.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> writers() const {
    return {{"report '" + results() + "' -o ", ".html"},
            {"report '" + results() + "' --page ", ".md"},
            {"merge '" + results() + "' -o ", ".jsonl"},
            {"import tests/data/tracks/course.kml -o ", ".csv"}};
  }
};

TEST_F(Writers, LeaveAFileThatTheyCannotReplace) {
  for (const auto& [words, ending] : writers()) {
    const std::string whole(1500, 'o');
    const std::string old = write("old" + ending, whole);
    const auto outcome = shell("(ulimit -f 1; " + test::kProgram + words + "'" + old + "')");
    EXPECT_EQ(outcome.code, 3) << words << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(old + ": cannot be written: File too large")) << words;
    EXPECT_EQ(test::content_of(old), whole) << words;
  }
  for (const auto& each : fs::directory_iterator(folder_))
    EXPECT_NE(each.path().extension(), ".part") << each.path();
}

TEST_F(Writers, SayTheSameOfAFolderThatIsNotThere) {
  for (const auto& [words, ending] : writers()) {
    const std::string nowhere = path("no/such/x" + ending);
    const auto outcome = chicane_program(words + "'" + nowhere + "'");
    EXPECT_EQ(outcome.code, 3) << words << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(nowhere + ": cannot be written: No such file or directory")) << words;
  }
}

TEST_F(Writers, WriteThroughPipesAndDevices) {
  const auto outcome = shell(test::kProgram + "report '" + results() + "' -o /dev/stdout | cat");
  EXPECT_THAT(outcome.out, HasSubstr("<!doctype html>"));
  EXPECT_EQ(chicane_program("report '" + results() + "' -o /dev/null").code, 0);
  const auto full = chicane_program("report '" + results() + "' -o /dev/full");
  EXPECT_EQ(full.code, 3);
  EXPECT_THAT(full.err, HasSubstr("/dev/full: cannot be written: No space left on device"));
}

}  // namespace
}  // namespace chicane
