// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <string>

#include "chicane/lap_time/minimum_time.hpp"
#include "chicane/run/make.hpp"
#include "closed_loop/drive.hpp"

namespace chicane::run {
namespace {

struct Race {
  const char* car;
  const char* track;
  double most_gap;  ///< to the quick limit: measured (docs/racing.md), and a half more
};

constexpr Race kRaces[] = {{"udacity", "lakeside", 0.01},  {"udacity", "oval", 0.01},
                           {"udacity", "hairpins", 0.035}, {"udacity", "speedway", 0.01},
                           {"road-car", "lakeside", 0.04}, {"road-car", "oval", 0.045},
                           {"road-car", "hairpins", 0.06}};

TEST(Race, LapsCleanlyNearTheLimit) {
  for (const Race& race : kRaces) {
    const Settings settings{{"preset", "race"}, {"car", race.car}, {"track", race.track}, {"laps", "3"}};
    const auto run = drive(settings);
    ASSERT_TRUE(run.completed) << race.car << ' ' << race.track << ": " << run.end_reason;
    EXPECT_EQ(run.off_track_events, 0) << race.car << ' ' << race.track;
    for (const telemetry::LapSummary& lap : run.laps)
      EXPECT_GT(lap.min_edge_distance, 0.0) << race.car << ' ' << race.track;
    const auto scenario = protocol::compose({.scenario_file = {}, .settings = settings});
    const auto limit = lap_time::find_limit(make_track(*scenario).value(), scenario->vehicle);
    ASSERT_TRUE(limit);
    EXPECT_LT(run.laps.back().lap_time, (1.0 + race.most_gap) * limit->times.lap)
        << race.car << ' ' << race.track;
  }
}

TEST(Race, IsFasterThanTheDefault) {
  for (const char* car : {"udacity", "road-car"}) {
    const auto lap = [&](const char* preset) {
      return drive({{"preset", preset}, {"car", car}, {"track", "hairpins"}, {"laps", "2"}})
          .laps.back()
          .lap_time;
    };
    EXPECT_LT(lap("race"), 0.9 * lap("default")) << car;
  }
}

TEST(Race, IsRefusedWhereThereIsNoLap) {
  const auto scenario = protocol::compose(
      {.scenario_file = {},
       .settings = {{"preset", "race"}, {"car", "road-car"}, {"vehicle.track_width_m", "9.4"}}});
  ASSERT_TRUE(scenario);
  const auto loop = ClosedLoop::create(*scenario);
  ASSERT_FALSE(loop);
  EXPECT_NE(loop.error().message.find("the road is"), std::string::npos) << loop.error().message;
}

}  // namespace
}  // namespace chicane::run
