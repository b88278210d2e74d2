// SPDX-License-Identifier: MIT
#include "chicane/tracking/state_estimator.hpp"
#include "support/chicane_test.hpp"

namespace chicane::tracking {
namespace {

TEST(CommandHistory, HoldsEachCommandUntilTheNextActs) {
  CommandHistory sent;
  EXPECT_EQ(sent.at(1.0).steer, 0.0);
  sent.add(1.0, {.steer = 0.1, .throttle = 0.2});
  sent.add(1.5, {.steer = 0.3, .throttle = 0.4});
  EXPECT_EQ(sent.at(0.99).steer, 0.0);
  EXPECT_EQ(sent.at(1.0).steer, 0.1);
  EXPECT_EQ(sent.at(1.49).steer, 0.1);
  EXPECT_EQ(sent.at(9.0).steer, 0.3);
  EXPECT_EQ(sent.next_change(1.0, 2.0), 1.5);
  EXPECT_EQ(sent.next_change(1.5, 2.0), 2.0);
}

TEST(CommandHistory, ALaterCommandReplacesThoseThatWouldActAfterIt) {
  CommandHistory sent;
  sent.add(1.0, {.steer = 0.1});
  sent.add(2.0, {.steer = 0.2});
  sent.add(1.5, {.steer = 0.3});  // the delay got shorter
  EXPECT_EQ(sent.at(3.0).steer, 0.3);
  EXPECT_EQ(sent.at(1.2).steer, 0.1);
}

TEST(CommandHistory, ForgetsTheOldestWhenFull) {
  CommandHistory sent;
  for (int i = 0; i < 500; ++i) sent.add(0.1 * i, {.steer = 0.001 * i});
  EXPECT_DOUBLE_EQ(sent.at(49.95).steer, 0.499);
  EXPECT_EQ(sent.at(0.0).steer, 0.0);
}

}  // namespace
}  // namespace chicane::tracking
