// SPDX-License-Identifier: MIT
#include "chicane/ros/car_topics.hpp"
#include "support/chicane_test.hpp"

namespace chicane::ros {
namespace {

WantedPartner odometry() {
  return {.topic = "/odom",
          .type = "nav_msgs/msg/Odometry",
          .qos_option = "--odom-qos",
          .topic_option = "--odom-topic"};
}
WantedPartner drive() {
  return {.is_reader = false,
          .topic = "/drive",
          .type = "ackermann_msgs/msg/AckermannDriveStamped",
          .qos = {.is_reliable = false},
          .qos_option = "--drive-qos",
          .topic_option = "--drive-topic"};
}

TEST(PartnerWatch, SaysThatThereIsNobodyInTheDomainOnce) {
  PartnerWatch watch({odometry()}, {.domain = 7});
  EXPECT_THAT(watch.look(1.0, {}, {0}), IsEmpty());
  EXPECT_THAT(watch.look(3.5, {}, {0}),
              ElementsAre(testing::AllOf(HasSubstr("nobody sends /odom"), HasSubstr("domain 7"),
                                         HasSubstr("--interface"))));
  EXPECT_THAT(watch.look(9.0, {}, {0}), IsEmpty());
}

TEST(PartnerWatch, NamesTheTopicOnWhichTheTypeIs) {
  PartnerWatch watch({odometry()}, {});
  const Endpoint other{.is_writer = true, .topic = "/pf/pose/odom", .type = "nav_msgs/msg/Odometry"};
  EXPECT_THAT(watch.look(4.0, {other}, {0}),
              ElementsAre(testing::AllOf(HasSubstr("/pf/pose/odom"), HasSubstr("--odom-topic"))));
}

TEST(PartnerWatch, SaysThatTheTypeIsWrong) {
  PartnerWatch watch({odometry()}, {});
  const Endpoint other{.is_writer = true, .topic = "/odom", .type = "geometry_msgs/msg/Pose"};
  EXPECT_THAT(
      watch.look(0.1, {other}, {0}),
      ElementsAre("/odom: got a partner with type geometry_msgs/msg/Pose, expected nav_msgs/msg/Odometry"));
  EXPECT_THAT(watch.look(0.2, {other}, {0}), IsEmpty());
}

TEST(PartnerWatch, SaysThatReliabilityDoesNotFit) {
  PartnerWatch watch({odometry(), drive()}, {});
  const Endpoint sender{
      .is_writer = true, .topic = "/odom", .type = "nav_msgs/msg/Odometry", .qos = {.is_reliable = false}};
  const Endpoint reader{.topic = "/drive", .type = "ackermann_msgs/msg/AckermannDriveStamped"};
  EXPECT_THAT(
      watch.look(0.1, {sender, reader}, {0, 0}),
      testing::UnorderedElementsAre(
          "/odom is sent best effort by a partner, and this program reads it reliably: nothing arrives; use "
          "--odom-qos best-effort",
          "/drive is read reliably by a partner, and this program sends it best effort: nothing arrives; use "
          "--drive-qos reliable"));
}

TEST(PartnerWatch, SaysThatPartnersComeAndGo) {
  PartnerWatch watch({odometry()}, {});
  EXPECT_THAT(watch.look(0.1, {}, {1}), ElementsAre("/odom has a sender"));
  EXPECT_THAT(watch.look(50.0, {}, {0}), ElementsAre("/odom has no sender any more"));
  EXPECT_THAT(watch.look(52.0, {}, {0}), IsEmpty());
  EXPECT_THAT(watch.look(54.0, {}, {0}), ElementsAre(HasSubstr("nobody sends /odom")));
}

}  // namespace
}  // namespace chicane::ros
