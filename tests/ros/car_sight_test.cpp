// SPDX-License-Identifier: MIT
#include "chicane/ros/car_topics.hpp"
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

}  // namespace
}  // namespace chicane::ros
