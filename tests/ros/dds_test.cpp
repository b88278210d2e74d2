// SPDX-License-Identifier: MIT
#include "chicane/ros/dds.hpp"

#include "chicane/protocol/car_messages.hpp"
#include "chicane/ros/cdr_type.hpp"
#include "support/chicane_test.hpp"

namespace chicane::ros {
namespace {

using namespace std::chrono_literals;
constexpr int kDomain = 71;  // of these tests alone

TEST(Dds, SendsBytesAsTheyAreOnLoopback) {
  auto node = Participant::create({.domain = kDomain});
  ASSERT_TRUE(node) << node.error().message;
  auto writer = (*node)->writer("/odom", "nav_msgs/msg/Odometry", {});
  auto reader = (*node)->reader("/odom", "nav_msgs/msg/Odometry", {});
  ASSERT_TRUE(writer && reader);
  const std::string bytes = protocol::encode(protocol::OdometryMessage{
      .stamp = 1'700'000'000'123'456'789, .frame = "map", .child_frame = "car", .vx = 3.0});
  ASSERT_TRUE((*writer)->write(bytes) && (*writer)->reply(bytes, std::string(24, 'x')));
  (*node)->wait(2s);
  const auto taken = (*reader)->take();
  ASSERT_EQ(taken.size(), 2U);
  EXPECT_EQ(taken[0].bytes, bytes);
  EXPECT_EQ(taken[1].bytes, bytes) << "the call is beside the message";
  EXPECT_NE(taken[0].writer, 0U);
  EXPECT_EQ((*writer)->matched(), 1);
  EXPECT_EQ((*reader)->matched(), 1);
}

TEST(Dds, FailsInWordsWithoutTheInterface) {
  const auto node = Participant::create({.domain = kDomain + 1, .interface = "no<such\"one"});
  ASSERT_FALSE(node);
  EXPECT_NE(node.error().message.find("no<such\"one"), std::string::npos) << node.error().message;
}

TEST(RosNames, AreMangledAsRos2DoesAndBack) {
  EXPECT_EQ(dds_topic("/ego_racecar/odom"), "rt/ego_racecar/odom");
  EXPECT_EQ(dds_topic("rq/chicane/get_parametersRequest"), "rq/chicane/get_parametersRequest");
  EXPECT_EQ(ros_topic("rt/ego_racecar/odom"), "/ego_racecar/odom");
  EXPECT_EQ(ros_topic("DCPSParticipant"), "DCPSParticipant");
  EXPECT_EQ(dds_type("nav_msgs/msg/Odometry"), "nav_msgs::msg::dds_::Odometry_");
  EXPECT_EQ(ros_type("nav_msgs::msg::dds_::Odometry_"), "nav_msgs/msg/Odometry");
  EXPECT_EQ(ros_type("HelloWorld"), "HelloWorld");
}

}  // namespace
}  // namespace chicane::ros
