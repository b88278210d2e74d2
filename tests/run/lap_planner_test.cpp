// SPDX-License-Identifier: MIT
#include "chicane/run/lap_planner.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <thread>
#include <vector>

#include "chicane/protocol/library.hpp"
#include "chicane/run/closed_loop.hpp"
#include "chicane/run/racing.hpp"

namespace chicane::run {
namespace {

scenario::Scenario race_by_waypoints() {
  return protocol::compose({.scenario_file = {},
                            .settings = {{"preset", "race"},
                                         {"track", "oval"},
                                         {"guard.road", "waypoints"},
                                         {"laps", "3"}}})
      .value();
}

/// Wants a lap of the waypoints it is given.
class Learner final : public controller::Controller {
 public:
  explicit Learner(std::vector<Vec2> waypoints) : waypoints_{std::move(waypoints)} {}
  [[nodiscard]] const controller::StepResult& step(const model::Measurement& /*now*/,
                                                   Deadline /*deadline*/) noexcept override {
    return result_;
  }
  [[nodiscard]] std::span<const Vec2> wants_lap_of() const noexcept override {
    return is_wanted ? std::span<const Vec2>(waypoints_) : std::span<const Vec2>{};
  }
  void reset() noexcept override {}
  [[nodiscard]] std::string_view name() const noexcept override { return "learner"; }

  bool is_wanted = true;

 private:
  std::vector<Vec2> waypoints_;
  controller::StepResult result_;
};

std::vector<Vec2> circle(double radius) {
  std::vector<Vec2> points;
  for (int i = 0; i < 40; ++i)
    points.emplace_back(radius * std::cos(kTwoPi * i / 40.0), radius * std::sin(kTwoPi * i / 40.0));
  return points;
}

std::shared_ptr<const road::RacingRoad> wait_for_lap(LapPlanner& planner, const Learner& learner) {
  for (int i = 0; i < 12000; ++i) {
    if (auto lap = planner.follow(learner, race_by_waypoints(), 0.0)) return lap;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return {};
}

TEST(LapPlanner, PlansInVirtualTimeAsLateAsAPlanTakes) {
  const Learner learner(circle(70.0));
  const scenario::Scenario race = race_by_waypoints();
  LapPlanner planner(LapPlanner::Clock::kVirtual);
  for (double time = 3.0; time < 3.0 + LapPlanner::kPlanningTime; time += 0.04)
    EXPECT_EQ(planner.follow(learner, race, time), nullptr) << time;
  const auto lap = planner.follow(learner, race, 3.0 + LapPlanner::kPlanningTime);
  ASSERT_NE(lap, nullptr);
  EXPECT_TRUE(lap->is_learned());
  EXPECT_NEAR(lap->line().length(), kTwoPi * 70.0, kTwoPi * 4.0);
  EXPECT_EQ(planner.follow(learner, race, 20.0), nullptr) << "once";
}

TEST(LapPlanner, PlansTheSameBesideARun) {
  const std::vector<Vec2> points = circle(70.0);
  Learner learner(points);
  LapPlanner planner(LapPlanner::Clock::kReal);
  const auto lap = wait_for_lap(planner, learner);
  ASSERT_NE(lap, nullptr);
  const auto again = plan_learned_lap(race_by_waypoints(), points).value();
  for (double s = 0.0; s < lap->line().length(); s += 7.0) {
    EXPECT_EQ(lap->line().at(s).position, again->line().at(s).position);
    EXPECT_EQ(lap->line().demand(s).speed, again->line().demand(s).speed);
  }
  learner.is_wanted = false;
  EXPECT_EQ(planner.follow(learner, race_by_waypoints(), 1.0), nullptr);
  learner.is_wanted = true;
  EXPECT_NE(wait_for_lap(planner, learner), nullptr) << "after a reset it plans anew";
}

TEST(LapPlanner, HasNoneWhereTheRoadHasNone) {
  const Learner learner(circle(2.0));  // tighter than the car can turn
  LapPlanner planner(LapPlanner::Clock::kVirtual);
  for (double time = 0.0; time < 20.0; time += 1.0)
    EXPECT_EQ(planner.follow(learner, race_by_waypoints(), time), nullptr);
}

TEST(LapPlanner, IsAskedByARunThatKnowsWaypointsOnly) {
  const auto loop = ClosedLoop::create(race_by_waypoints()).value();
  std::vector<telemetry::Change> changes;
  const telemetry::RunSummary run = run_closed_loop(
      *loop, {.on_change = [&](const telemetry::Change& change) { changes.push_back(change); }});
  EXPECT_TRUE(run.completed) << run.end_reason;
  EXPECT_EQ(run.off_track_events, 0);
  ASSERT_EQ(changes.size(), 1);
  EXPECT_EQ(changes[0].name.view(), LapPlanner::kChange);
  EXPECT_GT(changes[0].time, run.laps[0].lap_time);
  EXPECT_LT(changes[0].time, run.laps[0].lap_time + 15.0);
}

}  // namespace
}  // namespace chicane::run
