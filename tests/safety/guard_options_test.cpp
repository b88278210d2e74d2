// SPDX-License-Identifier: MIT
#include "chicane/safety/guard_options.hpp"

#include <gtest/gtest.h>

namespace chicane::safety {
namespace {

TEST(GuardOptions, AreOnUnlessSaidOtherwise) {
  const GuardOptions options;
  EXPECT_EQ(options.mode, GuardMode::kOn);
  EXPECT_EQ(options.receiver, Receiver::kStopPlan);
  EXPECT_EQ(options.blind_time, 30.0);
}

TEST(GuardOptions, HaveTheirNamesInTheOrderOfTheEnumerations) {
  GuardOptions options;
  for (const Option& option : guard_options()) {
    if (option.kind != OptionKind::kChoice) continue;
    for (std::size_t i = 0; i < option.choices.size(); ++i) {
      option.write(&options, static_cast<double>(i));
      EXPECT_EQ(std::get<double>(option.read(&options)), static_cast<double>(i)) << option.name;
    }
  }
  EXPECT_EQ(options.mode, GuardMode::kOff);
  EXPECT_EQ(options.road, GuardRoad::kWaypoints);
  EXPECT_EQ(options.receiver, Receiver::kHold);
  EXPECT_EQ(guard_options()[0].choices[static_cast<std::size_t>(GuardMode::kObserve)], "observe");
  EXPECT_EQ(guard_options()[1].choices[static_cast<std::size_t>(GuardRoad::kWaypoints)], "waypoints");
  EXPECT_EQ(guard_options()[3].choices[static_cast<std::size_t>(Receiver::kStopPlan)], "stop-plan");
}

}  // namespace
}  // namespace chicane::safety
