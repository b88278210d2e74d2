// SPDX-License-Identifier: MIT
#include "chicane/sim/sensor.hpp"
#include "support/chicane_test.hpp"

namespace chicane::sim {
namespace {

model::Command command(double throttle) { return {.steer = -throttle, .throttle = throttle}; }

TEST(ActuationDelay, HoldsTheFirstCommandUntilTheNextIsDue) {
  ActuationDelay delay;
  delay.reset(command(0.1));
  delay.push(0.25, command(0.2));
  EXPECT_EQ(delay.at(0.0).throttle, 0.1);
  EXPECT_EQ(delay.at(0.2499).throttle, 0.1);
  EXPECT_EQ(delay.at(0.25).throttle, 0.2);
  EXPECT_EQ(delay.at(9.0).throttle, 0.2);
}

TEST(ActuationDelay, ActsAtTheFirstStepThatBeginsNotBeforeTheCommandIsDue) {
  // A delay of 37 ms on a plant with 20 ms steps: sent at 0.1 s, due at 0.137, acts from the step at 0.14 s
  // on.
  ActuationDelay delay;
  delay.reset(command(0.0));
  delay.push(0.1 + 0.037, command(1.0));
  int acting = -1;
  for (int step = 0; step < 20; ++step) {
    if (delay.at(step * 0.02).throttle == 1.0 && acting < 0) acting = step;
  }
  EXPECT_EQ(acting, 7);
}

TEST(ActuationDelay, TakesSumsOfStepsAsDueInSpiteOfRounding) {
  ActuationDelay delay;
  delay.reset(command(0.0));
  delay.push(0.1 + 0.2, command(1.0));  // 0.30000000000000004
  EXPECT_EQ(delay.at(0.3).throttle, 1.0);
}

TEST(ActuationDelay, ShowsOnlyTheNewestOfThoseDue) {
  ActuationDelay delay;
  delay.reset(command(0.0));
  delay.push(0.10, command(0.1));
  delay.push(0.11, command(0.2));
  delay.push(0.30, command(0.3));
  EXPECT_EQ(delay.at(0.2).throttle, 0.2);
  EXPECT_EQ(delay.at(0.3).throttle, 0.3);
}

TEST(ActuationDelay, KeepsTheOrderOfSendingWhenTimesDecrease) {
  ActuationDelay delay;
  delay.reset(command(0.0));
  delay.push(0.3, command(0.1));
  delay.push(0.2, command(0.2));  // a faster answer cannot overtake
  EXPECT_EQ(delay.at(0.25).throttle, 0.0);
  EXPECT_EQ(delay.at(0.3).throttle, 0.2);
}

TEST(ActuationDelay, DropsTheOldestWaitingWhenFull) {
  ActuationDelay delay;
  delay.reset(command(0.0));
  for (int i = 1; i <= 200; ++i) delay.push(i, command(i / 1000.0));
  EXPECT_EQ(delay.at(72.0).throttle, 0.0);  // 1 … 72 were dropped
  EXPECT_EQ(delay.at(73.0).throttle, 0.073);
  EXPECT_EQ(delay.at(200.0).throttle, 0.2);
}

TEST(RandomDelay, IsEvenlyDistributedAndDependsOnSeedAndTimeOnly) {
  constexpr int kCount = 10000;
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double late = random_delay(1, 0.04 * i, 0.06);
    ASSERT_GE(late, 0.0);
    ASSERT_LT(late, 0.06);
    sum += late;
    squares += late * late;
  }
  EXPECT_NEAR(sum / kCount, 0.03, 0.0006);
  EXPECT_NEAR(squares / kCount, 0.06 * 0.06 / 3.0, 3e-5);
  EXPECT_EQ(random_delay(1, 0.4, 0.06), random_delay(1, 0.4, 0.06));
  EXPECT_NE(random_delay(1, 0.4, 0.06), random_delay(2, 0.4, 0.06));
  EXPECT_EQ(random_delay(1, 0.4, 0.0), 0.0);
}

}  // namespace
}  // namespace chicane::sim
