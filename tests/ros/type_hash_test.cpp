// SPDX-License-Identifier: MIT
#include "chicane/ros/type_hash.hpp"

#include <gtest/gtest.h>

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

// As ROS 2 Jazzy announces them (`ros2 topic info -v`).
TEST(TypeHash, IsThatOfRos2) {
  EXPECT_EQ(type_hash("nav_msgs/msg/Odometry"),
            "RIHS01_3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0");
  EXPECT_EQ(type_hash("std_msgs/msg/Bool"),
            "RIHS01_feb91e995ff9ebd09c0cb3d2aed18b11077585839fb5db80193b62d74528f6c9");
}

TEST(TypeHash, IsEmptyForATypeWithoutDefinition) { EXPECT_EQ(type_hash("other_msgs/msg/Thing"), ""); }

TEST(TypeDescription, LeavesOutConstantsDefaultsAndComments) {
  const std::string text =
      type_description("a_msgs/msg/A",
                       "# about\nuint8 KIND=1\nfloat64 w 1  # default\nb/B[] all\nbyte[3] x\n"
                       "====\nMSG: b/B\nstring name\n");
  EXPECT_EQ(
      text,
      R"({"type_description": {"type_name": "a_msgs/msg/A", "fields": [)"
      R"({"name": "w", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, )"
      R"({"name": "all", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "b/msg/B"}}, )"
      R"({"name": "x", "type": {"type_id": 64, "capacity": 3, "string_capacity": 0, "nested_type_name": ""}}]}, )"
      R"("referenced_type_descriptions": [{"type_name": "b/msg/B", "fields": [)"
      R"({"name": "name", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}]})");
}

}  // namespace
}  // namespace chicane::ros
