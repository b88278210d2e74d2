// SPDX-License-Identifier: MIT
#include "chicane/run/account.hpp"

#include "chicane/base/math.hpp"
#include "support/chicane_test.hpp"

namespace chicane::run {
namespace {

constexpr double kLoopRadius = 60.0;
constexpr double kSpeed = 12.0;
constexpr double kLapTime = kTwoPi * kLoopRadius / kSpeed;
constexpr double kPeriod = 0.12;

/// A car that goes round a circle, `left` metres beside its line; `way` < 0: the other way round.
struct Car {
  double angle = 0.3;
  double time = 100.0;
  void drive(LapLearner& learner, double duration, double left = 0.0, double way = 1.0) {
    for (double end = time + duration; time < end; time += kPeriod) {
      const double radius = kLoopRadius - left;
      learner.see(
          time,
          {.x = radius * std::cos(angle), .y = radius * std::sin(angle), .psi = angle + way * kPi / 2.0},
          kSpeed);
      angle += way * kSpeed / kLoopRadius * kPeriod;
    }
  }
};

TEST(LapLearner, TimesLapsFromWhereTheCarWasFirstSeen) {
  LapLearner learner;
  Car car;
  car.drive(learner, 0.9 * kLapTime);
  EXPECT_EQ(learner.state().lap, 0);
  car.drive(learner, 0.2 * kLapTime);
  EXPECT_EQ(learner.state().lap, 1);
  // Between two sightings the car goes straight: 0.12 s on 60 m are 1e-4 of a lap.
  EXPECT_NEAR(learner.state().last_lap_time, kLapTime, 1e-3 * kLapTime);
  EXPECT_NEAR(learner.state().lap_time, 0.1 * kLapTime, 2.0 * kPeriod);
  car.drive(learner, kLapTime, 3.0);
  EXPECT_EQ(learner.state().lap, 2);
  EXPECT_NEAR(learner.state().best_lap_time, kLapTime, 1e-3 * kLapTime);
  EXPECT_TRUE(std::isnan(learner.state().last_sector_times[0])) << "of a road that nobody knows";
}

TEST(LapLearner, ACarThatGoesBackAndForthOverTheLineDrivesNoLap) {
  LapLearner learner;
  Car car;
  for (int i = 0; i < 10; ++i) {
    car.drive(learner, 0.1 * kLapTime);
    car.drive(learner, 0.2 * kLapTime, 0.0, -1.0);
    car.drive(learner, 0.1 * kLapTime);
  }
  EXPECT_EQ(learner.state().lap, 0);
}

TEST(LapLearner, AShortCutIsNoLapOnceALapIsKnown) {
  LapLearner learner;
  Car car;
  car.drive(learner, 1.05 * kLapTime);
  ASSERT_EQ(learner.state().lap, 1);
  for (double left = 0.0; left < 14.0; left += 1.0) car.drive(learner, kPeriod, left);
  car.drive(learner, 1.0 * kLapTime, 14.0);  // a smaller circle, 77 % of the lap
  EXPECT_EQ(learner.state().lap, 1);
  EXPECT_LT(learner.state().lap_time, 0.2 * kLapTime) << "the next one has begun";
}

TEST(LapLearner, ACarThatWasMovedBeginsAnew) {
  LapLearner learner;
  Car car;
  car.drive(learner, 0.5 * kLapTime);
  car.angle += kPi;
  car.drive(learner, 0.6 * kLapTime);
  EXPECT_EQ(learner.state().lap, 0);
  car.drive(learner, 0.5 * kLapTime);
  EXPECT_EQ(learner.state().lap, 1);
}

TEST(LapLearner, ForgetsWhenReset) {
  LapLearner learner;
  Car car;
  car.drive(learner, 0.7 * kLapTime);
  learner.reset();
  car.drive(learner, 0.7 * kLapTime);
  EXPECT_EQ(learner.state().lap, 0);
  EXPECT_NEAR(learner.state().lap_time, 0.7 * kLapTime, 2.0 * kPeriod);
}

// A figure of eight that is begun at its crossing: half a lap later another road leads over the start line.
TEST(LapLearner, CountsALapOfAFigureOfEightOnce) {
  for (const double height : {15.0, 25.0, 40.0, 60.0, 120.0}) {  // crosses at 33 to 135 degrees
    for (double begin = -0.03; begin <= 0.031; begin += 0.005) {
      LapLearner learner;
      const double step = 0.002;  // of a lap
      for (int i = 0; i <= 1100; ++i) {
        const double angle = kTwoPi * (begin + step * i);
        const double psi = std::atan2(2.0 * height * std::cos(2.0 * angle), 100.0 * std::cos(angle));
        learner.see(i * 0.1, {.x = 100.0 * std::sin(angle), .y = height * std::sin(2.0 * angle), .psi = psi},
                    25.0);
      }
      EXPECT_EQ(learner.state().lap, 2) << height << ' ' << begin;
      EXPECT_NEAR(learner.state().best_lap_time, 50.0, 0.05) << height << ' ' << begin;
    }
  }
}

}  // namespace
}  // namespace chicane::run
