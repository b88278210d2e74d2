// SPDX-License-Identifier: MIT
#include "chicane/run/racing.hpp"

#include <gtest/gtest.h>

#include "chicane/protocol/library.hpp"
#include "chicane/run/make.hpp"

namespace chicane::run {
namespace {

scenario::Scenario race_on(const char* track, const char* margin = "0.3") {
  return protocol::compose(
             {.scenario_file = {},
              .settings = {{"preset", "race"}, {"track", track}, {"tracking_mpc.edge_margin_m", margin}}})
      .value();
}

TEST(PlanLap, IsForThoseWhoRaceOnAKnownRoad) {
  const scenario::Scenario race = race_on("oval");
  const road::Track track = make_track(race).value();
  EXPECT_TRUE(races(race));
  EXPECT_EQ(plan_lap(race, nullptr).value(), nullptr) << "no road is known";
  const scenario::Scenario other = protocol::compose({.scenario_file = {}, .settings = {}}).value();
  EXPECT_FALSE(races(other));
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

}  // namespace
}  // namespace chicane::run
