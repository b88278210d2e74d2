// SPDX-License-Identifier: MIT
#include "chicane/recording/replay.hpp"

#include <unistd.h>

#include "chicane/recording/recorder.hpp"
#include "support/chicane_test.hpp"
#include "support/folder.hpp"

namespace chicane::recording {
namespace {

class BagMetadata : public testing::Test, protected test::Folder {
 protected:
};

TEST_F(BagMetadata, CountsTheMessagesOfARecordingInTheLayoutOfRosbag2) {
  RecorderOptions options;
  options.path = path("run.mcap");
  options.may_wait = true;
  {
    const auto recorder = test::good(Recorder::create(options));
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
  const std::string text = content("metadata.yaml");
  // As rosbag2_storage writes it (metadata_io.cpp, version 5).
  EXPECT_THAT(text, StartsWith("rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: mcap\n"
                               "  duration:\n    nanoseconds: "));
  EXPECT_THAT(text,
              HasSubstr("    - topic_metadata:\n        name: /odom\n        type: nav_msgs/msg/Odometry\n"
                        "        serialization_format: cdr\n        offered_qos_profiles: \"\"\n"
                        "      message_count: 10\n"));
  EXPECT_THAT(text, HasSubstr("  relative_file_paths:\n    - \"run.mcap\"\n"));
  EXPECT_THAT(text, HasSubstr("  duration:\n    nanoseconds: 360000000\n"));
}

TEST_F(BagMetadata, AFolderIsTheBagOfOneRecording) {
  std::ofstream(path("metadata.yaml"))
      << "rosbag2_bagfile_information:\n  relative_file_paths:\n    - \"other.mcap\"\n";
  EXPECT_THAT(test::refusal_of(can_be_bag(path("run.mcap"))), HasSubstr("another recording"));
  EXPECT_TRUE(can_be_bag(path("other.mcap")));
}

TEST_F(BagMetadata, FailsWithoutTheRecording) { EXPECT_FALSE(write_bag_metadata(path("none.mcap"))); }

}  // namespace
}  // namespace chicane::recording
