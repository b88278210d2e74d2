// SPDX-License-Identifier: MIT
#include "chicane/ros/node_clock.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <string>

namespace chicane::ros {
namespace {

using namespace std::chrono_literals;

TEST(NodeClock, StandsUntilTheClockTicksAndGoesAsItGoes) {
  NodeClock clock(true);
  const auto begin = clock.now();
  EXPECT_EQ(clock.now(), begin);
  EXPECT_EQ(clock.tick(5'000'000'000), "/clock is there: time is simulated");
  EXPECT_EQ(clock.now(), begin) << "the first tick says what time it is, not that it has passed";
  EXPECT_EQ(clock.tick(5'250'000'000), "");
  EXPECT_EQ(clock.now() - begin, 250ms);
  EXPECT_EQ(clock.stamp_now(), 5'250'000'000);
}

TEST(NodeClock, GoesOnWhereASimulationBeginsAnew) {
  NodeClock clock(true);
  const auto begin = clock.now();
  static_cast<void>(clock.tick(100'000'000'000));
  static_cast<void>(clock.tick(101'000'000'000));
  EXPECT_EQ(clock.tick(0), "/clock went back by 101.0 s: a simulation that began anew?");
  EXPECT_EQ(clock.now() - begin, 1s);
  static_cast<void>(clock.tick(500'000'000));
  EXPECT_EQ(clock.now() - begin, 1500ms);
}

TEST(NodeClock, IsThisMachinesWhereTimeIsNotSimulated) {
  NodeClock clock(false);
  EXPECT_EQ(clock.tick(7), "");
  const auto first = NodeClock::Clock::now();
  EXPECT_GE(clock.now(), first);
  EXPECT_GT(clock.stamp_now(), 1'600'000'000'000'000'000);
}

}  // namespace
}  // namespace chicane::ros
