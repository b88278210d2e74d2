// SPDX-License-Identifier: MIT
#include "chicane/run/laps_without.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "chicane/run/closed_loop.hpp"

namespace chicane::run {
namespace {

using testing::ElementsAre;

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
  const auto laps = laps_without(scenario);
  ASSERT_TRUE(laps) << laps.error().message;
  EXPECT_THAT(causes(*laps), ElementsAre("latency", "grip reserve", "guard"));
  scenario.latency = 0.0;
  scenario.guard.mode = safety::GuardMode::kOff;
  scenario.sensor.position_noise = 0.01;
  EXPECT_THAT(causes(*laps_without(scenario)), ElementsAre("sensor", "grip reserve"));
}

TEST(LapsWithout, AreThoseOfTheScenarioThatLacksTheCause) {
  const scenario::Scenario scenario = calm();
  const auto laps = laps_without(scenario);
  ASSERT_TRUE(laps) << laps.error().message;
  scenario::Scenario instant = scenario;
  instant.latency = 0.0;
  const auto loop = ClosedLoop::create(instant);
  ASSERT_TRUE(loop) << loop.error().message;
  const telemetry::RunSummary run = run_closed_loop(**loop);
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
