// SPDX-License-Identifier: MIT
#include "chicane/run/account.hpp"

#include "chicane/base/math.hpp"
#include "chicane/sim/plant_registry.hpp"
#include "support/alloc_guard.hpp"
#include "support/chicane_test.hpp"
#include "support/roads.hpp"

namespace chicane::run {
namespace {

constexpr double kWideRadius = 200.0;

/// The original's car on a circle, with the account of its run.
class AccountTest : public ::testing::Test {
 protected:
  void stand(double distance, double heading, double speed) {
    world_.reset({.x = kWideRadius + distance, .y = 0.0, .psi = heading}, speed);
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

  road::Track track_ = test::circle_road(kWideRadius, 200, 5.0, 5.0, {});
  std::unique_ptr<sim::Plant> plant_ = std::move(*sim::make_plant("udacity", {}));
  sim::World world_{*plant_, track_};
};

TEST_F(AccountTest, GivesACarUpThatStandsFarFromTheRoad) {
  Account account({.laps = 1});
  stand(40.0, 0.0, 0.0);
  drive(account, 60.0, 0.0, true);
  EXPECT_FALSE(account.is_over()) << "a person drives";
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

TEST_F(AccountTest, EndsAtTheTimeLimitUnlessItGoesOnUntilStopped) {
  Account stopped({.laps = 0});
  stand(80.0, 0.0, 0.0);
  drive(stopped, 700.0, 0.0);
  EXPECT_FALSE(stopped.is_over()) << "neither lost nor out of time";
  EXPECT_EQ(stopped.summary().end_reason, "stopped");
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
  Account endless({.laps = 0});
  for (seen.lap = 1; seen.lap <= 1200; ++seen.lap) endless.add_sighting(seen);
  EXPECT_EQ(endless.summary().laps_completed, 1200);
  EXPECT_EQ(endless.summary().laps.size(), 1000U);
}

constexpr double kRadius = 60.0;
constexpr double kSpeed = 12.0;
constexpr double kLapTime = kTwoPi * kRadius / kSpeed;
constexpr double kPeriod = 0.12;  // of telemetry with the original's latency [s]

/// Circle about the origin, counter-clockwise, s = 0 at (kRadius, 0), 5 m to the left edge and 4 m to the
/// right.
road::Track circle() {
  return test::circle_road(kRadius, 120, 5.0, 4.0, {.spacing = 2.0, .smoothing_sigma = 0.0});
}

/// Somebody else's car that goes round, as telemetry tells of it; judged by a road, or by none.
class Telemetry {
 public:
  explicit Telemetry(bool has_road = true) : roadside(has_road ? &track_ : nullptr, {}) {}
  const telemetry::Frame& next(double left = 0.0) {
    const double angle = kSpeed / kRadius * driven_for_;
    frame_->time = 100.0 + driven_for_;
    frame_->has_measurement = true;
    frame_->measurement.x = (kRadius - left) * std::cos(angle);
    frame_->measurement.y = (kRadius - left) * std::sin(angle);
    frame_->measurement.psi = angle + kPi / 2.0;
    frame_->measurement.speed = kSpeed;
    roadside.judge(*frame_);
    driven_for_ += kPeriod;
    return *frame_;
  }
  void drive(double laps) {
    while (driven_for_ < laps * kLapTime) next();
  }
  const telemetry::Frame& broken() {
    frame_->has_measurement = false;
    roadside.judge(*frame_);
    return *frame_;
  }
  [[nodiscard]] double driven_for() const { return driven_for_; }
  /// Another car begins at the line.
  void begin_anew() {
    roadside.resume();
    driven_for_ = 0.0;
  }

 private:
  road::Track track_ = circle();
  double driven_for_ = 0.0;
  std::unique_ptr<telemetry::Frame> frame_ = std::make_unique<telemetry::Frame>();

 public:
  Roadside roadside;
};

TEST(Roadside, TimesLapsOfACarThatOthersSimulateOverTelemetryThatWasBroken) {
  Telemetry car;
  EXPECT_TRUE(car.next().is_judged);
  const test::AllocationGuard guard;
  car.drive(1.1);
  EXPECT_EQ(guard.count(), 0) << "nothing is allocated while it looks";
  const telemetry::Frame& broken = car.broken();
  EXPECT_FALSE(broken.is_judged);
  EXPECT_EQ(broken.completed_lap.lap, 1);
  car.drive(2.5);
  const telemetry::Frame& frame = car.next(1.5);
  EXPECT_EQ(frame.lap, 2);
  EXPECT_NEAR(frame.lateral_error, 1.5, 1e-3);
  EXPECT_NEAR(frame.s, kRadius * (kSpeed / kRadius * (car.driven_for() - kPeriod) - 2.0 * kTwoPi), 0.1);
  EXPECT_EQ(frame.completed_lap.lap, 2);
  EXPECT_TRUE(frame.completed_lap.is_clean);
  // Even motion is interpolated; the spline through 120 points errs by 1e-4 of a length at most.
  EXPECT_NEAR(frame.completed_lap.lap_time, kLapTime, 1e-4 * kLapTime);
  for (const double sector : frame.completed_lap.sector_times) EXPECT_NEAR(sector, kLapTime / 3.0, 2e-3);
  EXPECT_NEAR(frame.completed_lap.mean_speed, kSpeed, 1e-9);

  const telemetry::RunSummary run = car.roadside.summary();
  EXPECT_EQ(run.track, "circle");
  ASSERT_EQ(run.laps.size(), 2U);
  EXPECT_EQ(run.laps[1].lap_time, frame.completed_lap.lap_time);
  EXPECT_NEAR(run.laps[1].rms_lateral_error, 0.0, 1e-3);
  EXPECT_EQ(run.off_track_events, 0);
  EXPECT_GT(run.laps[1].min_edge_distance, 1.0);
}

TEST(Roadside, SeesWheelsBeyondTheEdge) {
  Telemetry car;
  while (car.driven_for() < 1.2 * kLapTime) car.next(car.driven_for() < 0.5 * kLapTime ? 4.8 : 0.0);
  const telemetry::RunSummary run = car.roadside.summary();
  ASSERT_EQ(run.laps.size(), 1U);
  EXPECT_LT(run.laps[0].min_edge_distance, 0.0);
  EXPECT_EQ(run.off_track_events, 1);
  EXPECT_NEAR(run.out_of_track_time, 0.5 * kLapTime, 2.0 * kPeriod);
  EXPECT_FALSE(car.next().completed_lap.is_clean);
}

TEST(Roadside, TimesLapsAndJudgesNothingOnARoadThatNobodyKnows) {
  Telemetry car(false);
  int cycles = 1;
  for (; car.driven_for() < 2.2 * kLapTime; ++cycles) EXPECT_FALSE(car.next().is_judged);
  EXPECT_EQ(car.next().lap, 2);
  const auto lap = test::good(car.roadside.take_lap());
  EXPECT_NEAR(lap->lap_time, kLapTime, 1e-3 * kLapTime);
  EXPECT_FALSE(std::isfinite(lap->min_edge_distance));
  const telemetry::RunSummary run = car.roadside.summary();
  EXPECT_EQ(run.track, "");
  EXPECT_EQ(static_cast<int>(run.cycles), cycles);
  ASSERT_EQ(run.laps.size(), 2U);
  EXPECT_NEAR(run.laps[1].mean_speed, kSpeed, 1e-9);
  EXPECT_NEAR(run.total.mean_speed, kSpeed, 1e-9);
  EXPECT_TRUE(std::isnan(run.total.min_edge_distance));
  EXPECT_EQ(run.off_track_events, 0);
}

TEST(Roadside, ForgetsWhatWasJudgedByAnotherRoad) {
  Telemetry car;
  EXPECT_TRUE(car.next(20.0).is_off_track);
  car.roadside.forget_track();
  EXPECT_FALSE(car.next().is_judged);
  car.drive(1.2);
  const telemetry::RunSummary run = car.roadside.summary();
  EXPECT_EQ(run.track, "");
  EXPECT_EQ(run.off_track_events, 0);
  EXPECT_EQ(run.laps_completed, 1);
}

TEST(Roadside, GoesOnCountingWithTheNextCar) {
  Telemetry car;
  Roadside& roadside = car.roadside;
  car.drive(1.7);
  car.begin_anew();
  EXPECT_EQ(car.next(6.0).lap, 1) << "the lap that was under way does not count";
  EXPECT_TRUE(roadside.take_lap());
  EXPECT_FALSE(roadside.take_lap()) << "each lap is told once";
  car.drive(1.1);
  EXPECT_EQ(car.next().lap, 2);
  EXPECT_EQ(roadside.take_lap()->lap, 2);
  const telemetry::RunSummary run = roadside.summary();
  ASSERT_EQ(run.laps.size(), 2U);
  EXPECT_NEAR(run.laps[0].lap_time, kLapTime, 1e-3 * kLapTime);
  EXPECT_NEAR(run.laps[1].lap_time, kLapTime, 2e-2 * kLapTime);  // it began beside the line
  EXPECT_EQ(run.end_reason, "stopped");
}

/// A car that goes round a circle, `left` metres beside its line; `way` < 0: the other way round.
struct Car {
  double angle = 0.3;
  double time = 100.0;
  LapLearner learner;
  void drive(double laps, double left = 0.0, double way = 1.0) {
    for (double end = time + laps * kLapTime; time < end; time += kPeriod) {
      const double radius = kRadius - left;
      learner.see(
          time,
          {.x = radius * std::cos(angle), .y = radius * std::sin(angle), .psi = angle + way * kPi / 2.0},
          kSpeed);
      angle += way * kSpeed / kRadius * kPeriod;
    }
  }
  const sim::WorldState& state() { return learner.state(); }
};

TEST(LapLearner, TimesLapsFromWhereTheCarWasFirstSeen) {
  Car car;
  car.drive(0.9);
  EXPECT_EQ(car.state().lap, 0);
  car.drive(0.2);
  EXPECT_EQ(car.state().lap, 1);
  // Between two sightings the car goes straight: 0.12 s on 60 m are 1e-4 of a lap.
  EXPECT_NEAR(car.state().last_lap_time, kLapTime, 1e-3 * kLapTime);
  EXPECT_NEAR(car.state().lap_time, 0.1 * kLapTime, 2.0 * kPeriod);
  car.drive(1.0, 3.0);
  EXPECT_EQ(car.state().lap, 2);
  EXPECT_NEAR(car.state().best_lap_time, kLapTime, 1e-3 * kLapTime);
  EXPECT_TRUE(std::isnan(car.state().last_sector_times[0])) << "of a road that nobody knows";
}

TEST(LapLearner, CountsNoLapOfACarThatGoesBackAndForthTakesAShortCutIsMovedOrForgotten) {
  Car back_and_forth;
  for (int i = 0; i < 10; ++i) {
    back_and_forth.drive(0.1);
    back_and_forth.drive(0.2, 0.0, -1.0);
    back_and_forth.drive(0.1);
  }
  EXPECT_EQ(back_and_forth.state().lap, 0);
  Car shortened;
  shortened.drive(1.05);
  ASSERT_EQ(shortened.state().lap, 1);
  for (double left = 0.0; left < 14.0; left += 1.0) shortened.drive(kPeriod / kLapTime, left);
  shortened.drive(1.0, 14.0);  // a smaller circle, 77 % of the lap
  EXPECT_EQ(shortened.state().lap, 1);
  EXPECT_LT(shortened.state().lap_time, 0.2 * kLapTime) << "the next one has begun";
  Car moved;
  moved.drive(0.5);
  moved.angle += kPi;
  moved.drive(0.6);
  EXPECT_EQ(moved.state().lap, 0);
  moved.drive(0.5);
  EXPECT_EQ(moved.state().lap, 1);
  Car forgotten;
  forgotten.drive(0.7);
  forgotten.learner.reset();
  forgotten.drive(0.7);
  EXPECT_EQ(forgotten.state().lap, 0);
  EXPECT_NEAR(forgotten.state().lap_time, 0.7 * kLapTime, 2.0 * kPeriod);
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
