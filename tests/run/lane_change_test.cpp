// SPDX-License-Identifier: MIT
#include "chicane/run/lane_change.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <string_view>

#include "chicane/protocol/library.hpp"

namespace chicane::run {
namespace {

scenario::Scenario scenario_of(const std::string& car, const std::string& preset) {
  return protocol::compose({.scenario_file = {}, .settings = {{"preset", preset}, {"car", car}}}).value();
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

class Straight final : public controller::Controller {
 public:
  [[nodiscard]] const controller::StepResult& step(const model::Measurement&, Deadline) noexcept override {
    return result_;
  }
  void reset() noexcept override {}
  [[nodiscard]] std::string_view name() const noexcept override { return "straight"; }

 private:
  controller::StepResult result_{};
};

TEST(LaneChange, IsNotPassedByWhoDrivesStraightOn) {
  const scenario::Scenario scenario = scenario_of("udacity", "default");
  const auto limit =
      LaneChange::create(scenario.vehicle).value().find_limit(scenario, [](const scenario::Scenario&) {
        return Result<std::unique_ptr<controller::Controller>>(std::make_unique<Straight>());
      });
  ASSERT_TRUE(limit.has_value());
  EXPECT_EQ(limit->passed_kmph, 0);
  const LaneChangeCourse::Lane side = LaneChangeCourse(scenario.vehicle.width).lanes()[1];
  EXPECT_NEAR(limit->failed.room, -0.5 * scenario.vehicle.width - side.right, 0.05)
      << "the side lane's cones";
}

TEST(LaneChange, IsNoneForModelCars) {
  const auto change = LaneChange::create(scenario_of("f1tenth", "race").vehicle);
  ASSERT_FALSE(change.has_value());
  EXPECT_EQ(change.error().message, "lane change: got a model car, expected one in full size");
}

}  // namespace
}  // namespace chicane::run
