// SPDX-License-Identifier: MIT
#include "chicane/safety/actuator_watch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

#include "chicane/base/random.hpp"
#include "chicane/model/prediction.hpp"

namespace chicane::safety {
namespace {

constexpr double kCycle = 0.04;  // [s] between measurements, unless another time is commanded
constexpr double kOnset = 5.0;   // [s] from which actuators answer otherwise

/// A car that is steered to and fro by its model, with actuators that answer as `effect` says from kOnset on.
struct Drive {
  model::VehicleParams car = model::road_car_params();
  std::function<model::Command(const model::Command&)> effect = [](const model::Command& c) { return c; };
  double ends = 1e9;             ///< the actuators are usual again [s]
  double heading_noise = 0.0;    ///< [rad]
  double speed_noise = 0.0;      ///< [m/s]
  double throttle_after = 0.05;  ///< from kOnset on
  double steer = 0.05;           ///< amplitude [rad]
  double cycle = kCycle;         ///< [s]
  double sign = 1.0;             ///< -1: mirrored
  double speed = 12.0;           ///< [m/s]
  double swing = 1.3;            ///< frequency of the steering [rad/s]
  double jitter = 0.0;           ///< by which commands act late, at most [s]
  ActuatorWatch::AxleUse use{};  ///< of the tyres, as the watch is commanded

  /// What the watch holds after `seconds`; `first`: when it differed first [s].
  ActuatorWatch after(double seconds, double* first = nullptr) const {
    ActuatorWatch watch{car};
    const model::PredictionModel model{car};
    tracking::CommandHistory sent;
    Random random(3);
    model::BodyMotion<double> body{.vx = speed};
    double psi = 0.0;
    Vec2 place;
    model::Command before;
    for (int i = 0; i * cycle < seconds; ++i) {
      const double time = i * cycle;
      model::Measurement now;
      now.time = time;
      now.x = place.x();
      now.y = place.y();
      now.psi = psi + heading_noise * random.normal();
      now.speed = std::hypot(body.vx, body.vy);
      if (speed_noise > 0.0) now.speed += speed_noise * random.normal();
      watch.see(now, sent, use);
      if (first != nullptr && !(*first > 0.0) && !watch.answer().is_usual()) *first = time;
      const bool is_late = time >= kOnset && time < ends;
      const model::Command command{sign * steer * (0.6 + std::sin(swing * time)),
                                   time >= kOnset ? throttle_after : 0.05};
      sent.add(time, command);
      const model::Command next = is_late ? effect(command) : command;
      const double acts_after = jitter > 0.0 ? random.uniform(0.0, jitter) : 0.0;
      constexpr int kParts = 10;
      for (int k = 0; k < kParts; ++k) {
        const double dt = cycle / kParts;
        const model::Command acting = k * dt < acts_after ? before : next;
        const double psi_before = body.r;
        body = model.advance(body, acting.steer, longitudinal_acceleration(car, acting.throttle, body.vx), dt,
                             model.lags(dt));
        psi += 0.5 * dt * (psi_before + body.r);
        place += dt * Vec2{body.vx * std::cos(psi) - body.vy * std::sin(psi),
                           body.vx * std::sin(psi) + body.vy * std::cos(psi)};
      }
      before = next;
    }
    return watch;
  }
};

TEST(ActuatorWatch, FindsNothingWhereTheCarAnswersAsItsModel) {
  for (const model::VehicleParams& car : {model::road_car_params(), model::udacity_params()})
    for (const double noise : {0.0, 0.002, 0.005, 0.01}) {
      Drive drive{.car = car};
      drive.heading_noise = noise;
      EXPECT_TRUE(drive.after(60.0).answer().is_usual()) << car.name << ' ' << noise;
    }
}

TEST(ActuatorWatch, FindsAnOffsetWithinAThirdOfASecond) {
  for (const double offset : {0.06, -0.06}) {
    Drive drive;
    drive.effect = [=](const model::Command& c) { return model::Command{c.steer + offset, c.throttle}; };
    double first = 0.0;
    const ActuatorWatch watch = drive.after(kOnset + 10.0, &first);
    EXPECT_GT(first, kOnset) << offset;
    EXPECT_LT(first, kOnset + 0.33) << offset;
    EXPECT_TRUE(watch.has_other_steering()) << offset;
    EXPECT_NEAR(watch.answer().offset, offset, 0.005);
    EXPECT_EQ(watch.answer().gain, 1.0);
  }
}

/// A dead controller, lost commands, stuck wheels: compensated as an offset, the next command that arrives
/// would turn the wheels to their stop. A second of it may pass for an offset, of 0.045 rad at most.
TEST(ActuatorWatch, CompensatesNothingOfWheelsThatDoNotFollow) {
  Random random(5);
  model::Command held{0.03, 0.05};
  const auto lost = [&](double share) {
    return [&, share](const model::Command& c) { return held = random.uniform() < share ? held : c; };
  };
  for (const double share : {1.0, 0.8, 0.5}) {
    for (const double end : {1.0, 2.0, 5.0, 20.0}) {
      Drive drive{.ends = kOnset + end};
      drive.effect = lost(share);
      for (const double after : {0.5, 1.0, 2.0, 4.0, 10.0})
        EXPECT_LT(std::fabs(drive.after(kOnset + after).answer().offset), 0.045) << share << ' ' << end;
    }
  }
  Drive halved;
  halved.effect = [](const model::Command& c) { return model::Command{0.5 * c.steer, c.throttle}; };
  EXPECT_TRUE(halved.after(kOnset + 10.0).has_other_steering()) << "said, not compensated";
  EXPECT_TRUE(halved.after(kOnset + 10.0).answer().is_usual());
}

// A car that counter-steers in a slide was taken for one whose wheels turn otherwise, and spun by what the
// guard made of it (vw-vanagon, raced on lakeside).
TEST(ActuatorWatch, JudgesNothingOfACarWhoseTyresSlide) {
  Drive drive;
  drive.use.rear = 0.8;
  drive.effect = [](const model::Command& c) { return model::Command{c.steer + 0.06, c.throttle}; };
  EXPECT_TRUE(drive.after(kOnset + 5.0).answer().is_usual());
  Drive braked;
  braked.speed = 40.0;
  braked.throttle_after = -0.5;
  braked.steer = 0.0;
  braked.use.front = 0.8;
  braked.effect = [](const model::Command& c) { return model::Command{c.steer, 0.5 * c.throttle}; };
  EXPECT_FALSE(braked.after(kOnset + 1.5).has_weak_brakes());
}

// The wheel angle that turns a car follows from its sideslip: what is not sure of that is not sure of this.
TEST(ActuatorWatch, IsNoSurerOfTheWheelsThanOfTheSlide) {
  for (const double sign : {1.0, -1.0}) {
    Drive drive{.sign = sign};
    drive.effect = [sign](const model::Command& c) {
      return model::Command{c.steer + 0.04 * sign, c.throttle};
    };
    drive.use.sideslip = 0.0;
    EXPECT_FALSE(drive.after(12.0).answer().is_usual()) << sign;
    drive.use.sideslip = 0.06 * sign;
    EXPECT_TRUE(drive.after(12.0).answer().is_usual()) << sign;
  }
}

/// The mean angle of a window is uncertain when the wheels swing in it and commands act up to 60 ms late.
TEST(ActuatorWatch, FindsNothingWhereWheelsSwingAndCommandsAreLate) {
  for (const double swing : {6.0, 12.0, 26.0, 40.0})
    for (const double speed : {12.0, 16.0, 20.0}) {
      const Drive drive{.steer = 0.3, .cycle = 0.06, .speed = speed, .swing = swing, .jitter = 0.06};
      EXPECT_TRUE(drive.after(40.0).answer().is_usual()) << swing << ' ' << speed;
    }
}

TEST(ActuatorWatch, ForgetsAnAnswerThatHasEnded) {
  Drive drive;
  drive.effect = [](const model::Command& c) { return model::Command{c.steer + 0.06, c.throttle}; };
  drive.ends = kOnset + 5.0;
  EXPECT_TRUE(drive.after(drive.ends + 12.0).answer().is_usual());
}

TEST(ActuatorWatch, FindsWeakBrakes) {
  Drive drive;
  drive.speed = 40.0;
  drive.throttle_after = -0.5;
  drive.steer = 0.0;
  drive.effect = [](const model::Command& c) { return model::Command{c.steer, 0.5 * c.throttle}; };
  const ActuatorWatch watch = drive.after(kOnset + 1.5);
  EXPECT_TRUE(watch.has_weak_brakes());
  EXPECT_NEAR(watch.answer().braking, 0.5, 0.05);
  drive.effect = [](const model::Command& c) { return c; };
  EXPECT_FALSE(drive.after(kOnset + 1.5).has_weak_brakes());
}

/// Locked wheels of `udacity` brake by four fifths of its model: noise of the speed passed for the rest.
TEST(ActuatorWatch, DoesNotTakeNoiseForWeakBrakes) {
  for (double speed = 30.0; speed < 60.0; speed += 1.0) {
    Drive drive{.speed_noise = 0.15, .throttle_after = -0.5, .steer = 0.0, .cycle = 0.12, .speed = speed};
    for (const double share : {0.85, 0.4}) {
      drive.effect = [share](const model::Command& c) { return model::Command{c.steer, share * c.throttle}; };
      double first = 0.0;
      (void)drive.after(kOnset + 2.5, &first);
      EXPECT_EQ(first > 0.0, share < 0.5) << speed;
    }
  }
}

TEST(ActuatorWatch, FindsTheSameInMeasurementsThatComeOftenOrSeldom) {
  for (const double cycle : {0.005, 0.01, 0.02, 0.1}) {
    Drive drive;
    drive.cycle = cycle;
    drive.effect = [](const model::Command& c) { return model::Command{0.5 * c.steer, c.throttle}; };
    EXPECT_TRUE(drive.after(kOnset + 10.0).has_other_steering()) << cycle;
    drive.speed = 40.0;
    drive.throttle_after = -0.5;
    drive.steer = 0.0;
    drive.effect = [](const model::Command& c) { return model::Command{c.steer, 0.5 * c.throttle}; };
    EXPECT_TRUE(drive.after(kOnset + 1.5).has_weak_brakes()) << cycle;
  }
}

TEST(ActuatorWatch, KnowsTheCarWithTheBrakesThatItHas) {
  Drive drive;
  drive.speed = 40.0;
  drive.throttle_after = -0.5;
  drive.effect = [](const model::Command& c) { return model::Command{c.steer, 0.5 * c.throttle}; };
  ActuatorWatch watch = drive.after(kOnset + 1.5);
  const double usual = drive.car.brake_acceleration;
  EXPECT_DOUBLE_EQ(watch.vehicle().brake_acceleration, watch.answer().braking * usual);
  EXPECT_EQ(watch.usual_vehicle().brake_acceleration, usual);
  watch.reset();
  EXPECT_EQ(watch.vehicle().brake_acceleration, usual);
}

TEST(ActuatorWatch, JudgesNothingWhileNothingIsMeasured) {
  ActuatorWatch watch{model::road_car_params()};
  tracking::CommandHistory sent;
  sent.add(0.0, {0.2, 0.0});
  for (int i = 0; i < 200; ++i) {  // straight on although the wheels are turned
    model::Measurement now;
    now.time = i * kCycle;
    now.speed = 20.0;
    now.x = 20.0 * now.time;
    watch.see(now, sent, {});
    if (i % 3 == 0) watch.skip();
  }
  EXPECT_TRUE(watch.answer().is_usual());
}

TEST(ActuatorAnswer, CommandsWhatHasTheWantedEffect) {
  const ActuatorAnswer answer{.gain = 0.5, .offset = 0.1};
  const model::Command commanded = answer.command_for({0.2, -0.3});
  EXPECT_DOUBLE_EQ(commanded.steer, 0.2);
  EXPECT_DOUBLE_EQ(answer.effect_of(commanded).steer, 0.2);
  EXPECT_EQ(commanded.throttle, -0.3);
}

}  // namespace
}  // namespace chicane::safety
