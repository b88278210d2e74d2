// SPDX-License-Identifier: MIT
#include "chicane/run/racing.hpp"

#include <thread>
#include "chicane/run/make.hpp"
#include "chicane/run/setting.hpp"
#include "support/chicane_test.hpp"
#include "support/own_controller.hpp"
#include "support/roads.hpp"
#include "support/runs.hpp"

namespace chicane::run {
namespace {

scenario::Scenario race_on(const char* track, const char* margin = "0.3") {
  return test::scenario_of({{"preset", "race"}, {"track", track}, {"tracking_mpc.edge_margin_m", margin}});
}

TEST(PlanLap, IsForThoseWhoRaceOnAKnownRoad) {
  const scenario::Scenario race = race_on("oval");
  const road::Track track = make_track(race).value();
  EXPECT_TRUE(race.races());
  EXPECT_EQ(plan_lap(race, nullptr).value(), nullptr) << "no road is known";
  const scenario::Scenario other = test::scenario_of();
  EXPECT_FALSE(other.races());
  EXPECT_EQ(plan_lap(other, &track).value(), nullptr);
}

TEST(PlanLap, KeepsTheMarginAndIsTheSameEachTime) {
  const scenario::Scenario race = race_on("oval");
  const road::Track track = make_track(race).value();
  const auto lap = plan_lap(race, &track).value();
  const auto again = plan_lap(race, &track).value();
  ASSERT_NE(lap, nullptr);
  const double half = 0.5 * (race.vehicle.track_width + race.vehicle.tire_width);
  double least = 100.0;
  for (double s = 0.0; s < lap->line().length(); s += 5.0) {
    EXPECT_EQ(lap->line().at(s).position, again->line().at(s).position);
    EXPECT_EQ(lap->line().demand(s).speed, again->line().demand(s).speed);
    least = std::min({least, lap->room(s).left - half, lap->room(s).right - half});
  }
  EXPECT_GT(least, 0.1) << "the middle of the car is nearer to the edge than its axles";
  EXPECT_LT(least, 0.6) << "it uses the road";
}

TEST(PlanLap, SaysWhyThereIsNone) {
  const scenario::Scenario race = race_on("lakeside", "3.9");
  const road::Track track = make_track(race).value();
  const auto lap = plan_lap(race, &track);
  ASSERT_FALSE(lap);
  EXPECT_NE(lap.error().message.find("the road is"), std::string::npos) << lap.error().message;
}

std::vector<std::string> causes(const std::vector<lap_time::LapWithout>& laps) {
  std::vector<std::string> names;
  for (const lap_time::LapWithout& lap : laps) names.push_back(lap.cause);
  return names;
}

scenario::Scenario calm() {
  scenario::Scenario scenario;
  scenario.track = "oval";
  scenario.laps = 1;
  return scenario;
}

TEST(LapsWithout, LeaveOutWhatTheScenarioDoesNotHave) {
  scenario::Scenario scenario = calm();
  const auto laps = test::good(laps_without(scenario));
  EXPECT_THAT(causes(*laps), ElementsAre("latency", "grip reserve", "guard"));
  scenario.latency = 0.0;
  scenario.guard.mode = safety::GuardMode::kOff;
  scenario.sensor.position_noise = 0.01;
  EXPECT_THAT(causes(*laps_without(scenario)), ElementsAre("sensor", "grip reserve"));
}

TEST(LapsWithout, AreThoseOfTheScenarioThatLacksTheCause) {
  const scenario::Scenario scenario = calm();
  const auto laps = test::good(laps_without(scenario));
  scenario::Scenario instant = scenario;
  instant.latency = 0.0;
  const telemetry::RunSummary run = test::drive(instant);
  EXPECT_EQ(laps->front().lap_time, run.laps.front().lap_time);
  EXPECT_EQ(laps->front().corners, run.laps.front().corner_times);
  // More grip is a faster lap: the calm preset plans with 0.8 of it.
  EXPECT_LT((*laps)[1].lap_time, (*laps)[0].lap_time);
}

TEST(LapsWithout, AreNoneWhereThereWasNoTime) {
  const auto laps = laps_without(calm(), [] { return false; });
  ASSERT_TRUE(laps) << laps.error().message;
  EXPECT_TRUE(laps->empty());
}

scenario::Scenario race_by_waypoints(const char* car = "udacity") {
  return test::scenario_of(
      {{"preset", "race"}, {"car", car}, {"track", "oval"}, {"guard.road", "waypoints"}, {"laps", "3"}});
}

/// Wants a lap of the waypoints it is given.
class Learner final : public test::OwnController {
 public:
  explicit Learner(std::vector<Vec2> waypoints) : waypoints_{std::move(waypoints)} {}
  [[nodiscard]] controller::LapRequest wants_lap() const noexcept override {
    return {.is_wanted = is_wanted, .waypoints = waypoints_, .terms = terms};
  }
  [[nodiscard]] double beside(const road::RacingRoad& /*lap*/) const noexcept override { return offset; }

  bool is_wanted = true;
  road::LapTerms terms{};
  double offset = 0.0;  ///< from any lap [m]

 private:
  std::vector<Vec2> waypoints_;
};

std::vector<Vec2> circle(double radius) { return test::circle_points(radius, 40); }

std::shared_ptr<const road::RacingRoad> wait_for_lap(LapPlanner& planner, const Learner& learner) {
  for (int i = 0; i < 12000; ++i) {
    if (auto lap = planner.follow(learner, race_by_waypoints(), nullptr, 0.0)) return lap;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return {};
}

TEST(LapPlanner, PlansInVirtualTimeAsLateAsAPlanTakes) {
  const Learner learner(circle(70.0));
  const scenario::Scenario race = race_by_waypoints();
  LapPlanner planner(LapPlanner::Clock::kVirtual);
  for (double time = 3.0; time < 3.0 + LapPlanner::kPlanningTime; time += 0.04)
    EXPECT_EQ(planner.follow(learner, race, nullptr, time), nullptr) << time;
  const auto lap = test::good(planner.follow(learner, race, nullptr, 3.0 + LapPlanner::kPlanningTime));
  EXPECT_TRUE(lap->is_learned());
  EXPECT_NEAR(lap->line().length(), kTwoPi * 70.0, kTwoPi * 4.0);
  EXPECT_EQ(planner.follow(learner, race, nullptr, 20.0), nullptr) << "once";
}

/// A second lap, taken up a metre beside it before a bend, spun `vw-vanagon` on speedway.
TEST(LapPlanner, WaitsUntilTheCarIsNearTheLap) {
  Learner learner(circle(70.0));
  const scenario::Scenario race = race_by_waypoints();
  const auto taken_up = [&](double offset, double later) {
    learner.offset = offset;
    LapPlanner planner(LapPlanner::Clock::kVirtual);
    static_cast<void>(planner.follow(learner, race, nullptr, 0.0));
    for (double time = LapPlanner::kPlanningTime; time < 200.0; time += 0.5) {
      if (time > LapPlanner::kPlanningTime + later) learner.offset = 0.0;
      if (planner.follow(learner, race, nullptr, time)) return time - LapPlanner::kPlanningTime;
    }
    return 200.0;
  };
  EXPECT_EQ(taken_up(0.9 * LapPlanner::kJoining, 100.0), 0.0) << "near enough";
  EXPECT_NEAR(taken_up(1.0, 3.0), 3.0, 0.6) << "as soon as it is near";
  EXPECT_NEAR(taken_up(1.0, 100.0), (1.0 - LapPlanner::kJoining) / LapPlanner::kJoiningGrows, 0.6)
      << "not for ever";
}

TEST(LapPlanner, PlansTheSameBesideARun) {
  const std::vector<Vec2> points = circle(70.0);
  Learner learner(points);
  LapPlanner planner(LapPlanner::Clock::kReal);
  const auto lap = test::good(wait_for_lap(planner, learner));
  const auto again = plan_wanted_lap(race_by_waypoints(), nullptr, learner.wants_lap()).value();
  for (double s = 0.0; s < lap->line().length(); s += 7.0) {
    EXPECT_EQ(lap->line().at(s).position, again->line().at(s).position);
    EXPECT_EQ(lap->line().demand(s).speed, again->line().demand(s).speed);
  }
  learner.is_wanted = false;
  EXPECT_EQ(planner.follow(learner, race_by_waypoints(), nullptr, 1.0), nullptr);
  learner.is_wanted = true;
  EXPECT_NE(wait_for_lap(planner, learner), nullptr) << "after a reset it plans anew";
}

TEST(LapPlanner, PlansOnTheTrackWithTheGripThatIsWanted) {
  Learner learner({});
  const scenario::Scenario race = race_by_waypoints("road-car");
  const road::Track oval = make_track(race).value();
  const auto least_speed = [&](double grip) {
    learner.terms.grip = grip;
    LapPlanner planner(LapPlanner::Clock::kVirtual);
    static_cast<void>(planner.follow(learner, race, &oval, 0.0));
    const auto lap = planner.follow(learner, race, &oval, 10.0);
    EXPECT_EQ(lap->terms().grip, grip);
    EXPECT_FALSE(lap->is_learned());
    EXPECT_EQ(LapPlanner::lap_change(*lap, 7, 1.0).value.view(), grip == 1.0 ? "1" : "0.8");
    double slowest = 100.0;
    for (double s = 0.0; s < lap->line().length(); s += 2.0)
      slowest = std::min(slowest, lap->line().demand(s).speed);
    return slowest;
  };
  EXPECT_LT(least_speed(0.8), 0.97 * least_speed(1.0));
  LapPlanner planner(LapPlanner::Clock::kVirtual);
  static_cast<void>(planner.follow(learner, race, nullptr, 0.0));
  EXPECT_EQ(planner.follow(learner, race, nullptr, 10.0), nullptr) << "no track is known";
}

// Recordings hold what was wanted, so that a replay plans the same lap.
TEST(LapPlanner, TellsOfALapThatSlides) {
  Learner learner({});
  learner.terms = {.grip = 0.97, .slides = true, .slip = 0.9};
  const scenario::Scenario race = race_by_waypoints();
  const road::Track oval = make_track(race).value();
  LapPlanner planner(LapPlanner::Clock::kVirtual);
  static_cast<void>(planner.follow(learner, race, &oval, 0.0));
  const auto lap = test::good(planner.follow(learner, race, &oval, 10.0));
  EXPECT_TRUE(lap->terms().slides);
  EXPECT_GT(lap->slips().rear, 1.0);
  const telemetry::Change change = LapPlanner::lap_change(*lap, 7, 1.0);
  EXPECT_EQ(change.value.view(), "0.97, slip 0.9, slides");
  const Result<Setting> read = test::good(read_setting(change));
  EXPECT_EQ(std::get<LearnedLap>(read->action), learner.terms);
  EXPECT_FALSE(read_setting({.name = LapPlanner::kChange, .value = "0.97, slip 0"}));
}

TEST(LapPlanner, HasNoneWhereTheRoadHasNone) {
  const Learner learner(circle(2.0));  // tighter than the car can turn
  LapPlanner planner(LapPlanner::Clock::kVirtual);
  for (double time = 0.0; time < 20.0; time += 1.0)
    EXPECT_EQ(planner.follow(learner, race_by_waypoints(), nullptr, time), nullptr);
}

TEST(LapPlanner, IsAskedByARunThatKnowsWaypointsOnly) {
  const auto loop = ClosedLoop::create(race_by_waypoints()).value();
  std::vector<telemetry::Change> changes;
  const telemetry::RunSummary run = run_closed_loop(
      *loop, {.on_change = [&](const telemetry::Change& change) { changes.push_back(change); }});
  EXPECT_TRUE(run.completed) << run.end_reason;
  EXPECT_EQ(run.off_track_events, 0);
  ASSERT_FALSE(changes.empty());  // the first plan, and others as the grip is found
  for (const telemetry::Change& change : changes) EXPECT_EQ(change.name.view(), LapPlanner::kChange);
  EXPECT_GT(changes[0].time, run.laps[0].lap_time);
  EXPECT_LT(changes[0].time, run.laps[0].lap_time + 15.0);
}

}  // namespace
}  // namespace chicane::run
