// SPDX-License-Identifier: MIT
#include "chicane/run/roads.hpp"

#include <gtest/gtest.h>

#include "chicane/protocol/library.hpp"
#include "chicane/run/closed_loop.hpp"

namespace chicane::run {
namespace {

scenario::Scenario scenario_of(const std::string& track, const std::string& guard,
                               const std::string& car = "udacity") {
  return protocol::compose(
             {"",
              {{"track", track}, {"guard.mode", guard}, {"car", car}, {"laps", "0"}, {"time_limit_s", "4"}}})
      .value();
}

TEST(Roads, AreMadeOnceForEachTrackGuardAndCar) {
  Roads roads;
  const auto* first = roads.of(scenario_of("oval", "on")).value();
  EXPECT_EQ(roads.of(scenario_of("oval", "on")).value(), first);
  EXPECT_NE(roads.of(scenario_of("oval", "off")).value(), first);
  EXPECT_NE(roads.of(scenario_of("oval", "on", "road-car")).value(), first);
  EXPECT_EQ(roads.of(scenario_of("hairpins", "on")).value()->track.name(), "hairpins");
  EXPECT_FALSE(roads.of([] {
    scenario::Scenario lost = scenario_of("oval", "on");
    lost.track = "nowhere";
    return lost;
  }()));
}

TEST(Roads, ChangeNothingInARun) {
  Roads roads;
  for (const char* guard : {"on", "off"}) {
    const scenario::Scenario scenario = scenario_of("oval", guard);
    const auto alone = ClosedLoop::create(scenario);
    const std::uint64_t expected = run_closed_loop(**alone).state_hash;
    for (int i = 0; i < 2; ++i) {
      const auto loop = ClosedLoop::create(scenario, roads);
      EXPECT_EQ(run_closed_loop(**loop).state_hash, expected) << guard;
    }
  }
}

}  // namespace
}  // namespace chicane::run
