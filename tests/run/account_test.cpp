// SPDX-License-Identifier: MIT
#include "chicane/run/account.hpp"

#include "chicane/base/math.hpp"
#include "chicane/sim/plant_registry.hpp"
#include "support/chicane_test.hpp"
#include "support/roads.hpp"

namespace chicane::run {
namespace {

constexpr double kRadius = 200.0;

/// The original's car on a circle, with the account of its run.
class AccountTest : public ::testing::Test {
 protected:
  void stand(double distance, double heading, double speed) {
    world_.reset({.x = kRadius + distance, .y = 0.0, .psi = heading}, speed);
  }
  /// Physics for so long, or until the run is over.
  double drive(Account& account, double seconds, double throttle, bool is_manual = false) {
    const double start = world_.time();
    while (world_.time() < start + seconds && !account.is_over()) {
      world_.advance({.steer = 0.0, .throttle = throttle});
      account.add_physics(world_, is_manual);
    }
    return world_.time() - start;
  }

  road::Track track_ = test::circle_road(kRadius, 200, 5.0, 5.0, {});
  std::unique_ptr<sim::Plant> plant_ = std::move(*sim::make_plant("udacity", {}));
  sim::World world_{*plant_, track_};
};

TEST_F(AccountTest, GivesACarUpThatStandsFarFromTheRoad) {
  Account account({.laps = 1});
  stand(40.0, 0.0, 0.0);
  EXPECT_NEAR(drive(account, 100.0, 0.0), Account::kLostTime, 0.1);
  EXPECT_TRUE(account.is_over() && account.is_lost());
  EXPECT_EQ(account.summary().end_reason, "the car left the road and did not come back");
  EXPECT_FALSE(account.summary().completed);
}

TEST_F(AccountTest, WaitsForACarThatComesBack) {
  Account account({.laps = 1});
  stand(150.0, kPi, 3.0);
  drive(account, 40.0, 0.05);  // slowly, and for longer than a lost car is waited for
  EXPECT_FALSE(account.is_over()) << world_.state().lateral_error;
  EXPECT_LT(std::fabs(world_.state().lateral_error), 148.0);
}

TEST_F(AccountTest, NeverGivesACarUpThatAPersonDrives) {
  Account account({.laps = 1});
  stand(40.0, 0.0, 0.0);
  drive(account, 60.0, 0.0, true);
  EXPECT_FALSE(account.is_over());
}

TEST_F(AccountTest, ARunUntilStoppedGoesOnWhateverHappens) {
  Account account({.laps = 0});
  stand(80.0, 0.0, 0.0);
  drive(account, 700.0, 0.0);
  EXPECT_FALSE(account.is_over()) << "neither lost nor out of time";
  EXPECT_EQ(account.summary().end_reason, "stopped");
}

TEST_F(AccountTest, EndsAtTheTimeLimit) {
  Account given({.laps = 0, .time_limit = 2.0});
  stand(0.0, kPi / 2.0, 0.0);
  EXPECT_NEAR(drive(given, 100.0, 0.0), 2.0, 0.05);
  EXPECT_EQ(given.summary().end_reason, "time limit reached");
  Account per_lap({.laps = 1});
  stand(0.0, kPi / 2.0, 0.0);
  EXPECT_NEAR(drive(per_lap, 1000.0, 0.0), Account::kTimePerLap, 0.1);
}

TEST_F(AccountTest, DrivesOnUntilTheCarIsLost) {
  Account account({.laps = 1, .time_limit = 1.0});
  stand(0.0, kPi / 2.0, 0.0);
  drive(account, 100.0, 0.0);
  ASSERT_TRUE(account.is_over());
  account.drive_on();
  drive(account, 10.0, 0.0);
  EXPECT_FALSE(account.is_over());
  stand(80.0, 0.0, 0.0);
  drive(account, 100.0, 0.0);
  EXPECT_TRUE(account.is_lost());
}

TEST_F(AccountTest, TellsEachLapOnceAndNumbersThemOverAllCars) {
  Account account({});
  sim::WorldState seen;
  EXPECT_FALSE(account.take_lap());
  for (int car = 0; car < 2; ++car) {
    account.resume();
    for (seen.lap = 1; seen.lap <= 2; ++seen.lap) {
      seen.last_lap_time = 10.0 * seen.lap;
      seen.last_lap_was_clean = true;
      account.add_sighting(seen);
      account.add_sighting(seen);
      const auto lap = test::good(account.take_lap());
      EXPECT_EQ(lap->lap, 2 * car + seen.lap);
      EXPECT_EQ(lap->lap_time, 10.0 * seen.lap);
      EXPECT_FALSE(account.take_lap());
    }
  }
  EXPECT_EQ(account.summary().laps.size(), 4U);
  account.restart();
  EXPECT_EQ(account.completed_lap().lap, 0);
  EXPECT_EQ(account.laps_completed(), 0);
}

TEST_F(AccountTest, RemembersAThousandLapsOfARunUntilStopped) {
  Account account({.laps = 0});
  sim::WorldState seen;
  for (seen.lap = 1; seen.lap <= 1200; ++seen.lap) account.add_sighting(seen);
  EXPECT_EQ(account.summary().laps_completed, 1200);
  EXPECT_EQ(account.summary().laps.size(), 1000U);
}

}  // namespace
}  // namespace chicane::run
