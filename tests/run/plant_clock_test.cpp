// SPDX-License-Identifier: MIT
#include "chicane/run/plant_clock.hpp"

#include "chicane/base/random.hpp"
#include "chicane/model/vehicle.hpp"
#include "support/chicane_test.hpp"

namespace chicane::run {
namespace {

/// A car that starts along x and goes on at 20 m/s, its program's messages and a virtual clock of the wall.
class PlantClockTest : public testing::Test {
 protected:
  static PlantClock::Clock::time_point wall(double time) {
    return PlantClock::Clock::time_point(
        std::chrono::nanoseconds(static_cast<std::int64_t>(std::llround(1e9 * time))));
  }
  PlantClock estimated() { return PlantClock({.is_estimated = true}, car_, wall(0.0)); }

  /// The simulator advances by `plant` [s] while the wall's clock does by `waited`. True: another clock.
  bool advance(PlantClock& clock, double waited, double plant, double speed_scale = 1.0, double noise = 0.0) {
    const double throttle = v_ < 20.0 ? 1.0 : 0.0;
    const double drive = throttle > 0.0 ? longitudinal_acceleration(car_, throttle, v_) : 0.0;
    x_ += plant * (v_ + 0.5 * plant * drive);
    v_ += plant * drive;
    wall_ += waited;
    plant_ += plant;
    const model::Measurement measured{.x = x_ + noise * chance_.normal(), .speed = speed_scale * v_};
    return clock.advance(wall(wall_), &measured, {0.0, throttle});
  }

  model::VehicleParams car_;
  Random chance_{3};
  double x_ = 0.0, v_ = 0.0;
  double wall_ = 0.0, plant_ = 0.0;  ///< [s]
};

TEST_F(PlantClockTest, CountsByTheRatioOfASimulatorThatIsSlowOrFast) {
  for (const double ratio : {0.2, 0.5, 0.8, 1.25, 2.0, 5.0}) {
    x_ = v_ = wall_ = plant_ = 0.0;
    PlantClock clock = estimated();
    int changes = 0;
    double driven = 0.0;
    for (int i = 0; i < 60 + 60.0 / ratio; ++i) {
      if (advance(clock, 0.12, 0.12 * ratio) && ++changes == 1) driven = x_;
    }
    EXPECT_EQ(changes, 1) << ratio;
    EXPECT_LT(driven, 30.0 * std::max(ratio, 1.0)) << ratio;
    EXPECT_NEAR(clock.ratio(), ratio, 0.01 * ratio);
    const double before = clock.at(wall(wall_));
    advance(clock, 0.12, 0.12 * ratio);
    EXPECT_NEAR(clock.at(wall(wall_)) - before, 0.12 * ratio, 0.002 * ratio);
    EXPECT_THAT(clock.news(), HasSubstr(" of the wall's: counted by it"));
  }
}

TEST_F(PlantClockTest, FindsAFastClockByOneStepFromRest) {
  PlantClock clock = estimated();
  advance(clock, 0.12, 0.0);
  EXPECT_TRUE(advance(clock, 0.12, 0.6));
  EXPECT_NEAR(clock.ratio(), 5.0, 0.01);
  EXPECT_FALSE(clock.is_settled());
  for (int i = 0; i < 8; ++i) EXPECT_FALSE(advance(clock, 0.12, 0.6));
  EXPECT_TRUE(clock.is_settled());
}

TEST_F(PlantClockTest, TakesOneLateMessageBeforeTheStartForNoFastClock) {
  for (const double late : {0.15, 0.3, 0.6}) {
    x_ = v_ = wall_ = plant_ = 0.0;
    PlantClock clock = estimated();
    advance(clock, 0.12, 0.0);
    advance(clock, 0.12 + late, 0.0);
    EXPECT_FALSE(advance(clock, 0.12, 0.12 + late)) << late;
    for (int i = 0; i < 100; ++i) EXPECT_FALSE(advance(clock, 0.12, 0.12)) << late;
  }
}

TEST_F(PlantClockTest, CountsByTheWallWhateverAMachineDelaysAndASensorErrs) {
  for (const bool is_noisy : {false, true}) {
    PlantClock clock = estimated();
    for (int i = 0; i < 2000; ++i) {
      const double cycle = i % 40 == 39 ? 0.42 : 0.12 * chance_.uniform(0.7, 1.3);
      EXPECT_FALSE(advance(clock, cycle, cycle, 1.0, is_noisy ? 0.15 : 0.0));
    }
    EXPECT_EQ(clock.ratio(), 1.0);
    EXPECT_NEAR(clock.at(wall(wall_)), wall_, 0.0201) << "a physics step, and no drift";
  }
}

TEST_F(PlantClockTest, TakesStepsThatAreAlikeInRealTimeForNoLockStep) {
  PlantClock clock = estimated();
  double late = 0.0;
  for (int i = 0; i < 2000;
       ++i) {  // messages of a simulator in real time, of which a busy machine delays each
    const double before = std::exchange(late, chance_.uniform(0.0, 0.1));
    EXPECT_FALSE(advance(clock, 0.12 + late - before, 0.12));
  }
  EXPECT_EQ(clock.lock_step(), 0.0);
  EXPECT_EQ(clock.ratio(), 1.0);
}

TEST_F(PlantClockTest, FindsLockStepByItsTimeThatDoesNotDependOnTheWalls) {
  PlantClock clock = estimated();
  for (int i = 0; i < 200; ++i) {
    const double cycle = i % 10 == 9 ? 0.4 : 0.1 * chance_.uniform(0.7, 1.3);
    advance(clock, cycle, 0.05);
  }
  EXPECT_NEAR(clock.lock_step(), 0.05, 0.001);
  EXPECT_NEAR(clock.delay(0.1), 0.05, 0.001);
  EXPECT_THAT(clock.news(), HasSubstr("the simulator advances 0.05 s with each answer"));
  const double before = clock.at(wall(wall_));
  advance(clock, 2.0, 0.05);
  EXPECT_NEAR(clock.at(wall(wall_)) - before, 0.05, 0.001);
}

TEST_F(PlantClockTest, CountsAStepThatHadToWaitByItsDisplacement) {
  PlantClock clock = estimated();
  for (int i = 0; i < 60; ++i) advance(clock, 0.12, 0.12);
  const double before = clock.at(wall(wall_));
  advance(clock, 0.5, 0.12);
  EXPECT_NEAR(clock.at(wall(wall_)) - before, 0.12, 0.002);
}

TEST_F(PlantClockTest, FollowsAClockThatChanges) {
  PlantClock clock = estimated();
  for (int i = 0; i < 60; ++i) EXPECT_FALSE(advance(clock, 0.12, 0.12));
  int changes = 0;
  for (int i = 0; i < 20; ++i) changes += advance(clock, 0.12, 0.06) ? 1 : 0;
  EXPECT_EQ(changes, 1);
  EXPECT_NEAR(clock.ratio(), 0.5, 0.01);
  for (int i = 0; i < 20; ++i) changes += advance(clock, 0.12, 0.12) ? 1 : 0;
  EXPECT_EQ(changes, 2);
  EXPECT_EQ(clock.ratio(), 1.0);
}

TEST_F(PlantClockTest, TakesNoSpeedInAnotherUnitForAClock) {
  for (const double scale : {0.447, 0.5, 0.62, 1.61, 2.24, 3.6}) {
    x_ = v_ = wall_ = 0.0;
    PlantClock clock = estimated();
    for (int i = 0; i < 100; ++i) EXPECT_FALSE(advance(clock, 0.12, 0.12, scale)) << scale;
    EXPECT_EQ(clock.ratio(), 1.0);
  }
  x_ = v_ = wall_ = 0.0;
  PlantClock clock = estimated();
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(advance(clock, 0.12, 0.12, i < 50 ? 1.0 : 0.5)) << i;
}

TEST_F(PlantClockTest, CountsByTheTimeThatASimulatorTells) {
  PlantClock clock({.is_measured = true}, car_, wall(0.0));
  model::Measurement told{.time = 1234.5};
  double waited = 0.0;
  for (int i = 0; i < 100; ++i) {
    told.time += 0.05;
    EXPECT_FALSE(clock.advance(wall(waited += chance_.uniform(0.0, 1.0)), i % 10 == 5 ? nullptr : &told, {}));
  }
  EXPECT_NEAR(clock.at(wall(waited)), 99 * 0.05, 1e-9);
  EXPECT_NEAR(clock.at(wall(waited + 10.0)), 100 * 0.05, 1e-6) << "no more until the next answer";
  EXPECT_NEAR(clock.delay(0.3), 0.05, 0.001);
  told.time = 0.0;
  EXPECT_TRUE(clock.advance(wall(waited), &told, {})) << "it began again";
  EXPECT_THAT(clock.news(), HasSubstr("time jumped"));
  EXPECT_NEAR(clock.at(wall(waited)), 100 * 0.05, 1e-6) << "the run's time goes on";
}

TEST_F(PlantClockTest, ASilenceOfASimulatorIsNoStep) {
  PlantClock clock({.is_measured = true}, car_, wall(0.0));
  model::Measurement now{.time = 10.0};
  const auto answer = [&](double step, bool is_usable = true) {
    now.time += step;
    return clock.advance(wall(0.0), is_usable ? &now : nullptr, {});
  };
  EXPECT_FALSE(answer(0.0));
  EXPECT_FALSE(answer(3.0)) << "it was paused";
  EXPECT_FALSE(answer(0.05));
  EXPECT_NEAR(clock.delay(0.3), 0.05, 1e-9);
  EXPECT_FALSE(answer(2.0));
  EXPECT_FALSE(answer(0.05, false)) << "an unusable message after a stall";
  EXPECT_FALSE(answer(0.05)) << "its time has not gone back";
  EXPECT_NEAR(clock.delay(0.3), 0.05, 1e-6);
  EXPECT_TRUE(answer(100.0)) << "another moment";
}

TEST_F(PlantClockTest, ATimeThatIsGivenIsNotEstimated) {
  PlantClock by_arrival({}, car_, wall(0.0));
  PlantClock in_step({.is_estimated = true, .lock_step = 0.05}, car_, wall(0.0));
  for (int i = 0; i < 60; ++i) {
    const double v = v_, x = x_;
    EXPECT_FALSE(advance(by_arrival, 0.12, 0.05));
    v_ = v;
    x_ = x;
    wall_ -= 0.12;
    EXPECT_FALSE(advance(in_step, 0.12, 0.05));
  }
  EXPECT_NEAR(by_arrival.at(wall(wall_)), 60 * 0.12, 1e-9);
  EXPECT_NEAR(in_step.at(wall(wall_)), 60 * 0.05, 1e-9);
}

}  // namespace
}  // namespace chicane::run
