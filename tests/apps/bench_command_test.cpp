// SPDX-License-Identifier: MIT
// `chicane bench` starts chicane-bench, wherever the program stands. Seen with a copy of the program and a
// script.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace chicane {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class BenchCommand : public ::testing::Test {
 protected:
  BenchCommand() {
    folder_ = fs::path(::testing::TempDir()) /
              (std::string("chicane_") + ::testing::UnitTest::GetInstance()->current_test_info()->name() +
               "_" + std::to_string(::getpid()));
    fs::create_directories(folder_ / "bin");
    fs::copy_file(CHICANE_PROGRAM, folder_ / "bin/chicane");
  }
  ~BenchCommand() override { fs::remove_all(folder_); }

  /// A chicane-bench that prints its words and ends with 7.
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
        (where + "bin/chicane' bench " + words + " > " + where + "out' 2> " + where + "err'").c_str());
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

TEST_F(BenchCommand, SaysHowToBuildTheProgramThatIsMissing) {
  EXPECT_EQ(run(""), 3);
  EXPECT_EQ(out, "");
  EXPECT_THAT(err, HasSubstr("./run.sh bench"));
  EXPECT_THAT(err, HasSubstr("--target chicane_bench"));
}

TEST_F(BenchCommand, HelpAndMistakesNeedNoOtherProgram) {
  EXPECT_EQ(run("--help"), 0);
  EXPECT_THAT(out, HasSubstr("--instances"));
  EXPECT_EQ(run("--horizons 10,201"), 2);
  EXPECT_EQ(run("--instances 0"), 2);
}

TEST_F(BenchCommand, StartsTheProgramBesideIt) {
  put_script("bin/chicane-bench");
  EXPECT_EQ(run(""), 7);
  EXPECT_EQ(out, "--instances 100 --horizons 10,20,50\n");
  EXPECT_EQ(run("--json --horizons 2,200 --reference 'a b' --instances 3"), 7);
  EXPECT_EQ(out, "--instances 3 --horizons 2,200 --reference a b --json\n");
}

TEST_F(BenchCommand, StartsTheProgramOfAnInstallation) {
  put_script("libexec/chicane/chicane-bench");
  EXPECT_EQ(run("--json"), 7);
}

}  // namespace
}  // namespace chicane
