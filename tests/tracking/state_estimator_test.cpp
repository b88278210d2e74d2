// SPDX-License-Identifier: MIT
#include "chicane/tracking/state_estimator.hpp"

#include "chicane/base/math.hpp"
#include "chicane/base/random.hpp"
#include "chicane/model/actuator.hpp"
#include "support/chicane_test.hpp"

namespace chicane::tracking {
namespace {

class Estimating : public ::testing::Test {
 protected:
  const model::PredictionModel model{model::udacity_params()};
  CommandHistory sent;
  StateEstimator estimator{model};
};

TEST_F(Estimating, ReplaysACommandForExactlyTheFractionItActs) {
  // At rest, full throttle from 37 ms on: after 100 ms the car has accelerated for 63 ms.
  estimator.correct({.time = 0.0}, sent);
  sent.add(0.037, {.steer = 0.0, .throttle = 1.0});
  const StateEstimator::Prediction prediction = estimator.predict(0.1, sent);
  EXPECT_NEAR(prediction.state.vx, 0.063 * model.vehicle().drive_acceleration, 0.01);
}

TEST_F(Estimating, CountsWithTheGapOfTheSteerHelperWhereItIsAskedTo) {
  const model::VehicleParams& car = model.vehicle();
  const model::State turning{.x = 0.0, .y = 0.0, .psi = 1.5, .vx = 20.0, .vy = 0.0, .r = 2.0};
  const auto vy_after = [&](double time, bool minds) {
    estimator.reset();
    estimator.mind_helper_gap(minds);
    estimator.correct({.time = 0.0, .psi = turning.psi, .speed = turning.vx}, sent);
    estimator.set_state(turning);
    return estimator.predict(time, sent).state.vy;
  };
  EXPECT_EQ(vy_after(0.03, true), vy_after(0.03, false)) << "the heading is 1.56";
  EXPECT_NEAR(vy_after(0.04, true) - vy_after(0.04, false), -20.0 * car.steer_helper * car.helper_gap * 2.0,
              0.1);
}

TEST_F(Estimating, SaysWhatAMeasurementIsBesideTheExpectation) {
  estimator.correct({.time = 0.0, .speed = 10.0}, sent);
  EXPECT_FALSE(std::isfinite(estimator.surprise().aside)) << "nothing was expected";
  const model::State expected = estimator.predict(0.04, sent).state;
  estimator.correct(
      {.time = 0.04, .x = expected.x, .y = expected.y + 0.1, .psi = expected.psi - 0.02, .speed = 10.0},
      sent);
  EXPECT_NEAR(estimator.surprise().aside, 0.1, 1e-12) << "to the left";
  EXPECT_NEAR(estimator.surprise().heading, -0.02, 1e-12);
  estimator.correct({.time = 0.02, .speed = 10.0}, sent);
  EXPECT_FALSE(std::isfinite(estimator.surprise().aside)) << "an old measurement";
}

TEST_F(Estimating, LetsASlowCarRollOnWhoseWheelsAreTurned) {
  const model::VehicleParams& car = model.vehicle();
  sent.add(-1.0, {.steer = car.steer_limit, .throttle = 0.0});
  for (int i = 0; i <= 25; ++i) estimator.correct({.time = 0.04 * i, .speed = 0.3}, sent);
  EXPECT_LT(estimator.predict(1.1, sent).state.vx, estimator.rolling_speed(1.1, sent) - 0.02)
      << "the model's slip brakes it";
  EXPECT_NEAR(estimator.rolling_speed(1.1, sent), estimator.state().vx, 0.1 * car.drag_linear * 0.3 + 1e-3);
  sent.add(1.0, {.steer = car.steer_limit, .throttle = -0.1});
  EXPECT_NEAR(estimator.rolling_speed(1.05, sent),
              estimator.state().vx - 0.05 * 0.1 * car.reverse_acceleration, 5e-3);
  sent.add(1.05, {.steer = car.steer_limit, .throttle = -1.0});
  EXPECT_EQ(estimator.rolling_speed(1.4, sent), 0.0) << "it does not roll back";
}

/// Lag and rate limit as the actuator has them, whatever the steps are that it is replayed in.
TEST(StateEstimator, TurnsTheWheelAsFastAsTheActuatorDoes) {
  const model::VehicleParams car = model::road_car_params();
  const model::Actuator wheel{
      .low = -car.steer_limit, .high = car.steer_limit, .lag = car.steer_lag, .rate = car.steer_rate_limit};
  StateEstimator estimator{model::PredictionModel{car}};
  CommandHistory sent;
  estimator.correct({.time = 0.0, .speed = 5.0}, sent);
  sent.add(0.0, {.steer = car.steer_limit});
  double steer = 0.0;
  for (int i = 1; i <= 400; ++i) {
    steer = wheel.next(steer, car.steer_limit, 0.001);
    // A tenth of a degree for the steps of the replay.
    if (i % 40 == 0) {
      EXPECT_NEAR(estimator.predict(0.001 * i, sent).state.steer, steer, 0.006) << i;
    }
  }
}

TEST_F(Estimating, FindsYawRateAndSideslipThatTelemetryDoesNotHold) {
  // Truth from the same model: the estimator sees position, heading and speed only.
  sent.add(-1.0, {.steer = 0.05, .throttle = 0.3});
  StateEstimator truth(model);
  truth.correct({.time = 0.0, .speed = 25.0}, sent);
  for (int i = 1; i <= 60; ++i) {
    const double time = 0.04 * i;
    const model::State s = truth.predict(time, sent).state;
    truth.correct({.time = time, .x = s.x, .y = s.y, .psi = s.psi, .speed = hypot(s.vx, s.vy)}, sent);
    estimator.correct({.time = time, .x = s.x, .y = s.y, .psi = s.psi, .speed = hypot(s.vx, s.vy)}, sent);
  }
  EXPECT_NEAR(estimator.state().r, truth.state().r, 0.01);
  EXPECT_NEAR(estimator.state().vy, truth.state().vy, 0.05);
  EXPECT_GT(truth.state().r, 0.2);
}

/// A car that moves with `speed` along its heading, negative backwards, for two seconds.
bool rolls_back(double speed, double noise, double jump) {
  DirectionWatch watch;
  Random chance(3);
  bool ever = false;
  for (int i = 0; i <= 50; ++i) {
    const double time = 0.04 * i;
    const double along = speed * time + (i > 25 ? jump : 0.0) + noise * chance.normal();
    watch.see({.time = time, .x = along, .y = noise * chance.normal(), .speed = std::fabs(speed)});
    ever = ever || watch.rolls_back();
  }
  return ever;
}

TEST(DirectionWatch, TellsBackwardsFromForward) {
  for (const double speed : {1.5, 5.0, 20.0}) {
    EXPECT_TRUE(rolls_back(-speed, 0.0, 0.0)) << speed;
    EXPECT_FALSE(rolls_back(speed, 0.0, 0.0)) << speed;
    EXPECT_FALSE(rolls_back(speed, 0.3, 0.0)) << speed << ", a noisy place";
    EXPECT_FALSE(rolls_back(speed, 0.0, -8.0)) << speed << ", a place that jumps back";
  }
  EXPECT_FALSE(rolls_back(0.0, 0.0, 0.0)) << "it stands";
}

TEST(DirectionWatch, ForgetsWhenTheCarStandsOrNothingIsMeasured) {
  for (const double then : {0.0, std::numeric_limits<double>::quiet_NaN()}) {
    DirectionWatch watch;
    for (int i = 0; i < 30; ++i) watch.see({.time = 0.04 * i, .x = -0.2 * i, .speed = 5.0});
    EXPECT_TRUE(watch.rolls_back());
    watch.see({.time = 1.2, .x = -6.0, .speed = then});
    EXPECT_FALSE(watch.rolls_back());
  }
}

TEST(DirectionWatch, TheDriveStopsWhatTheReverseGearWouldNot) {
  EXPECT_GT(throttle_against_rolling_back(model::udacity_params(), 5.0), 0.5);
  EXPECT_LT(throttle_against_rolling_back(model::road_car_params(), 5.0), -0.5);
  EXPECT_LT(throttle_against_rolling_back(model::udacity_params(), 0.2), 0.2) << "gently at the end";
}

TEST_F(Estimating, StartsAnewAfterAJump) {
  estimator.correct({.time = 0.0, .x = 0.0, .speed = 10.0}, sent);
  estimator.correct({.time = 0.05, .x = 80.0, .speed = 3.0}, sent);
  EXPECT_EQ(estimator.state().x, 80.0);
  EXPECT_EQ(estimator.state().vx, 3.0);
}

/// A run may begin with a car that slides: what is expected stays beside it.
TEST_F(Estimating, FollowsACarThatSlidesWhenItStarts) {
  constexpr double kCycle = 0.04, kForward = 12.0, kBraking = 11.0;
  for (const double across : {18.0, -18.0}) {
    estimator.reset();
    for (int i = 0; i < 25; ++i) {
      const double time = kCycle * i;
      const double vy = across - std::copysign(kBraking, across) * time;
      const model::Measurement now{.time = time,
                                   .x = kForward * time,
                                   .y = 0.5 * (across + vy) * time,
                                   .speed = std::hypot(kForward, vy)};
      if (i > 0) {
        const model::State expected = estimator.predict(time, sent).state;
        EXPECT_LT(std::hypot(now.x - expected.x, now.y - expected.y), 1.5) << across << ' ' << time;
      }
      estimator.correct(now, sent);
    }
  }
}

TEST_F(Estimating, CountsOnWithoutNumbersAndIgnoresWhatIsNotNewer) {
  estimator.correct({.time = 0.0, .speed = 10.0}, sent);
  estimator.correct({.time = 0.05, .x = std::numeric_limits<double>::quiet_NaN(), .speed = 10.0}, sent);
  EXPECT_NEAR(estimator.state().x, 0.5, 0.01) << "10 m/s for 0.05 s, and a little drag";
  const model::State before = estimator.state();
  for (const double time : {-0.05, 0.05}) {
    estimator.correct({.time = time, .x = 5.0, .speed = 12.0}, sent);
    EXPECT_EQ(estimator.state().x, before.x) << time;
    EXPECT_EQ(estimator.state().vx, before.vx) << time;
  }
  EXPECT_TRUE(std::isfinite(estimator.predict(0.2, sent).state.x));
}

TEST_F(Estimating, IsNotKickedByANoisySensor) {
  sent.add(-1.0, {.steer = 0.0, .throttle = 0.3});
  StateEstimator truth(model);
  truth.correct({.time = 0.0, .speed = 25.0}, sent);
  estimator.correct({.time = 0.0, .speed = 25.0}, sent);
  Random random{3};
  double worst_slide = 0.0, worst_yaw_rate = 0.0, squares = 0.0;
  for (int i = 1; i <= 300; ++i) {
    const double time = 0.04 * i;
    const model::State s = truth.predict(time, sent).state;
    estimator.correct({.time = time,
                       .x = s.x + 0.5 * random.normal(),
                       .y = s.y + 0.5 * random.normal(),
                       .psi = s.psi + 0.005 * random.normal(),
                       .speed = s.vx},
                      sent);
    truth.correct({.time = time, .x = s.x, .y = s.y, .psi = s.psi, .speed = s.vx}, sent);
    if (i <= 100) continue;  // what the noise is has to be learned
    worst_slide = std::max(worst_slide, std::fabs(estimator.state().vy));
    worst_yaw_rate = std::max(worst_yaw_rate, std::fabs(estimator.state().r));
    squares += (estimator.state().y - s.y) * (estimator.state().y - s.y);
  }
  EXPECT_LT(worst_slide, 0.5) << "each measurement would move it by 2.5 m/s";
  EXPECT_LT(worst_yaw_rate, 0.1);
  EXPECT_LT(std::sqrt(squares / 200.0), 0.25);
}

TEST_F(Estimating, TakesWhatItMissedWhileBlindForADriftNotForAKick) {
  sent.add(-1.0, {.steer = 0.0, .throttle = 0.3});
  estimator.correct({.time = 0.0, .speed = 25.0}, sent);
  for (int i = 1; i < 25; ++i)
    estimator.correct({.time = 0.04 * i, .x = std::numeric_limits<double>::quiet_NaN()}, sent);
  const model::State counted = estimator.predict(1.0, sent).state;
  estimator.correct({.time = 1.0, .x = counted.x, .y = 1.0, .psi = counted.psi, .speed = counted.vx}, sent);
  EXPECT_NEAR(estimator.state().y, 0.8, 1e-6);
  EXPECT_NEAR(estimator.state().vy, 0.0, 0.1) << "a heading that was wrong for a second explains a metre";
}

/// A car whose front tyres are softer than the model's in a bend that tightens, seen through its place and
/// heading: what the model expects a tenth of a second ahead, and the disturbance at the end. `side` mirrors.
struct SofterCar {
  double worst_yaw_rate = 0.0, worst_slide = 0.0;
  Disturbance disturbance;
  enum class Lacks { kNothing, kSpeedReading, kPlace };
  explicit SofterCar(double side, bool with_disturbance = true, Lacks lacks = Lacks::kNothing) {
    model::VehicleParams softer = model::road_car_params();
    softer.cornering_front *= 0.8;
    StateEstimator truth{model::PredictionModel{softer}};
    StateEstimator assumed{model::PredictionModel{model::road_car_params()}};
    assumed.estimate_disturbance(with_disturbance);
    CommandHistory sent;
    truth.correct({.time = 0.0, .speed = 30.0}, sent);
    assumed.correct({.time = 0.0, .speed = 30.0}, sent);
    for (int i = 1; i <= 60; ++i) {
      const double time = 0.04 * i;
      sent.add(time - 0.04, {.steer = side * 0.0008 * i, .throttle = 0.2});
      const model::State s = truth.predict(time, sent).state;
      const model::Measurement seen{
          .time = time, .x = s.x, .y = s.y, .psi = s.psi, .speed = hypot(s.vx, s.vy)};
      truth.correct(seen, sent);
      model::Measurement part = seen;
      if (lacks == Lacks::kSpeedReading) part.speed = std::nan("");
      if (lacks == Lacks::kPlace) part.x = part.y = std::nan("");
      assumed.correct(part, sent);
      if (i < 20) continue;  // until the disturbance is there
      const model::State expected = assumed.predict(time + 0.1, sent).state;
      const model::State later = truth.predict(time + 0.1, sent).state;
      worst_yaw_rate = std::max(worst_yaw_rate, std::fabs(expected.r - later.r));
      worst_slide = std::max(worst_slide, std::fabs(expected.vy - later.vy));
    }
    disturbance = assumed.disturbance();
  }
};

TEST(StateEstimator, FindsWhatTheModelLacks) {
  const SofterCar left(1.0);
  EXPECT_LT(left.worst_yaw_rate, 0.5 * SofterCar(1.0, false).worst_yaw_rate);
  EXPECT_LT(left.worst_slide, SofterCar(1.0, false).worst_slide);
  EXPECT_LT(left.disturbance.yaw, -0.3) << "the car iterations in less than the model";
  const SofterCar right(-1.0);
  EXPECT_NEAR(right.disturbance.yaw, -left.disturbance.yaw, 1e-9);
  EXPECT_NEAR(right.disturbance.lateral, -left.disturbance.lateral, 1e-9);
  EXPECT_NEAR(right.worst_yaw_rate, left.worst_yaw_rate, 1e-9);
}

TEST(StateEstimator, FindsItWithoutTheSpeedToo) {
  const SofterCar all(1.0);
  const SofterCar no_speed(1.0, true, SofterCar::Lacks::kSpeedReading);
  EXPECT_NEAR(no_speed.disturbance.yaw, all.disturbance.yaw, 0.1 * std::fabs(all.disturbance.yaw));
  EXPECT_LT(no_speed.worst_yaw_rate, 1.2 * all.worst_yaw_rate);
  EXPECT_LT(no_speed.worst_slide, 1.2 * all.worst_slide);
  const SofterCar no_place(1.0, true, SofterCar::Lacks::kPlace);
  EXPECT_LT(no_place.worst_yaw_rate, SofterCar(1.0, false).worst_yaw_rate);
}

TEST(StateEstimator, ForgetsADisturbanceThatIsNotMeasuredAnew) {
  const model::PredictionModel model{model::road_car_params()};
  StateEstimator estimator{model};
  const CommandHistory sent;
  estimator.estimate_disturbance(true);
  estimator.correct({.time = 0.0, .speed = 20.0}, sent);
  for (int i = 1; i <= 10; ++i) {
    const double time = 0.04 * i, psi = 0.5 * time * time;
    estimator.correct(
        {.time = time, .x = 20.0 * time, .y = 20.0 * psi * time / 3.0, .psi = psi, .speed = 20.0}, sent);
  }
  const double yaw = estimator.disturbance().yaw;
  ASSERT_GT(yaw, 0.2);
  EXPECT_NEAR(estimator.predict(0.9, sent).disturbance.yaw, yaw * std::exp(-0.5 / Disturbance::kTime),
              0.01 * yaw);
}

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
