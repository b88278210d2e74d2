// SPDX-License-Identifier: MIT
#include "chicane/protocol/car_messages.hpp"

#include "chicane/protocol/ros_messages.hpp"
#include "protocol/cdr_reader.hpp"
#include "support/chicane_test.hpp"

namespace chicane::protocol {
namespace {

const std::vector<Vec2> kLine{{1.0, 2.0}, {3.0, 4.0}};
constexpr std::int64_t kStamp = 1'700'000'001'250'000'007;

/// Message as its receiver reads it.
template <class Message>
Message read_again(const Message& message) {
  return *test::good(decode<Message>(encode(message)));
}
/// Message as its receiver reads it, which refuses its bytes wherever they are cut.
template <class Message>
Message read_whole(const Message& message) {
  test::expect_refused_when_cut<Message>(encode(message));
  return read_again(message);
}

TEST(CarMessages, AreReadAsTheyWereWrittenAndRefusedWhenTheyAreCut) {
  const auto seen = read_whole(OdometryMessage{.stamp = kStamp,
                                               .frame = "map",
                                               .child_frame = "ego_racecar/base_link",
                                               .pose = {.x = 1.5, .y = -2.5, .psi = 0.75},
                                               .vx = 3.0,
                                               .vy = -0.25,
                                               .yaw_rate = 0.5});
  EXPECT_EQ(seen.stamp, kStamp);
  EXPECT_EQ(seen.child_frame, "ego_racecar/base_link");
  EXPECT_NEAR(seen.pose.psi, 0.75, 1e-15);
  EXPECT_EQ(seen.vy, -0.25);
  EXPECT_EQ(seen.yaw_rate, 0.5);

  const auto drive = read_whole(
      DriveMessage{.stamp = kStamp, .frame = "car", .steer = 0.25, .speed = 4.5, .acceleration = -1.5});
  EXPECT_EQ(drive.stamp, kStamp);
  EXPECT_EQ(drive.steer, 0.25);
  EXPECT_EQ(drive.speed, 4.5);
  EXPECT_EQ(drive.acceleration, -1.5);

  const auto imu = read_whole(ImuMessage{.stamp = kStamp, .yaw_rate = 0.5, .ax = 1.0, .ay = 2.0});
  EXPECT_EQ(imu.yaw_rate, 0.5);
  EXPECT_EQ(imu.ay, 2.0);

  const auto path = read_whole(path_along(0, "map", kLine));
  ASSERT_EQ(path.poses.size(), 2U);
  EXPECT_EQ(path.poses[1].pose.y, 4.0);
  EXPECT_NEAR(read_whole(PoseMessage{.frame = "map", .pose = {.x = 1, .y = 2, .psi = -3}}).pose.psi, -3.0,
              1e-15);

  const auto transforms =
      read_whole(TransformsMessage{{{kStamp, "map", "odom", {.x = 1.0, .y = -2.0, .psi = 0.5}}}}).transforms;
  ASSERT_EQ(transforms.size(), 1U);
  EXPECT_EQ(transforms[0].stamp, kStamp);
  EXPECT_EQ(transforms[0].frame, "map");
  EXPECT_EQ(transforms[0].child_frame, "odom");
  EXPECT_EQ(transforms[0].pose.y, -2.0);
  EXPECT_NEAR(transforms[0].pose.psi, 0.5, 1e-12);  // the message holds a quaternion

  EXPECT_EQ(read_whole(ClockMessage{kStamp}).time, kStamp);
  for (const bool data : {true, false}) EXPECT_EQ(read_whole(BoolMessage{data}).data, data);
  EXPECT_TRUE(decode<BoolMessage>(std::string("\0\0\0\0\1", 5))->data) << "the other byte order";
  std::string bytes = encode(PathMessage{.frame = "m"});
  std::fill(bytes.end() - 4, bytes.end(), '\x7f');
  EXPECT_FALSE(decode<PathMessage>(bytes)) << "more points than bytes";
}

TEST(CarMessages, DriveOfAutowareHasStampsAnglesAndSpeeds) {
  const std::string bytes =
      encode(AutowareMessage{{.stamp = kStamp, .steer = 0.25, .speed = 4.5, .acceleration = -1.5}});
  test::CdrReader reader(bytes);
  const double stamp = reader.seconds();
  EXPECT_EQ(reader.seconds(), stamp);
  for (int i = 0; i < 2; ++i) EXPECT_EQ(reader.seconds(), stamp);
  EXPECT_EQ(reader.get<float>(), 0.25F);
  EXPECT_EQ(reader.get<float>(), 0.0F);
  EXPECT_EQ(reader.get<std::uint8_t>(), 0);
  for (int i = 0; i < 2; ++i) EXPECT_EQ(reader.seconds(), stamp);
  EXPECT_EQ(reader.get<float>(), 4.5F);
  EXPECT_EQ(reader.get<float>(), -1.5F);
  EXPECT_EQ(reader.get<float>(), 0.0F);
  EXPECT_EQ(reader.get<std::uint8_t>(), 1);
  EXPECT_EQ(reader.get<std::uint8_t>(), 0);
  EXPECT_TRUE(reader.is_at_end());
}

TEST(CarMessages, AScanHasItsAnglesAndRanges) {
  const std::string bytes =
      encode(ScanMessage{.stamp = kStamp, .angle_min = -2, .angle_increment = 0.5, .ranges = {1, 2}});
  test::CdrReader reader(bytes);
  reader.seconds();
  reader.text();
  EXPECT_EQ(reader.get<float>(), -2.0F);
  EXPECT_EQ(reader.get<float>(), -1.5F) << "the last angle";
  EXPECT_EQ(reader.get<float>(), 0.5F);
  for (int i = 0; i < 4; ++i) reader.get<float>();  // times and the least and the largest range
  EXPECT_EQ(reader.get<std::uint32_t>(), 2U);
  EXPECT_EQ(reader.get<float>(), 1.0F);
  EXPECT_EQ(reader.get<float>(), 2.0F);
  EXPECT_EQ(reader.get<std::uint32_t>(), 0U);
  EXPECT_TRUE(reader.is_at_end());
}

TEST(CarMessages, AStopIsReadAsItWasWrittenAndRefusedWhenItIsUnsound) {
  StopMessage message{.stamp = kStamp};
  message.stop.size = 3;
  for (int i = 0; i < 3; ++i) {
    message.stop.points[static_cast<std::size_t>(i)] = {
        .time = 0.1 * i, .distance = 1.0 * i, .speed = 2.0 - i, .command = {.steer = 0.1, .throttle = -0.5}};
  }
  const auto read = test::good(decode<StopMessage>(encode(message)));
  EXPECT_EQ(read->stop.size, 3);
  EXPECT_EQ(read->stop.points[2].distance, 2.0);
  EXPECT_EQ(read->stop.points[2].command.throttle, -0.5);

  StopMessage backwards = message;
  backwards.stop.points[2].time = -1.0;
  EXPECT_FALSE(decode<StopMessage>(encode(backwards)));
  StopMessage unknown = message;
  unknown.stop.points[1].speed = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(decode<StopMessage>(encode(unknown)));
}

TEST(CarMessages, HaveDefinitions) {
  for (const std::string_view type :
       {OdometryMessage::kType, DriveMessage::kType, AutowareMessage::kType, ImuMessage::kType,
        PathMessage::kType, PoseMessage::kType, ScanMessage::kType, TransformsMessage::kType,
        StopMessage::kType, BoolMessage::kType})
    EXPECT_NE(ros_schema(type), "") << type;
}

constexpr ServiceCall kCall{.client = 0x1122334455667788, .sequence = 7};

TEST(ParameterMessages, AreReadAsTheyWereWrittenAndRefusedWhenTheyAreCut) {
  const auto names = read_again(NamesRequest{.call = kCall, .names = {"latency_ms", "laps"}});
  EXPECT_EQ(names.call.client, kCall.client);
  EXPECT_EQ(names.call.sequence, 7);
  EXPECT_THAT(names.names, ElementsAre("latency_ms", "laps"));
  const auto asked = read_whole(SetRequest{
      .call = kCall,
      .parameters = {{"latency_ms", 50.0}, {"laps", 3.0}, {"controller", std::string("pid")}, {"x", true}}});
  ASSERT_EQ(asked.parameters.size(), 4U);
  EXPECT_EQ(std::get<double>(asked.parameters[0].value), 50.0);
  EXPECT_EQ(std::get<double>(asked.parameters[1].value), 3.0);  // an integer on the wire
  EXPECT_EQ(std::get<std::string>(asked.parameters[2].value), "pid");
  EXPECT_EQ(std::get<bool>(asked.parameters[3].value), true);
  EXPECT_THAT(read_again(ListReply{kCall, {"a", "b"}}).names, ElementsAre("a", "b"));
  const auto set = read_again(SetReply{kCall, {{true, ""}, {false, "out of range"}}});
  EXPECT_TRUE(set.outcomes[0].is_successful);
  EXPECT_EQ(set.outcomes[1].reason, "out of range");
  const auto get = read_again(GetReply{kCall, {{"latency_ms", 20.0}, {"unknown", {}}}});
  EXPECT_EQ(std::get<double>(get.values[0].value), 20.0);
  EXPECT_TRUE(std::holds_alternative<std::monostate>(get.values[1].value));
}

TEST(ParameterMessages, DescribeWithMeaningAndRange) {
  const std::string bytes = encode(DescribeReply{kCall, {{"latency_ms", 20.0}}});
  test::CdrReader reader(bytes);
  EXPECT_EQ(reader.get<std::uint64_t>(), kCall.client);
  EXPECT_EQ(reader.get<std::int64_t>(), 7);
  EXPECT_EQ(reader.get<std::uint32_t>(), 1U);
  EXPECT_EQ(reader.text(), "latency_ms");
  EXPECT_EQ(reader.get<std::uint8_t>(), 3);  // PARAMETER_DOUBLE
  EXPECT_THAT(reader.text(), testing::EndsWith("[ms]"));
  EXPECT_EQ(reader.text(), "");
  EXPECT_EQ(reader.get<std::uint8_t>(), 0);
  EXPECT_EQ(reader.get<std::uint8_t>(), 0);
  EXPECT_EQ(reader.get<std::uint32_t>(), 1U);
  EXPECT_EQ(reader.number(), 0.0);
  EXPECT_EQ(reader.number(), 500.0);
}

}  // namespace
}  // namespace chicane::protocol
