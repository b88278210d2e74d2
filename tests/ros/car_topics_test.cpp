// SPDX-License-Identifier: MIT
#include "chicane/ros/car_topics.hpp"

#include "chicane/ros/nodes.hpp"
#include "support/chicane_test.hpp"
#include "support/roads.hpp"

namespace chicane::ros {
namespace {

scenario::Scenario scenario() {
  scenario::Scenario scenario;
  scenario.vehicle.rear_axle = 1.5;
  scenario.latency = 0.1;
  return scenario;
}

TEST(CarSight, MovesOdometryFromTheRearAxleToTheCentreOfMass) {
  CarSight sight(scenario(), nullptr, true);
  const auto seen = test::good(sight.measure(
      {.pose = {.x = 10.0, .y = 20.0, .psi = 1.5707963267948966}, .vx = 3.0, .yaw_rate = 2.0}, 1.0));
  EXPECT_NEAR(seen->x, 10.0, 1e-12);
  EXPECT_NEAR(seen->y, 21.5, 1e-12);
  EXPECT_NEAR(seen->speed, std::sqrt(9.0 + 9.0), 1e-12);  // 1.5 m ahead of it a yaw rate moves it sideways
  CarSight centred(scenario(), nullptr, false);
  EXPECT_EQ(centred.measure({.pose = {.x = 10.0}}, 1.0)->x, 10.0);
}

TEST(CarSight, MeasuresTheCommandThatActsNow) {
  CarSight sight(scenario(), nullptr, true);
  EXPECT_EQ(sight.measure({}, 0.0)->steer, 0.0);
  sight.sent(1.00, {.steer = 0.1, .throttle = 0.5});
  sight.sent(1.04, {.steer = 0.2, .throttle = -0.5});
  EXPECT_EQ(sight.measure({}, 1.12)->steer, 0.1);
  EXPECT_EQ(sight.measure({}, 1.12)->throttle, 0.5);
  EXPECT_EQ(sight.measure({}, 1.15)->steer, 0.2);
  EXPECT_EQ(sight.measure({}, 1.15)->throttle, 0.0);  // braking is not measured
}

TEST(CarSight, RefusesNumbersThatAreNotFinite) {
  CarSight sight(scenario(), nullptr, true);
  EXPECT_FALSE(sight.measure({.vx = std::numeric_limits<double>::infinity()}, 0.0));
  EXPECT_FALSE(sight.measure({.pose = {.psi = std::numeric_limits<double>::quiet_NaN()}}, 0.0));
}

TEST(CarSight, SeesWaypointsOfAPathThatIsALap) {
  CarSight sight(scenario(), nullptr, true);
  EXPECT_FALSE(sight.has_road());
  ASSERT_TRUE(sight.use_path(test::circle_points(100.0, 100)));
  EXPECT_TRUE(sight.has_road());
  // On the last stretch of the lap: the waypoints go on over its beginning.
  const auto seen = test::good(sight.measure({.pose = {.x = 100.0, .y = -8.0, .psi = 1.57}}, 0.0));
  ASSERT_EQ(seen->waypoint_count, 6);
  EXPECT_GT(seen->waypoints[5].y(), 20.0);
}

/// Planners repeat the first point of a lap as its last one, or do not.
TEST(CarSight, SeesTheSameRoadOfALapThatEndsWhereItBegan) {
  CarSight sight(scenario(), nullptr, true), repeating(scenario(), nullptr, true);
  std::vector<Vec2> lap = test::circle_points(100.0, 100);
  ASSERT_TRUE(sight.use_path(lap));
  lap.push_back(lap.front());
  ASSERT_TRUE(repeating.use_path(lap));
  for (const double angle : {-0.08, 0.0, 0.08, 3.0}) {
    const model::Pose pose{100.0 * std::cos(angle), 100.0 * std::sin(angle), angle + 1.57};
    const auto one = sight.measure({.pose = pose}, 0.0), other = repeating.measure({.pose = pose}, 0.0);
    ASSERT_TRUE(one && other);
    ASSERT_EQ(one->waypoint_count, other->waypoint_count);
    for (std::size_t i = 0; i < 6; ++i)
      EXPECT_NEAR((one->waypoints[i] - other->waypoints[i]).norm(), 0.0, 1e-6) << angle << ' ' << i;
  }
}

TEST(CarSight, KeepsTheRoadWhenAPathIsNone) {
  CarSight sight(scenario(), nullptr, true);
  ASSERT_TRUE(sight.use_path(test::circle_points(100.0, 100)));
  EXPECT_FALSE(sight.use_path({{0.0, 0.0}}));
  EXPECT_TRUE(sight.has_road());
}

const model::VehicleParams kCar = model::road_car_params();

TEST(DriveCommand, ComesBackAsThePedalThatWasMeant) {
  for (const bool by_speed : {true, false}) {
    const DriveOptions options{.is_by_speed = by_speed};
    for (const double throttle : {-0.5, -0.1, 0.0, 0.3, 0.9}) {
      const auto message = to_message(kCar, {.steer = 0.1, .throttle = throttle}, 15.0, options);
      const double wanted = by_speed ? message.speed : message.acceleration;
      EXPECT_NEAR(throttle_of(kCar, wanted, 15.0, options), throttle, 0.01) << throttle << ' ' << by_speed;
      EXPECT_EQ(message.steer, 0.1);
    }
  }
}

TEST(DriveCommand, NeverAsksForASpeedBelowZero) {
  EXPECT_EQ(to_message(kCar, {.throttle = -1.0}, 0.2, {}).speed, 0.0);
}

TEST(DriveCommand, ASpeedOfZeroBringsTheCarToRestAndDoesNotRollItBack) {
  double speed = 1.0;
  for (int i = 0; i < 400; ++i)
    speed += 0.005 * model::longitudinal_acceleration(kCar, throttle_of(kCar, 0.0, speed, {}), speed);
  EXPECT_NEAR(speed, 0.0, 0.1);
  EXPECT_LE(throttle_of(kCar, 0.0, 0.0, {}), 0.0);
}

TEST(NodeOptions, HaveTheNamesOfF1tenthGymRos) {
  const NodeOptions node;
  EXPECT_EQ(node.topics.odom, "/ego_racecar/odom");
  EXPECT_EQ(node.topics.drive, "/drive");
  EXPECT_EQ(node.frames.base, "ego_racecar/base_link");
}

constexpr double kQuarter = 1.5707963267948966;

TEST(FrameTree, ComposesAndInvertsAlongChainsOfParents) {
  FrameTree frames;
  frames.put({.frame = "map", .child_frame = "odom", .pose = {.x = 10.0, .y = 0.0, .psi = kQuarter}});
  frames.put({.frame = "odom", .child_frame = "base", .pose = {.x = 2.0, .y = 1.0, .psi = 0.0}});
  frames.put({.frame = "map", .child_frame = "camera", .pose = {.x = 0.0, .y = 5.0, .psi = 0.0}});
  const auto base = test::good(frames.find("map", "base"));
  EXPECT_NEAR(base->x, 9.0, 1e-12);
  EXPECT_NEAR(base->y, 2.0, 1e-12);
  EXPECT_NEAR(base->psi, kQuarter, 1e-12);
  const auto back = test::good(frames.find("base", "map"));
  const model::Pose round = composed(*base, *back);
  EXPECT_NEAR(round.x, 0.0, 1e-12);
  EXPECT_NEAR(round.y, 0.0, 1e-12);
  const auto beside = frames.find("camera", "base");
  ASSERT_TRUE(beside) << "their chains meet in map";
  EXPECT_NEAR(beside->y, -3.0, 1e-12);
  EXPECT_TRUE(frames.find("/map", "base")) << "a slash in front is no other frame";
  EXPECT_FALSE(frames.find("world", "base"));
}

TEST(FrameTree, TheNewestTransformCounts) {
  FrameTree frames;
  frames.put({.frame = "map", .child_frame = "odom", .pose = {.x = 1.0}});
  frames.put({.frame = "map", .child_frame = "odom", .pose = {.x = 2.0}});
  frames.put(
      {.frame = "map", .child_frame = "odom", .pose = {.x = std::numeric_limits<double>::quiet_NaN()}});
  EXPECT_EQ(frames.find("map", "odom")->x, 2.0);
}

TEST(FrameTree, EndsInARingAndAtItsCapacity) {
  FrameTree frames;
  frames.put({.frame = "a", .child_frame = "b"});
  frames.put({.frame = "b", .child_frame = "a"});
  EXPECT_FALSE(frames.find("c", "a"));
  for (std::size_t i = 0; i < 2 * FrameTree::kCapacity; ++i)
    frames.put({.frame = "map", .child_frame = "frame" + std::to_string(i)});
  EXPECT_TRUE(frames.find("map", "frame0"));
  EXPECT_FALSE(frames.find("map", "frame" + std::to_string(2 * FrameTree::kCapacity - 1)));
}

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
