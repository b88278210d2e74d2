// SPDX-License-Identifier: MIT

#include "chicane/live/live_settings.hpp"
#include "chicane/protocol/schema.hpp"
#include "live/settings_of_a_run.hpp"
#include "support/chicane_test.hpp"

namespace chicane::live {
namespace {

using protocol::foxglove::ParameterValue;
using test::another_value;
using test::Live;
using test::scenario_of;

TEST(FixedSettings, KeepTheGuardAndItsModelOutOfReach) {
  EXPECT_EQ(Live().refusal({"guard.mode", std::string("off")}),
            "guard.mode is fixed when the run starts; set it on the command line: --set guard.mode=off");
  EXPECT_EQ(Live().refusal({"vehicle.friction", 2.5}),
            "vehicle.friction is fixed when the run starts; set it on the command line: --set "
            "vehicle.friction=2.5");
  EXPECT_EQ(Live().refusal({"guard.mode", std::string("no")}),
            "guard.mode: got no, expected one of on, observe, off");
  const scenario::Scenario plain = scenario_of({});
  for (const protocol::Parameter& row : protocol::list()) {
    if (row.group != "guard" && row.group != "vehicle") continue;
    Live live;
    const ParameterValue before = live.value(row.key);
    EXPECT_THAT(live.refusal({std::string(row.key), another_value(row, plain)}),
                HasSubstr(" is fixed when the run starts; set it on the command line: --set "));
    EXPECT_EQ(live.value(row.key), before) << row.key;
    EXPECT_TRUE(live.started.empty()) << row.key;
    EXPECT_TRUE(live.settings.set({std::string(row.key), before})) << "the value that holds";
  }
}

TEST(FixedSettings, LeaveTheSimulatedWorldToViewers) {
  Live live;
  EXPECT_TRUE(live.settings.set({"plant_options.friction_scale", 0.8}));
  EXPECT_TRUE(live.settings.set({"plant_options.mass_scale", 1.1}));
}

TEST(FixedSettings, KeepTheGuardAndTheModelOfTheCommandLineWhateverPresetOrCarIsChosen) {
  const scenario::Scenario given =
      scenario_of({{"guard.mode", "observe"}, {"guard.margin_m", "0.7"}, {"vehicle.friction", "0.6"}});
  Live live(given);
  for (const auto& [key, value] : std::vector<std::pair<std::string, std::string>>{
           {"preset", "race"}, {"car", "road-car"}, {"preset", "weighted"}, {"car", "udacity"}}) {
    SCOPED_TRACE(key + " = " + value);
    ASSERT_TRUE(live.settings.set({key, value}));
    live.end_of_build();
    while (live.requests.front() != nullptr) live.next();
    EXPECT_EQ(live.settings.scenario().guard, given.guard);
    EXPECT_EQ(live.settings.scenario().vehicle.friction,
              live.settings.scenario().car == "udacity"
                  ? 0.6
                  : scenario_of({{"car", "road-car"}}).vehicle.friction);
  }
}

}  // namespace
}  // namespace chicane::live
