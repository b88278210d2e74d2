// SPDX-License-Identifier: MIT
#include "chicane/recording/replay.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "chicane/recording/recorder.hpp"

namespace chicane::recording {
namespace {

class BagMetadata : public testing::Test {
 protected:
  BagMetadata() { std::filesystem::create_directories(folder_); }
  ~BagMetadata() override { std::filesystem::remove_all(folder_); }
  [[nodiscard]] std::string file(const char* name) const { return (folder_ / name).string(); }
  [[nodiscard]] static std::string text_of(const std::string& path) {
    std::stringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  }

  // A folder for each process: tests run beside each other.
  std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / ("chicane_bag_metadata_" + std::to_string(::getpid()));
};

TEST_F(BagMetadata, CountsTheMessagesOfARecordingInTheLayoutOfRosbag2) {
  RecorderOptions options;
  options.path = file("run.mcap");
  options.may_wait = true;
  {
    const auto recorder = Recorder::create(options);
    ASSERT_TRUE(recorder);
    telemetry::Frame frame;
    for (int i = 0; i < 10; ++i) {
      frame.cycle = static_cast<std::uint64_t>(i);
      frame.time = 0.04 * i;
      (*recorder)->record(frame);
    }
    ASSERT_TRUE((*recorder)->finish());
  }
  ASSERT_TRUE(can_be_bag(options.path));
  ASSERT_TRUE(write_bag_metadata(options.path));
  const std::string text = text_of(file("metadata.yaml"));
  // As rosbag2_storage writes it (metadata_io.cpp, version 5).
  EXPECT_THAT(text,
              testing::StartsWith("rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: mcap\n"
                                  "  duration:\n    nanoseconds: "));
  EXPECT_THAT(text, testing::HasSubstr(
                        "    - topic_metadata:\n        name: /odom\n        type: nav_msgs/msg/Odometry\n"
                        "        serialization_format: cdr\n        offered_qos_profiles: \"\"\n"
                        "      message_count: 10\n"));
  EXPECT_THAT(text, testing::HasSubstr("  relative_file_paths:\n    - \"run.mcap\"\n"));
  EXPECT_THAT(text, testing::HasSubstr("  duration:\n    nanoseconds: 360000000\n"));
}

TEST_F(BagMetadata, AFolderIsTheBagOfOneRecording) {
  std::ofstream(file("metadata.yaml"))
      << "rosbag2_bagfile_information:\n  relative_file_paths:\n    - \"other.mcap\"\n";
  const auto refused = can_be_bag(file("run.mcap"));
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, testing::HasSubstr("another recording"));
  EXPECT_TRUE(can_be_bag(file("other.mcap")));
}

TEST_F(BagMetadata, FailsWithoutTheRecording) { EXPECT_FALSE(write_bag_metadata(file("none.mcap"))); }

}  // namespace
}  // namespace chicane::recording
