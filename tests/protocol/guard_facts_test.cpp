// SPDX-License-Identifier: MIT
#include "chicane/protocol/json_report.hpp"

#include <gtest/gtest.h>

namespace chicane::protocol {
namespace {

TEST(GuardFacts, NameModeRoadAndVersion) {
  const GuardFacts on = guard_facts({});
  EXPECT_EQ(on, (GuardFacts{.mode = "on", .road = "track", .version = safety::kGuardVersion}));
  EXPECT_GE(on.version, 2) << "1: the guard of runs that name no version";
  const GuardFacts off =
      guard_facts({.mode = safety::GuardMode::kOff, .road = safety::GuardRoad::kWaypoints});
  EXPECT_EQ(off.mode, "off");
  EXPECT_EQ(off.road, "waypoints");
}

}  // namespace
}  // namespace chicane::protocol
