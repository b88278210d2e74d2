// SPDX-License-Identifier: MIT
#include "chicane/recording/video_encoder.hpp"
#include "support/chicane_test.hpp"

#include <sys/stat.h>
#include <unistd.h>

namespace chicane::recording {
namespace {

/// A path on which a program of ours stands in ffmpeg's place; the old path comes back.
class OtherPath {
 public:
  /// `script`: of a shell; empty: there is no ffmpeg at all.
  explicit OtherPath(const std::string& script) {
    fs::create_directories(folder_);
    if (!script.empty()) {
      std::ofstream(folder_ / "ffmpeg") << "#!/bin/sh\n" << script;
      ::chmod((folder_ / "ffmpeg").c_str(), 0755);
    }
    const std::string path = folder_.string() + (script.empty() ? "" : ":" + older_);
    ::setenv("PATH", path.c_str(), 1);
  }
  ~OtherPath() {
    ::setenv("PATH", older_.c_str(), 1);
    fs::remove_all(folder_);
  }
  OtherPath(const OtherPath&) = delete;
  OtherPath& operator=(const OtherPath&) = delete;
  [[nodiscard]] std::string file(const std::string& name) const { return (folder_ / name).string(); }

 private:
  fs::path folder_ = fs::temp_directory_path() / ("chicane_video_test." + std::to_string(getpid()));
  std::string older_ = std::getenv("PATH");
};

TEST(VideoEncoder, NamesTheEndingsItKnows) {
  EXPECT_TRUE(check_video_name("a/lap.mp4"));
  const auto refused = check_video_name("lap.avi");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("lap.avi"));
  EXPECT_THAT(refused.error().message, HasSubstr(".webm"));
  for (const char* ending : {".mp4", ".webm", ".webp", ".gif"}) {
    const auto words = encoder_command({.output = std::string("-x") + ending, .width = 320, .height = 180});
    EXPECT_THAT(words, Contains("320x180"));
    EXPECT_EQ(words.back(), std::string("file:-x") + ending) << "never taken for an option";
  }
}

TEST(VideoEncoder, SaysWhichPackageHasFfmpegWhereItIsMissing) {
  const OtherPath path("");
  const auto encoder = VideoEncoder::start({.output = path.file("a.gif")});
  ASSERT_FALSE(encoder);
  EXPECT_EQ(encoder.error().code, ErrorCode::kNotFound);
  EXPECT_THAT(encoder.error().message, HasSubstr("apt-get install ffmpeg"));
}

TEST(VideoEncoder, GivesEveryByteToTheProgram) {
  const OtherPath path("for last; do :; done; cat > \"${last#file:}\"\n");
  auto encoder = test::good(VideoEncoder::start({.output = path.file("a.gif"), .width = 4, .height = 2}));
  const std::vector<std::uint8_t> picture(24, 'x');
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(encoder->add(picture));
  ASSERT_TRUE(encoder->finish());
  EXPECT_EQ(fs::file_size(path.file("a.gif")), 24000U);
}

TEST(VideoEncoder, AProgramThatFailsLeavesNoFile) {
  const OtherPath path("for last; do :; done; echo half > \"${last#file:}\"; exit 1\n");
  auto encoder = test::good(VideoEncoder::start({.output = path.file("a.gif")}));
  const std::vector<std::uint8_t> picture(1 << 16, 'x');
  Result<void> added;
  for (int i = 0; i < 1000 && added; ++i) added = encoder->add(picture);
  EXPECT_FALSE(added) << "no signal ends this program";
  EXPECT_FALSE(encoder->finish());
  EXPECT_FALSE(fs::exists(path.file("a.gif")));
}

TEST(VideoEncoder, WhatIsNotFinishedIsRemoved) {
  const OtherPath path("for last; do :; done; cat > \"${last#file:}\"\n");
  {
    auto encoder = test::good(VideoEncoder::start({.output = path.file("a.gif")}));
    const std::vector<std::uint8_t> picture(100, 'x');
    ASSERT_TRUE(encoder->add(picture));
  }
  EXPECT_FALSE(fs::exists(path.file("a.gif")));
}

}  // namespace
}  // namespace chicane::recording
