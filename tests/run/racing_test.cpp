// SPDX-License-Identifier: MIT
#include "chicane/run/racing.hpp"

#include "chicane/run/make.hpp"
#include "support/chicane_test.hpp"
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

}  // namespace
}  // namespace chicane::run
