// SPDX-License-Identifier: MIT
// A film from outside, with a shell script in ffmpeg's place: the package is optional.

#include "apps/program_outcome.hpp"
#include "support/chicane_test.hpp"

namespace chicane {
namespace {

class VideoCommand : public testing::Test, protected test::Folder {
 protected:
  VideoCommand() {
    fs::create_directories(folder_ / "bin");
    write("bin/ffmpeg", "#!/bin/sh\nfor last; do :; done\necho \"$*\" >&2\nexec cat > \"${last#file:}\"\n");
    fs::permissions(folder_ / "bin" / "ffmpeg", fs::perms::owner_all);
  }
  /// Its exit code; what it says on stderr is in said_. `places`: where programs are looked for.
  int program(const std::string& arguments, const std::string& places) {
    const test::Outcome outcome =
        test::shell("PATH='" + places + "' " + test::kProgram + arguments + " > /dev/null");
    said_ = outcome.err;
    return outcome.code;
  }
  [[nodiscard]] std::string quoted(const std::string& name) const { return "'" + path(name) + "'"; }
  [[nodiscard]] std::string usual() const { return (folder_ / "bin").string() + ":" + std::getenv("PATH"); }

  std::string said_;
};

TEST_F(VideoCommand, FilmsALapWithAGhost) {
  const std::string drive = "drive --fast --track oval --laps 1 --set time_limit_s=6 --record ";
  static_cast<void>(program(drive + quoted("a.mcap"), usual()));
  static_cast<void>(program(drive + quoted("b.mcap") + " --preset pid", usual()));
  const std::string film =
      "video " + quoted("a.mcap") + " --ghost " + quoted("b.mcap") + " --width 160 --rate 5 ";
  ASSERT_EQ(program(film + "--for-s 4 -o " + quoted("lap.gif"), usual()), 0) << said_;
  EXPECT_THAT(said_, HasSubstr("-s 160x90 -r 5"));
  const auto picture = static_cast<std::uintmax_t>(160 * 90 * 3);
  EXPECT_EQ(fs::file_size(folder_ / "lap.gif") % picture, 0U);
  EXPECT_GE(fs::file_size(folder_ / "lap.gif"), 19 * picture);
  EXPECT_EQ(program(film + "--lap 7 -o " + quoted("no.gif"), usual()), 2);
  EXPECT_THAT(said_, HasSubstr("--lap: got 7"));
  EXPECT_EQ(program(film + "-o " + quoted("lap.avi"), usual()), 2);
  EXPECT_THAT(said_, HasSubstr("expected .mp4"));
  EXPECT_EQ(program(film + "-o " + quoted("lap.mp4"), "/nowhere"), 3);
  EXPECT_THAT(said_, HasSubstr("apt-get install ffmpeg"));
  EXPECT_FALSE(fs::exists(folder_ / "lap.mp4"));
}

TEST_F(VideoCommand, AFilmThatIsStoppedLeavesTheOlderOneAlone) {
  static_cast<void>(program(
      "drive --fast --track oval --laps 1 --set time_limit_s=6 --record " + quoted("a.mcap"), usual()));
  write("lap.gif", "older");
  write("bin/ffmpeg", "#!/bin/sh\nkill -INT $PPID\nexec cat > /dev/null\n");
  EXPECT_EQ(program("video " + quoted("a.mcap") + " --pace 0.05 -o " + quoted("lap.gif"), usual()), 1)
      << said_;
  EXPECT_THAT(said_, HasSubstr("stopped: nothing was written"));
  write("bin/ffmpeg", "#!/bin/sh\nexit 1\n");
  EXPECT_EQ(program("video " + quoted("a.mcap") + " -o " + quoted("lap.gif"), usual()), 3) << said_;
  EXPECT_EQ(content("lap.gif"), "older");
}

}  // namespace
}  // namespace chicane
