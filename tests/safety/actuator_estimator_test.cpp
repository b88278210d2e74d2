// SPDX-License-Identifier: MIT
#include "chicane/safety/actuator_estimator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "chicane/base/math.hpp"
#include "chicane/base/random.hpp"
#include "chicane/model/vehicle.hpp"

namespace chicane::safety {
namespace {

using tracking::CommandHistory;
using tracking::StateEstimator;

constexpr double kPeriod = 0.04;
constexpr double kConfiguredDelay = 0.1;  // [s] after which commands act, as commanded

/// How a car is otherwise than commanded, and the noise of its measurements.
struct Otherwise {
  double delay = 0.0, gain = 1.0, offset = 0.0, grip = 1.0;
  double place_noise = 0.0, heading_noise = 0.0;
  double rear_stiffness = 1.0;
};

model::VehicleParams true_car(const Otherwise& truth) {
  model::VehicleParams car = model::with_grip(model::road_car_params(), truth.grip);
  car.cornering_rear *= truth.rear_stiffness;
  return car;
}

/// A car weaves at about 25 m/s and is measured; what is learned is taken up as the guard does.
class Weaving {
 public:
  explicit Weaving(const Otherwise& truth, double most = 0.05)
      : car_{model::PredictionModel{true_car(truth)}}, truth_{truth}, most_{most} {
    car_.correct({.speed = 25.0}, acted_);
  }
  void drive(double seconds) {
    for (const double end = time_ + seconds; time_ < end;) {
      time_ += kPeriod;
      const model::State state = car_.predict(time_, acted_).state;
      model::Measurement now{.time = time_,
                             .x = state.x,
                             .y = state.y,
                             .psi = state.psi,
                             .speed = std::sqrt(state.vx * state.vx + state.vy * state.vy),
                             .steer = state.steer};
      car_.correct(now, acted_);  // of what it predicts itself: nothing changes
      now.x += truth_.place_noise * random_.normal();
      now.y += truth_.place_noise * random_.normal();
      now.psi += truth_.heading_noise * random_.normal();
      const double before = estimator.answer().delay;
      if (estimator.take_up()) {
        ++taken_up;
        commanded_.delay(estimator.answer().delay - before);
      }
      estimator.see(now, commanded_);
      const model::Command wanted{
          bends_are_alike ? most_ * sin(0.15 * time_) : most_ * (sin(1.3 * time_) + 0.5 * sin(4.1 * time_)),
          throttle};
      const model::Command sent = estimator.answer().command_for(wanted);
      commanded_.add(time_ + kConfiguredDelay + estimator.answer().delay, sent);
      acted_.add(time_ + kConfiguredDelay + truth_.delay,
                 {truth_.gain * sent.steer + truth_.offset, sent.throttle});
    }
  }

  ActuatorEstimator estimator{model::road_car_params()};
  int taken_up = 0;
  bool bends_are_alike = false;  ///< long, and without quick steering
  double throttle = 0.2;

 private:
  StateEstimator car_;
  Otherwise truth_;
  double most_;
  CommandHistory commanded_, acted_;
  Random random_{1};
  double time_ = 0.0;
};

void expect_found(const controller::Estimate& found, double truth, double most_deviation, const char* name) {
  EXPECT_NEAR(found.value, truth, std::max(3.0 * found.deviation, 0.2 * most_deviation)) << name;
  EXPECT_LT(found.deviation, most_deviation) << name;
}

TEST(ActuatorEstimator, FindsDelayGainOffsetAndGripAtOnce) {
  for (const double noise : {0.0, 1.0}) {
    Weaving car({.delay = 0.06,
                 .gain = 0.9,
                 .offset = degrees_to_radians(2.0),
                 .grip = 0.85,
                 .place_noise = 0.03 * noise,
                 .heading_noise = degrees_to_radians(0.2) * noise});
    car.drive(20.0);
    const controller::LearnedCar learned = car.estimator.learned();
    expect_found(learned.delay, 0.06, 0.01, "delay");
    expect_found(learned.gain, 0.9, 0.03, "gain");
    expect_found(learned.offset, degrees_to_radians(2.0), degrees_to_radians(0.3), "offset");
    expect_found(learned.grip, 0.85, 0.05, "grip");
    const ActuatorAnswer& driven = car.estimator.answer();
    EXPECT_NEAR(driven.delay, 0.06, 0.015);
    EXPECT_NEAR(driven.gain, 0.9, 0.05);
    EXPECT_NEAR(driven.offset, degrees_to_radians(2.0), degrees_to_radians(0.4));
  }
}

TEST(ActuatorEstimator, LeavesAUsualCarAsItIs) {
  Weaving car({.place_noise = 0.05, .heading_noise = degrees_to_radians(0.3)});
  car.drive(60.0);
  EXPECT_TRUE(car.estimator.answer().is_usual());
  EXPECT_EQ(car.estimator.answer().delay, 0.0);
  EXPECT_EQ(car.taken_up, 0);
}

/// Straight ahead, the offset shows, and nothing else does: its deviation stays what was assumed.
TEST(ActuatorEstimator, SaysWhatIsNotExcited) {
  Weaving car({.delay = 0.06, .gain = 0.8, .place_noise = 0.03, .heading_noise = degrees_to_radians(0.2)},
              0.0);
  car.drive(20.0);
  const controller::LearnedCar learned = car.estimator.learned();
  EXPECT_GT(learned.delay.deviation, 0.09);
  EXPECT_GT(learned.gain.deviation, 0.2);
  EXPECT_GT(learned.grip.deviation, 0.2);
  EXPECT_LT(learned.offset.deviation, degrees_to_radians(0.3));
  EXPECT_EQ(car.taken_up, 0);
}

/// Straight ahead, delay and gain do not show: the offset is driven with all the same.
TEST(ActuatorEstimator, TakesUpAnOffsetAlone) {
  for (const double side : {-1.0, 1.0}) {
    const double offset = side * degrees_to_radians(0.5);
    Weaving car({.offset = offset, .place_noise = 0.05, .heading_noise = degrees_to_radians(0.3)}, 0.0);
    const ActuatorAnswer& driven = car.estimator.answer();
    for (int i = 0; i < 8; ++i) {
      car.drive(2.5);
      EXPECT_NEAR(driven.offset, offset, degrees_to_radians(0.2)) << side;
    }
    EXPECT_GT(car.estimator.learned().delay.deviation, 0.02) << side;
    EXPECT_TRUE(driven.delay == 0.0 && driven.gain == 1.0) << side;
  }
}

/// What a model lacks passes for another gain there, surely; only quick steering tells delay and gain apart.
TEST(ActuatorEstimator, TakesUpNothingFromBendsThatAreAlike) {
  for (const double side : {-1.0, 1.0}) {
    Weaving car({.place_noise = 0.01, .heading_noise = degrees_to_radians(0.05), .rear_stiffness = 1.25},
                0.03 * side);
    car.bends_are_alike = true;
    car.drive(60.0);
    const controller::LearnedCar learned = car.estimator.learned();
    EXPECT_GT(std::fabs(learned.gain.value - 1.0), std::max(0.03, 3.0 * learned.gain.deviation)) << side;
    EXPECT_LT(learned.gain.deviation, 0.03) << side;
    EXPECT_GT(learned.delay.deviation, 0.01) << side;
    EXPECT_EQ(car.taken_up, 0) << side;
  }
}

/// A fast car that brakes hard is unstable: the estimators' differences grow there by themselves.
TEST(ActuatorEstimator, LearnsNothingFromHardBraking) {
  for (const double side : {-1.0, 1.0}) {
    Weaving car({.offset = 0.007 * side,
                 .place_noise = 0.05,
                 .heading_noise = degrees_to_radians(0.3),
                 .rear_stiffness = 0.97},
                0.01);
    for (int i = 0; i < 20; ++i) {
      car.throttle = i % 2 == 0 ? 1.0 : -0.8;
      car.drive(i % 2 == 0 ? 14.0 : 2.5);
      const controller::LearnedCar learned = car.estimator.learned();
      EXPECT_NEAR(learned.offset.value, 0.007 * side, 4.0 * learned.offset.deviation) << i;
      EXPECT_NEAR(learned.gain.value, 1.0, 4.0 * learned.gain.deviation) << i;
    }
    EXPECT_LT(car.estimator.learned().offset.deviation, 0.003) << side;
  }
}

TEST(ActuatorEstimator, KeepsWhatItKnowsWhereNothingIsMeasured) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  Weaving car({.offset = 0.03});
  car.drive(10.0);
  const double before = car.estimator.learned().offset.value;
  for (int i = 1; i <= 20; ++i)
    car.estimator.see({.time = 10.0 + 0.04 * i, .x = kNaN, .y = kNaN, .psi = kNaN, .speed = kNaN}, {});
  EXPECT_EQ(car.estimator.learned().offset.value, before);
  car.estimator.reset();
  EXPECT_TRUE(std::isnan(car.estimator.learned().offset.value));
  EXPECT_TRUE(car.estimator.answer().is_usual());
}

}  // namespace
}  // namespace chicane::safety
