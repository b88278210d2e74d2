// SPDX-License-Identifier: MIT
#include "chicane/ros/cdr_type.hpp"
#include "support/chicane_test.hpp"

namespace chicane::ros {
namespace {

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
