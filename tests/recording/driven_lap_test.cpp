// SPDX-License-Identifier: MIT
#include "chicane/recording/lap_picture.hpp"

#include "chicane/recording/detail/ros_message.hpp"
#include "recording/recorded_run.hpp"
#include "support/chicane_test.hpp"
#include "telemetry/sample_mcap.hpp"

namespace chicane::recording {
namespace {

using telemetry::TemporaryFile;

TEST(DrivenRun, HoldsWhatWasRecorded) {
  const TemporaryFile file;
  const std::vector<telemetry::Frame> frames = record_run(file.path(), "oval", "1");
  const auto run = test::good(read_run(file.path()));
  EXPECT_EQ(run->track, "oval");
  EXPECT_GT(run->left.size(), 100U);
  EXPECT_EQ(run->left.size(), run->right.size());
  EXPECT_EQ(run->last_lap, 1);
  ASSERT_EQ(run->moments.size(), frames.size());
  const telemetry::Frame& frame = frames[200];
  const DrivenMoment& moment = run->moments[200];
  EXPECT_DOUBLE_EQ(moment.time, frame.time);
  EXPECT_DOUBLE_EQ(moment.position.x(), frame.truth.x);
  EXPECT_DOUBLE_EQ(moment.heading, frame.truth.psi);
  EXPECT_DOUBLE_EQ(moment.steer, frame.result.command.steer);
  EXPECT_DOUBLE_EQ(moment.s, frame.s);
  ASSERT_EQ(moment.plan.size(), static_cast<std::size_t>(frame.result.plan.size));
  EXPECT_DOUBLE_EQ(moment.plan[3].y(), frame.result.plan.points[3].y);
  EXPECT_EQ(run->of_lap(1).size(), frames.size());
  EXPECT_EQ(run->of_lap(0).size(), frames.size());
  EXPECT_TRUE(run->of_lap(2).empty());
}

TEST(DrivenRun, SaysWhatIsNoRecording) {
  EXPECT_FALSE(read_run("nowhere.mcap"));
  const auto read = read_run(CHICANE_SOURCE_DIR "/README.md");
  ASSERT_FALSE(read);
}

TEST(RosReader, ReadsNestedMessagesArraysAndTexts) {
  const auto reader = test::good(RosReader::create(
      "# a comment\nuint8 KIND=3\nbool flag\nfloat64 x # with unit\na_msgs/Point[] points\nstring name\n"
      "float64[2] pair\n================\nMSG: a_msgs/Point\nint32 i\nfloat64 y\n"));
  std::string bytes{"\0\1\0\0", 4};
  const auto add = [&](auto value, std::size_t padding) {
    bytes.append(padding, '\0');
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  add(std::uint8_t{1}, 0);
  add(2.5, 7);
  add(std::uint32_t{2}, 0);
  add(std::int32_t{-1}, 0);
  add(7.0, 0);
  add(std::int32_t{5}, 0);
  add(8.0, 4);
  add(std::uint32_t{3}, 0);
  bytes.append("hi\0", 3);
  add(1.0, 1);
  add(2.0, 0);
  const auto content = test::good(reader->read(bytes));
  EXPECT_EQ(content->number("flag"), 1.0);
  EXPECT_EQ(content->number("x"), 2.5);
  EXPECT_THAT(content->list("points.i"), ElementsAre(-1.0, 5.0));
  EXPECT_THAT(content->list("points.y"), ElementsAre(7.0, 8.0));
  EXPECT_EQ(content->text("name"), "hi");
  EXPECT_THAT(content->list("pair"), ElementsAre(1.0, 2.0));
  EXPECT_EQ(content->number("nothing", -7.0), -7.0);
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(reader->read(std::string_view(bytes).substr(0, size))) << size;
}

TEST(RosReader, RefusesDefinitionsWithHolesAndCountsBeyondReason) {
  EXPECT_THAT(test::refusal_of(RosReader::create("b_msgs/Missing[] all\n")), HasSubstr("b_msgs/Missing"));
  const auto reader = test::good(RosReader::create("float64[] x\n"));
  EXPECT_FALSE(reader->read(std::string("\0\1\0\0\xff\xff\xff\xff", 8)));
  const auto endless = test::good(RosReader::create("c_msgs/A a\n===\nMSG: c_msgs/A\nc_msgs/A a\n"));
  EXPECT_FALSE(endless->read(std::string("\0\1\0\0", 4))) << "a message within itself ends somewhere";
}

}  // namespace
}  // namespace chicane::recording
