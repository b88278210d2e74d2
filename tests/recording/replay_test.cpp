// SPDX-License-Identifier: MIT
#include "chicane/recording/replay.hpp"

#include <unistd.h>

#include "chicane/recording/recorder.hpp"
#include "support/chicane_test.hpp"
#include "support/folder.hpp"
#include "support/runs.hpp"
#include "telemetry/sample_mcap.hpp"

namespace chicane::recording {
namespace {

using telemetry::TemporaryFile;

/// Two seconds of a run.
void record_two_seconds(const std::string& path) {
  const auto loop = test::loop_of(test::scenario_of({{"controller", "pid"}, {"laps", "1"}}));
  RecorderOptions options{.path = path, .run = {}, .scenario = loop->scenario(), .may_wait = true};
  options.run.track = loop->track().name();
  const auto recorder = test::good(Recorder::create(options));
  test::drive_cycles(*loop, 50, [&](const telemetry::Frame& frame) { (*recorder)->record(frame); });
  EXPECT_TRUE((*recorder)->finish());
}

TEST(ReadRecording, VisitsTheScenarioAndThenEachStepInOrder) {
  const TemporaryFile file;
  record_two_seconds(file.path());
  RecordingHead head;
  std::size_t scenarios = 0, read = 0;
  double last = -1.0;
  const auto report = read_recording(file.path(), head, [&](const RecordedEvent& event) -> Result<void> {
    if (const auto* begun = std::get_if<scenario::Scenario>(&event)) {
      EXPECT_EQ(begun->controller, "pid");
      EXPECT_EQ(head["track"], "lakeside") << "known before the first event";
      EXPECT_EQ(read, 0U) << "a scenario begins a run";
      ++scenarios;
    }
    if (const auto* step = std::get_if<RecordedStep>(&event)) {
      EXPECT_GT(step->log_time, last);
      last = step->log_time;
      ++read;
    }
    return {};
  });
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(scenarios, 1U);
  EXPECT_EQ(read, 50U);
  EXPECT_EQ(head["no such entry"], "");
  EXPECT_EQ(head["guard_mode"], "on");
  EXPECT_EQ(head["guard_road"], "track");
  EXPECT_EQ(head["guard_version"], std::to_string(safety::kGuardVersion));
}

TEST(ReadRecording, EndsWithTheFailureOfItsVisitorAndRefusesWhatIsNoRecording) {
  const TemporaryFile file;
  record_two_seconds(file.path());
  RecordingHead head;
  int visited = 0;
  const auto visit = [&](const RecordedEvent&) -> Result<void> {
    if (++visited < 3) return {};
    return fail(ErrorCode::kInvalidArgument, "enough");
  };
  EXPECT_EQ(test::refusal_of(read_recording(file.path(), head, visit)), "enough");
  EXPECT_FALSE(read_recording(file.path() + ".none", head, visit));
  std::ofstream(file.path()) << "a letter";
  const auto report = read_recording(file.path(), head, visit);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kParse);
  EXPECT_THAT(report.error().message, HasSubstr(file.path()));
  EXPECT_EQ(visited, 3);
}

class BagMetadata : public testing::Test, protected test::Folder {};

TEST_F(BagMetadata, CountsTheMessagesOfARecordingInTheLayoutOfRosbag2) {
  {
    const auto recorder =
        test::good(Recorder::create({.path = path("run.mcap"), .run = {}, .scenario = {}, .may_wait = true}));
    telemetry::Frame frame;
    for (int i = 0; i < 10; ++i) {
      frame.cycle = static_cast<std::uint64_t>(i);
      frame.time = 0.04 * i;
      (*recorder)->record(frame);
    }
    ASSERT_TRUE((*recorder)->finish());
  }
  ASSERT_TRUE(can_be_bag(path("run.mcap")));
  ASSERT_TRUE(write_bag_metadata(path("run.mcap")));
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

TEST_F(BagMetadata, OfAFolderIsThatOfOneRecordingThatIsThere) {
  write("metadata.yaml", "rosbag2_bagfile_information:\n  relative_file_paths:\n    - \"other.mcap\"\n");
  EXPECT_THAT(test::refusal_of(can_be_bag(path("run.mcap"))), HasSubstr("another recording"));
  EXPECT_TRUE(can_be_bag(path("other.mcap")));
  EXPECT_FALSE(write_bag_metadata(path("none.mcap")));
}

TEST(TemporaryFile, NamesAnotherPlaceEachTimeWhereNothingIsAndClearsUp) {
  std::string path;
  {
    const recording::TemporaryFile file{".mcap"}, other{".mcap"};
    path = file.path();
    EXPECT_NE(path, other.path());
    EXPECT_TRUE(path.ends_with(".mcap"));
    EXPECT_FALSE(std::filesystem::exists(path));
    std::ofstream{path} << "text";
    EXPECT_TRUE(std::filesystem::exists(path));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace chicane::recording
