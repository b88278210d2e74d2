// SPDX-License-Identifier: MIT
#include "chicane/run/lane_change.hpp"

#include "support/chicane_test.hpp"
#include "support/own_controller.hpp"
#include "support/runs.hpp"

namespace chicane::run {
namespace {

scenario::Scenario scenario_of(const std::string& car, const std::string& preset) {
  return test::scenario_of({{"preset", preset}, {"car", car}});
}

/// With `road-car`. The course is planned once for all tests: that takes longer than they do.
LaneChangeOutcome drive(const std::string& preset, double speed) {
  const scenario::Scenario scenario = scenario_of("road-car", preset);
  static LaneChange change = LaneChange::create(scenario.vehicle).value();
  return change.drive(scenario, speed).value();
}

TEST(LaneChange, HoldsTheSpeedAndRollsThroughWithoutThrottle) {
  const LaneChangeOutcome outcome = drive("race", 15.0);
  EXPECT_NEAR(outcome.entry_speed, 15.0, 0.1);
  EXPECT_TRUE(outcome.has_passed()) << outcome.room;
  EXPECT_LT(outcome.exit_speed, outcome.entry_speed);
  EXPECT_EQ(drive("race", 15.0).room, outcome.room) << "the same bits again";
}

TEST(LaneChange, HitsConesWhereNoTyreHoldsTheCar) {
  const LaneChangeOutcome outcome = drive("race", 40.0);
  EXPECT_FALSE(outcome.has_passed());
  EXPECT_LT(outcome.room, -0.5);
}

#ifdef CHICANE_SLOW_TESTS
TEST(LaneChange, IsPassedFasterByRaceThanByPurePursuitAndStanley) {
  constexpr double k60Kmph = 16.7;
  EXPECT_TRUE(drive("race", k60Kmph).has_passed());
  EXPECT_FALSE(drive("pure-pursuit", k60Kmph).has_passed());
  EXPECT_FALSE(drive("stanley", k60Kmph).has_passed());
}
#endif

TEST(LaneChange, IsNotPassedByWhoDrivesStraightOn) {
  const scenario::Scenario scenario = scenario_of("udacity", "default");
  const auto limit =
      LaneChange::create(scenario.vehicle).value().find_limit(scenario, [](const scenario::Scenario&) {
        return Result<std::unique_ptr<controller::Controller>>(std::make_unique<test::OwnController>());
      });
  ASSERT_TRUE(limit.has_value());
  EXPECT_EQ(limit->passed_kmph, 0);
  const LaneChangeCourse::Lane side = LaneChangeCourse(scenario.vehicle.width).lanes()[1];
  EXPECT_NEAR(limit->failed.room, -0.5 * scenario.vehicle.width - side.right, 0.05)
      << "the side lane's cones";
}

TEST(LaneChange, IsNoneForModelCars) {
  EXPECT_EQ(test::refusal_of(LaneChange::create(scenario_of("f1tenth", "race").vehicle)),
            "lane change: got a model car, expected one in full size");
}

// Lengths and widths of a car of 1.8 m: 12, 13.5, 11, 12.5 and 12 m; 1.1 b + 0.25, b + 1 and 3 m.
TEST(LaneChangeCourse, HasTheSectionsOfTheStandard) {
  const auto lanes = LaneChangeCourse(1.8).lanes();
  const double expected[3][3] = {{0.0, 12.0, 2.23}, {25.5, 36.5, 2.8}, {49.0, 61.0, 3.0}};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(lanes[i].begin, expected[i][0]);
    EXPECT_EQ(lanes[i].end, expected[i][1]);
    EXPECT_NEAR(lanes[i].left - lanes[i].right, expected[i][2], 1e-12);
  }
  EXPECT_NEAR(lanes[1].right - lanes[0].left, 1.0, 1e-12);
  const auto wide = LaneChangeCourse(2.43).lanes();
  EXPECT_NEAR(wide[2].left - wide[2].right, 1.3 * 2.43 + 0.25, 1e-12);
}

TEST(LaneChangeCourse, HasAWayThatABodyGoesThroughAndConesBesideIt) {
  for (const double width : {1.6, 1.8, 2.43}) {
    const LaneChangeCourse course(width);
    for (double x = -5.0; x <= 66.0; x += 0.1) {
      const double slope = (course.way(x + 1e-4) - course.way(x - 1e-4)) / 2e-4;
      const model::Pose on_it{x, course.way(x), std::atan(slope)};
      EXPECT_GT(course.room(on_it, 4.3, width), 0.0) << width << " at " << x;
    }
    const auto entry = course.lanes()[0];
    EXPECT_NEAR(course.room({6.0, 0.3, 0.0}, 4.0, width), entry.left - 0.3 - 0.5 * width, 1e-9);
    EXPECT_LT(course.room({6.0, entry.left, 0.0}, 4.0, width), 0.0);
    EXPECT_LT(course.room({6.0, 0.0, 0.4}, 4.0, width), 0.0) << "a corner of the body beyond the cones";
    EXPECT_TRUE(std::isinf(course.room({19.0, 2.0, 0.1}, 4.0, width))) << "between the lanes";
  }
}

TEST(LaneChangeCourse, IsARoadWhoseEdgesAreTheCones) {
  const LaneChangeCourse course(1.8);
  const road::Track road = course.road().value();
  for (const LaneChangeCourse::Lane& lane : course.lanes()) {
    for (double x = lane.begin; x <= lane.end; x += 0.5) {
      const double y = 0.5 * (lane.left + lane.right);
      const road::Projection foot = road.centre().project({x, y});
      EXPECT_NEAR(road.edge_distance(foot), 0.5 * (lane.left - lane.right), 0.05) << x;
    }
  }
}

}  // namespace
}  // namespace chicane::run
