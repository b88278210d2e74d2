// SPDX-License-Identifier: MIT
#include "chicane/safety/measurement_monitor.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace chicane::safety {
namespace {

constexpr double kCycle = 0.04;  // [s]

/// A car that drives at 20 m/s along x is then measured at 100 m aside, where `answer` moves it.
template <class Answer>
bool is_accepted(double pedal, double seconds, Answer answer) {
  ResetWatch watch;
  model::Measurement now;
  for (int i = 0; i < 20; ++i) {
    now.time = kCycle * i;
    now.x = 20.0 * now.time;
    now.speed = 20.0;
    watch.see(now, 0.0);
  }
  now.y = 100.0;
  now.speed = 0.0;
  for (double since = 0.0; since < seconds; since += kCycle) {
    now.time += kCycle;
    answer(now);
    watch.see(now, pedal);
    if (watch.has_answered()) return true;
  }
  return false;
}

/// Motion of a car from standstill at `acceleration` [m/s²].
auto driven(double acceleration) {
  return [acceleration, velocity = 0.0](model::Measurement& now) mutable {
    now.x += velocity * kCycle;
    velocity += acceleration * kCycle;
    now.speed = std::fabs(velocity);
  };
}

TEST(ResetWatch, AcceptsACarThatAnswers) {
  EXPECT_TRUE(is_accepted(0.3, 3.0, driven(1.0)));
  EXPECT_TRUE(is_accepted(-1.0, 3.0, driven(-5.0))) << "the brake pedal may be the reverse gear";
}

TEST(ResetWatch, RejectsAConstantPlace) {
  EXPECT_FALSE(is_accepted(0.3, 60.0, [](model::Measurement&) {}));
}

TEST(ResetWatch, RejectsAPlaceThatMovesWithoutSpeed) {
  EXPECT_FALSE(is_accepted(0.3, 60.0, [](model::Measurement& now) { now.x += 0.3 * kCycle; }));
}

TEST(ResetWatch, RejectsAMotionAgainstThePedal) {
  EXPECT_FALSE(is_accepted(0.3, 3.0, driven(-1.0)));
  EXPECT_FALSE(is_accepted(-1.0, 3.0, driven(5.0)));
  EXPECT_FALSE(is_accepted(0.0, 3.0, driven(1.0)));
}

TEST(ResetWatch, RejectsAMotionAcrossTheHeading) {
  EXPECT_FALSE(is_accepted(0.3, 3.0, [velocity = 0.0](model::Measurement& now) mutable {
    now.y += velocity * kCycle;
    velocity += kCycle;
    now.speed = velocity;
  }));
}

TEST(ResetWatch, DoesNotWaitForACarThatStillMovesElsewhere) {
  ResetWatch watch;
  model::Measurement now;
  now.speed = 20.0;
  watch.see(now, 0.3);
  now.time = kCycle;
  now.y = 50.0;
  watch.see(now, 0.3);
  EXPECT_FALSE(watch.is_waiting());
}

/// A localiser that jumps while the car drives says nothing of standstill: the car has to rest first.
TEST(ResetWatch, AsksACarThatRestsWhereItIsMeasured) {
  for (const bool answers : {true, false}) {
    ResetWatch watch;
    model::Measurement now{.x = 0.0, .speed = 10.0};
    watch.see(now, 0.0);
    now.x = 70.0;
    now.time += kCycle;
    watch.see(now, 0.0);
    EXPECT_TRUE(watch.has_jumped());
    EXPECT_FALSE(watch.is_waiting());
    EXPECT_FALSE(watch.rests());
    now.speed = 0.0;
    for (double since = 0.0; since < ResetWatch::kRest + 2 * kCycle; since += kCycle) {
      now.time += kCycle;
      watch.see(now, 0.0);
    }
    EXPECT_TRUE(watch.rests());
    watch.ask();
    auto moves = driven(1.0);
    bool has_answered = false;
    for (double since = 0.0; since < 3.0; since += kCycle) {
      now.time += kCycle;
      if (answers) moves(now);
      watch.see(now, 0.3);
      has_answered |= watch.has_answered();
    }
    EXPECT_EQ(has_answered, answers);
    EXPECT_EQ(watch.is_waiting(), !answers);
    watch.give_up();
    EXPECT_FALSE(watch.is_waiting());
    for (double since = 0.0; since < 2.0; since += kCycle) {
      now.time += kCycle;
      now.speed = 0.0;
      watch.see(now, 0.0);
    }
    EXPECT_EQ(watch.rests(), answers) << "a place that stayed the same is not tried again";
  }
}

TEST(ResetWatch, RejectsASpeedOfHalfTheWay) {
  auto halved = [moves = driven(1.0)](model::Measurement& now) mutable {
    now.speed *= 2.0;
    moves(now);
    now.speed *= 0.5;
  };
  EXPECT_FALSE(is_accepted(0.3, 1.5, halved));
}

}  // namespace
}  // namespace chicane::safety
