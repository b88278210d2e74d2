// SPDX-License-Identifier: MIT
// Commands that are programs of their own, chicane-bench, chicane-ros and chicane-lab, are started wherever
// the program stands. Seen with a copy of the program and scripts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace chicane {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class OtherProgram : public ::testing::Test {
 protected:
  OtherProgram() {
    folder_ = fs::path(::testing::TempDir()) /
              (std::string("chicane_") + ::testing::UnitTest::GetInstance()->current_test_info()->name() +
               "_" + std::to_string(::getpid()));
    fs::create_directories(folder_ / "bin");
    fs::copy_file(CHICANE_PROGRAM, folder_ / "bin/chicane");
  }
  ~OtherProgram() override { fs::remove_all(folder_); }

  /// A program that prints its words and ends with 7.
  void put_script(const std::string& place) const {
    const fs::path file = folder_ / place;
    fs::create_directories(file.parent_path());
    std::ofstream(file) << "#!/bin/sh\necho \"$@\"\nexit 7\n";
    fs::permissions(file, fs::perms::owner_all);
  }
  /// Exit code; what it printed is in `out` and `err`.
  int run(const std::string& words) {
    const std::string where = "'" + folder_.string() + "/";
    const int status = std::system(  // NOLINT(cert-env33-c): a shell is what users have
        ("PATH=" + where + "path' " + where + "bin/chicane' " + words + " > " + where + "out' 2> " + where +
         "err'")
            .c_str());
    out = read("out");
    err = read("err");
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  std::string out, err;

 private:
  [[nodiscard]] std::string read(const char* name) const {
    std::ostringstream text;
    text << std::ifstream(folder_ / name).rdbuf();
    return text.str();
  }
  fs::path folder_;
};

TEST_F(OtherProgram, BenchSaysHowToBuildTheProgramThatIsMissing) {
  EXPECT_EQ(run("bench"), 3);
  EXPECT_EQ(out, "");
  EXPECT_THAT(err, HasSubstr("./run.sh bench"));
  EXPECT_THAT(err, HasSubstr("--target chicane_bench"));
}

TEST_F(OtherProgram, HelpOfBenchAndMistakesNeedNoOtherProgram) {
  EXPECT_EQ(run("bench --help"), 0);
  EXPECT_THAT(out, HasSubstr("--instances"));
  EXPECT_EQ(run("bench --horizons 10,201"), 2);
  EXPECT_EQ(run("bench --instances 0"), 2);
}

TEST_F(OtherProgram, BenchStartsTheProgramBesideIt) {
  put_script("bin/chicane-bench");
  EXPECT_EQ(run("bench"), 7);
  EXPECT_EQ(out, "--instances 100 --horizons 10,20,50\n");
  EXPECT_EQ(run("bench --json --horizons 2,200 --instances 3"), 7);
  EXPECT_EQ(out, "--instances 3 --horizons 2,200 --json\n");
}

TEST_F(OtherProgram, BenchStartsTheProgramOfAnInstallation) {
  put_script("libexec/chicane/chicane-bench");
  EXPECT_EQ(run("bench --json"), 7);
}

TEST_F(OtherProgram, RosSaysInALineHowToInstallTheProgramThatIsMissing) {
  EXPECT_EQ(run("ros --car f1tenth"), 2);
  EXPECT_EQ(out, "");
  EXPECT_THAT(err, HasSubstr("apt install ./chicane-ros_*.deb"));
  EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 1);
}

TEST_F(OtherProgram, HelpOfRosAndMistakesNeedNoOtherProgram) {
  EXPECT_EQ(run("ros --help"), 0);
  EXPECT_THAT(out, HasSubstr("--odom-topic"));
  EXPECT_EQ(run("ros --domain 500"), 2);
  EXPECT_THAT(err, HasSubstr("chicane ros: "));
}

TEST_F(OtherProgram, RosStartsTheProgramBesideItWithTheSameWords) {
  put_script("bin/chicane-ros");
  EXPECT_EQ(run("ros --track oval --set 'horizon.steps=12' --domain 7"), 7);
  EXPECT_EQ(out, "--track oval --set horizon.steps=12 --domain 7\n");
}

TEST_F(OtherProgram, LabSaysHowToBuildTheProgramThatIsMissing) {
  EXPECT_EQ(run("lane-change"), 3);
  EXPECT_EQ(out, "");
  EXPECT_THAT(err, HasSubstr("chicane lane-change: chicane-lab"));
  EXPECT_THAT(err, HasSubstr("./run.sh lane-change"));
  EXPECT_THAT(err, HasSubstr("--target chicane_lab"));
}

TEST_F(OtherProgram, HelpOfLabAndMistakesNeedNoOtherProgram) {
  EXPECT_EQ(run("sweep --help"), 0);
  EXPECT_THAT(out, HasSubstr("--shard"));
  EXPECT_EQ(run("sweep plan.yaml --shard 4/3"), 2);
  EXPECT_THAT(err, HasSubstr("chicane sweep: --shard"));
}

TEST_F(OtherProgram, LabStartsItsProgramWithTheCommandAndTheSameWords) {
  put_script("libexec/chicane/chicane-lab");
  EXPECT_EQ(run("merge a.jsonl 'b c.jsonl' -o all.jsonl"), 7);
  EXPECT_EQ(out, "merge a.jsonl b c.jsonl -o all.jsonl\n");
}

/// The quoted words of a file's lines that begin with `begin`, with `quote` around each.
std::set<std::string> quoted_words(const std::string& file, const std::string& begin, char quote) {
  std::set<std::string> words;
  std::ifstream in(std::string(CHICANE_SOURCE_DIR) + file);
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with(begin)) continue;
    const std::regex word(std::string(1, quote) + R"( ?([a-z-]+) ?)" + quote);
    for (std::sregex_iterator at(line.begin(), line.end(), word), end; at != end; ++at)
      words.insert((*at)[1]);
  }
  return words;
}

TEST(Lab, IsBuiltByRunShForEachOfItsCommands) {
  std::set<std::string> commands = quoted_words("/apps/chicane/lab/main.cpp", "    {\"", '"');
  commands.erase("replay");  // of recordings it needs no other program
  EXPECT_EQ(commands.size(), 12U);
  std::set<std::string> built = quoted_words("/run.sh", "  ' campaign '", '\'');
  built.insert({"tune", "video"});  // which need a package more
  EXPECT_EQ(built, commands);
}

TEST_F(OtherProgram, LabShowsLogsOfOtherPrograms) {
  put_script("bin/chicane-lab");
  EXPECT_EQ(run("replay drive.csv"), 7);
  EXPECT_EQ(out, "replay drive.csv\n");
}

TEST_F(OtherProgram, RosStartsTheProgramOfAnInstallationOrOnThePath) {
  put_script("path/chicane-ros");
  EXPECT_EQ(run("ros --simulate"), 7);
  put_script("libexec/chicane/chicane-ros");
  EXPECT_EQ(run("ros --simulate"), 7);
}

}  // namespace
}  // namespace chicane
