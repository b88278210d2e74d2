// SPDX-License-Identifier: MIT
#include "chicane/ros/node_clock.hpp"
#include "support/chicane_test.hpp"

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

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kNow = 1'700'000'000'000 * kMs;

TEST(ClockWatch, AcceptsStampsThatRiseAsTimeDoes) {
  ClockWatch watch("/odom");
  for (int i = 0; i < 10; ++i)
    EXPECT_TRUE(watch.accept(kNow + i * 20 * kMs, i * 20 * kMs, kNow + i * 20 * kMs));
  EXPECT_EQ(watch.news(), "");
}

TEST(ClockWatch, LeavesOutWhatComesTwiceOrTooLate) {
  ClockWatch watch("/odom");
  EXPECT_TRUE(watch.accept(kNow, 0, kNow));
  EXPECT_TRUE(watch.accept(kNow + 40 * kMs, 40 * kMs, kNow));
  EXPECT_FALSE(watch.accept(kNow + 40 * kMs, 41 * kMs, kNow));
  EXPECT_EQ(watch.news(), "a message of /odom came twice: such messages are left out");
  EXPECT_FALSE(watch.accept(kNow + 20 * kMs, 42 * kMs, kNow));
  EXPECT_EQ(watch.news(), "");  // once is enough
}

TEST(ClockWatch, SaysThatTheClockJumpedAndGoesOn) {
  ClockWatch watch("/odom");
  EXPECT_TRUE(watch.accept(kNow, 0, kNow));
  EXPECT_TRUE(watch.accept(kNow + 20 * kMs + 5000 * kMs, 20 * kMs, kNow));
  EXPECT_EQ(watch.news(), "the clock of /odom jumped by +5.0 s");
  EXPECT_TRUE(watch.accept(kNow + 40 * kMs, 40 * kMs, kNow));
  EXPECT_EQ(watch.news(), "the clock of /odom jumped by -5.0 s");
  EXPECT_TRUE(watch.accept(kNow + 60 * kMs, 60 * kMs, kNow));
  EXPECT_EQ(watch.news(), "");
}

TEST(ClockWatch, KnowsWhenALateMessageWasStamped) {
  ClockWatch watch("/odom");
  ASSERT_TRUE(watch.accept(kNow, 5 * kMs, kNow));
  EXPECT_EQ(watch.moment(), 5 * kMs);
  ASSERT_TRUE(watch.accept(kNow + 20 * kMs, 22 * kMs, kNow));  // quicker than the first
  EXPECT_EQ(watch.moment(), 22 * kMs);
  ASSERT_TRUE(watch.accept(kNow + 40 * kMs, 72 * kMs, kNow));  // it waited for 30 ms
  EXPECT_NEAR(static_cast<double>(watch.moment()), 42.0 * kMs, 0.1 * kMs);
  ASSERT_TRUE(watch.accept(kNow + 60 * kMs, 260 * kMs, kNow));  // so late is another clock
  EXPECT_EQ(watch.moment(), 260 * kMs);
}

TEST(ClockWatch, KnowsSimulatedTime) {
  ClockWatch watch("/odom");
  EXPECT_TRUE(watch.accept(12 * kMs, 0, kNow));
  EXPECT_NE(watch.news().find("simulated time"), std::string::npos);
}

}  // namespace
}  // namespace chicane::ros
