// SPDX-License-Identifier: MIT
#include "chicane/safety/sensor_watch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "chicane/base/math.hpp"
#include "chicane/base/random.hpp"

namespace chicane::safety {
namespace {

constexpr double kCycle = 0.04;  // [s]
constexpr double kLength = 4.5, kWheelbase = 2.7;
constexpr double kSpeed = 20.0, kYawRate = 0.3;  // [m/s], [rad/s]

/// A car on a circle, or straight on.
model::State car_at(double time, double yaw_rate) {
  model::State state{.vx = kSpeed, .r = yaw_rate};
  state.psi = yaw_rate * time;
  const double radius = yaw_rate != 0.0 ? kSpeed / yaw_rate : 0.0;
  state.x = yaw_rate != 0.0 ? radius * std::sin(state.psi) : kSpeed * time;
  state.y = yaw_rate != 0.0 ? radius * (1.0 - std::cos(state.psi)) : 0.0;
  state.steer = std::atan(yaw_rate * kWheelbase / kSpeed);
  return state;
}

model::Measurement measured(double time, const model::State& car) {
  model::Measurement now;
  now.time = time;
  now.x = car.x;
  now.y = car.y;
  now.psi = car.psi;
  now.speed = car.vx;
  return now;
}

/// The car as it was `age` [s] ago.
model::Measurement measured_late(double time, double age, double yaw_rate) {
  return measured(time, car_at(time - age, yaw_rate));
}

using Change = std::function<void(model::Measurement&)>;

/// What is doubted first within `seconds` of a signal that is wrong from the fifth second on. The estimate
/// follows what is not doubted, as the guard's does.
SensorDoubts doubts_of(const Change& change, double seconds, double yaw_rate = kYawRate) {
  SensorWatch watch{kLength, kWheelbase};
  double off_x = 0.0, off_y = 0.0;  // of the estimate
  for (double time = 0.0; time < 5.0 + seconds; time += kCycle) {
    model::State expected = car_at(time, yaw_rate);
    model::Measurement now = measured(time, expected);
    if (time >= 5.0) change(now);
    expected.x += off_x;
    expected.y += off_y;
    const SensorDoubts doubts = watch.see(now, expected);
    if (doubts.late || doubts.place || doubts.heading || doubts.speed) return doubts;
    off_x += now.x - expected.x;
    off_y += now.y - expected.y;
  }
  return {};
}

TEST(SensorWatch, DoubtsNothingOfACarThatIsMeasuredWell) {
  for (const double yaw_rate : {0.0, kYawRate, -kYawRate}) {
    const SensorDoubts doubts = doubts_of([](model::Measurement&) {}, 60.0, yaw_rate);
    EXPECT_FALSE(doubts.late || doubts.place || doubts.heading || doubts.speed) << yaw_rate;
  }
}

TEST(SensorWatch, KnowsTheNoiseOfASensorThatWasAlwaysNoisy) {
  SensorWatch watch{kLength, kWheelbase};
  Random random(5);
  for (double time = 0.0; time < 300.0; time += kCycle) {
    const model::State car = car_at(time, kYawRate);
    model::Measurement now = measured(time, car);
    now.x += 0.05 * random.normal();
    now.y += 0.05 * random.normal();
    now.psi += 0.005 * random.normal();
    now.speed += 0.1 * random.normal();
    const SensorDoubts doubts = watch.see(now, car);
    ASSERT_FALSE(doubts.late || doubts.place || doubts.heading || doubts.speed) << time;
  }
}

TEST(SensorWatch, DoubtsAPlaceThatDrifts) {
  for (const double angle : {0.0, 1.5, 3.0, 4.5}) {
    for (const double speed : {0.3, 1.0}) {
      const auto drift = [&](model::Measurement& now) {
        now.x += speed * (now.time - 5.0) * std::cos(angle);
        now.y += speed * (now.time - 5.0) * std::sin(angle);
      };
      const SensorDoubts doubts = doubts_of(drift, 6.0 / speed);
      EXPECT_TRUE(doubts.place) << angle << ' ' << speed;
      EXPECT_FALSE(doubts.heading || doubts.speed || doubts.late);
    }
  }
}

TEST(SensorWatch, CountsOnFromWhereTheDriftBegan) {
  SensorWatch watch{kLength, kWheelbase};
  double off = 0.0;
  for (double time = 0.0; time < 12.0; time += kCycle) {
    model::State expected = car_at(time, 0.0);
    model::Measurement now = measured(time, expected);
    if (time >= 5.0) now.x -= 0.5 * (time - 5.0);
    expected.x += off;
    const bool is_doubted = watch.see(now, expected).place;
    off = (is_doubted ? watch.place().x() : now.x) - car_at(time, 0.0).x;
  }
  EXPECT_TRUE(watch.doubts().place);
  EXPECT_LT(std::fabs(off), 0.8);  // 3.5 m by the sensor
}

/// 20 m/s through a hairpin of 20 m, to either side; its place is measured `ahead` of its centre of mass [m].
/// The displacement is much shorter than the way, along which errors add up.
bool is_doubted_in_a_hairpin(double side, double ahead) {
  constexpr double kBegins = 12.0, kRate = 1.0;
  SensorWatch watch{kLength, kWheelbase};
  for (double time = 0.0; time < 20.0; time += kCycle) {
    const double turned = std::clamp(kRate * (time - kBegins), 0.0, kPi);
    const double before = kSpeed * std::min(time, kBegins);
    const double after = kSpeed * std::max(time - kBegins - kPi / kRate, 0.0);
    model::State car{.psi = side * turned, .vx = kSpeed};
    car.r = turned > 0.0 && turned < kPi ? side * kRate : 0.0;
    car.steer = std::atan(car.r * kWheelbase / kSpeed);
    car.x = before + kSpeed / kRate * std::sin(turned) - after + ahead * std::cos(car.psi);
    car.y = side * kSpeed / kRate * (1.0 - std::cos(turned)) + ahead * std::sin(car.psi);
    const SensorDoubts doubts = watch.see(measured(time, car), car);
    if (doubts.late || doubts.place || doubts.heading || doubts.speed) return true;
  }
  return false;
}

TEST(SensorWatch, DoubtsNothingOfACarInAHairpin) {
  for (const double side : {1.0, -1.0})
    for (const double ahead : {0.58, -0.58}) EXPECT_FALSE(is_doubted_in_a_hairpin(side, ahead)) << side;
}

/// It slides to either side for 1.5 s, by no estimate, and drives calmly from then on.
TEST(SensorWatch, ForgetsTheSlideOfACarThatIsCalmAgain) {
  constexpr double kSlip = 0.5, kSlides = 1.5;  // [rad], [s]
  for (const double side : {1.0, -1.0}) {
    SensorWatch watch{kLength, kWheelbase};
    for (double time = 0.0; time < 20.0; time += kCycle) {
      const double slid = std::min(time, kSlides);
      model::State car = car_at(time, 0.0);
      car.x += kSpeed * slid * (std::cos(kSlip) - 1.0);
      car.y += side * kSpeed * slid * std::sin(kSlip);
      model::Measurement now = measured(time, car);
      if (time < kSlides) car.y -= side;
      const SensorDoubts doubts = watch.see(now, car);
      ASSERT_FALSE(doubts.late || doubts.place || doubts.heading || doubts.speed) << time;
    }
  }
}

/// Its course turns off its heading by as much as wind pushes it.
TEST(SensorWatch, DoubtsNothingOfACarThatWindPushesAside) {
  const auto pushed = [](model::Measurement& now) {
    const double since = now.time - 5.0;
    now.y += std::min(0.5 * since * since, since);  // up to 1 m/s
  };
  const SensorDoubts doubts = doubts_of(pushed, 60.0, 0.0);
  EXPECT_FALSE(doubts.late || doubts.place || doubts.heading || doubts.speed);
}

TEST(SensorWatch, CountsOnFromWhereThePlaceJumped) {
  SensorWatch watch{kLength, kWheelbase};
  for (double time = 0.0; time < 12.0; time += kCycle) {
    const model::State expected = car_at(time, 0.0);
    model::Measurement now = measured(time, expected);
    const bool is_wrong = time >= 5.0 && time < 8.0;
    if (is_wrong) now.y += 4.0;
    watch.see(now, expected);
    EXPECT_NEAR(watch.place().x(), expected.x, 0.01) << time;
    const double ends = 8.0 + SensorWatch::kAgreeing;
    if (std::fabs(time - ends) > 0.1) {
      EXPECT_EQ(watch.doubts().place, time >= 5.0 && time < ends) << time;
    }
  }
}

TEST(SensorWatch, TellsAMirroredHeadingFromAWrongPlace) {
  const SensorDoubts doubts =
      doubts_of([](model::Measurement& now) { now.psi = 2.0 * kYawRate * 5.0 - now.psi; }, 2.0);
  EXPECT_TRUE(doubts.heading);
  EXPECT_FALSE(doubts.place || doubts.speed || doubts.late);
}

TEST(SensorWatch, DoubtsASpeedThatChangesAtOnce) {
  for (const double factor : {0.5, 2.0, 3.6}) {
    const SensorDoubts doubts = doubts_of([=](model::Measurement& now) { now.speed *= factor; }, kCycle);
    EXPECT_TRUE(doubts.speed) << factor;
    EXPECT_FALSE(doubts.place || doubts.heading || doubts.late) << factor;
  }
}

/// How often the speed is doubted of a car that loses `lost` of its speed at once after five seconds, by no
/// model, `share` of the way through the time between two measurements. `is_true`: the car does, and not only
/// its sensor.
int doubts_of_a_loss(double lost, double share, double cycle, bool is_true) {
  SensorWatch watch{kLength, kWheelbase};
  const double from = cycle * (std::ceil(5.0 / cycle) - 1.0 + share);
  double estimate = kSpeed;
  int doubted = 0;
  for (int i = 0; i * cycle < 8.0; ++i) {
    const double time = i * cycle;
    const double since = std::max(time - from, 0.0);
    const double speed = kSpeed - (since > 0.0 ? lost : 0.0);
    model::State car = car_at(time, 0.0);
    if (is_true) car.x -= lost * since;
    model::State expected = car;
    expected.vx = estimate;
    if (is_true) expected.x += (estimate - speed) * std::min(since, cycle);
    model::Measurement now = measured(time, car);
    now.speed = speed;
    const bool is_doubted = watch.see(now, expected).speed;
    doubted += is_doubted ? 1 : 0;
    estimate = is_doubted ? expected.vx : now.speed;
  }
  return doubted;
}

/// Wheels that were locked spin up again, and take 4 % of the speed of `udacity`.
TEST(SensorWatch, AcceptsASpeedThatThePlaceConfirms) {
  Random random(7);
  for (int i = 0; i < 300; ++i) {
    const double lost = (i % 2 == 0 ? 1.0 : -1.0) * random.uniform(1.05, 1.6);
    const double share = random.uniform(), cycle = random.uniform(0.02, 0.16);
    EXPECT_LE(doubts_of_a_loss(lost, share, cycle, true), 1) << lost << ' ' << share << ' ' << cycle;
    EXPECT_GT(doubts_of_a_loss(lost, share, cycle, false), 1.0 / cycle)
        << lost << ' ' << share << ' ' << cycle;
  }
}

/// A command that acts 60 ms late turns the car by more than a calm one's limit.
TEST(SensorWatch, IsNotSureOfACarWhoseWheelsSwing) {
  for (const double swing : {0.05, 0.3}) {
    SensorWatch watch{kLength, kWheelbase};
    for (int i = 0; i < 100; ++i) {
      model::State car = car_at(kCycle * i, 0.0);
      if (i == 99) car.steer = swing;
      watch.see(measured(kCycle * i, car), car);
    }
    EXPECT_EQ(watch.is_sure(), swing < 0.1) << swing;
  }
}

TEST(SensorWatch, TellsLateMeasurementsFromOtherPlaces) {
  for (const double age : {0.05, 0.1, 0.3, 0.8, 1.5}) {
    const auto late = [=](model::Measurement& now) { now = measured_late(now.time, age, kYawRate); };
    const SensorDoubts doubts = doubts_of(late, kCycle);
    EXPECT_TRUE(doubts.late && doubts.is_old) << age;
    EXPECT_FALSE(doubts.place || doubts.heading || doubts.speed) << age;
  }
}

/// A sensor is not late by seconds: then it is another place.
TEST(SensorWatch, TellsAPlaceOfLongAgoFromALateMeasurement) {
  const auto long_ago = [](model::Measurement& now) { now = measured_late(now.time, 3.0, 0.0); };
  const SensorDoubts doubts = doubts_of(long_ago, kCycle, 0.0);
  EXPECT_TRUE(doubts.place);
  EXPECT_FALSE(doubts.late || doubts.is_old || doubts.heading || doubts.speed);
}

TEST(SensorWatch, AcceptsMeasurementsOfNowAgain) {
  SensorWatch watch{kLength, kWheelbase};
  double ended = 0.0;
  for (double time = 0.0; time < 12.0; time += kCycle) {
    const model::State expected = car_at(time, kYawRate);
    const bool is_late = time >= 5.0 && time < 7.0;
    const SensorDoubts& doubts = watch.see(measured_late(time, is_late ? 0.5 : 0.0, kYawRate), expected);
    EXPECT_EQ(doubts.is_old, is_late) << time;
    if (!doubts.late && ended == 0.0 && time > 5.1) ended = time;
  }
  EXPECT_NEAR(ended, 7.0 + SensorWatch::kAgreeing, 0.1);
}

/// A place that is accepted after a trial says nothing of the age of measurements: the start of the car does.
TEST(SensorWatch, WatchesTheStartOfACarWhoseMeasurementsWereLate) {
  Random random{3};
  for (const auto& [lag, noise] : {std::pair{0.0, 0.0}, {0.0, 0.3}, {0.4, 0.0}}) {
    SensorWatch watch{kLength, kWheelbase};
    for (double time = 0.0; time < 5.2; time += kCycle)
      watch.see(measured_late(time, time < 5.0 ? 0.0 : 0.5, kYawRate), car_at(time, kYawRate));
    watch.reset();
    for (double time = 5.2, speed = 0.0; time < 10.0; time += kCycle) {
      const model::State expected{.vx = speed + (time > 8.0 ? 3.0 * kCycle : 0.0)};
      speed = std::max(0.0, 3.0 * (time - 8.0 - lag));
      const bool late = watch.see(measured(time, {.vx = speed + noise * random.normal()}), expected).late;
      const bool is_sure = time < 6.1 || (time > 7.5 && time < 8.0) || time > 8.7;
      EXPECT_TRUE(!is_sure || late == (time < 6.1 || (time > 8.7 && lag > 0.0))) << time;
    }
  }
}

/// The way driven in a silence is not known.
TEST(SensorWatch, DoubtsNothingAfterASilence) {
  SensorWatch watch{kLength, kWheelbase};
  for (double time = 0.0; time < 30.0; time += kCycle) {
    if (time > 5.0 && time < 7.0) continue;
    const model::State expected = car_at(time, kYawRate);
    const SensorDoubts& doubts = watch.see(measured(time, expected), expected);
    EXPECT_FALSE(doubts.late || doubts.place || doubts.heading || doubts.speed) << time;
  }
}

/// Of longer motions nothing is known then.
TEST(SensorWatch, DoubtsADriftSoonAfterASilence) {
  SensorWatch watch{kLength, kWheelbase};
  double found = 0.0, off = 0.0;  // of the estimate, which follows
  for (double time = 0.0; time < 11.0 && found == 0.0; time += kCycle) {
    if (time > 5.0 && time < 7.0) continue;
    model::State expected = car_at(time, 0.0);
    model::Measurement now = measured(time, expected);
    expected.x += off;
    off = std::max(0.0, 0.9 * (time - 9.04));
    now.x += off;
    if (watch.see(now, expected).place) found = time;
  }
  EXPECT_GT(found, 9.04);
  EXPECT_LT(found, 9.6);
}

TEST(SensorWatch, NeverAcceptsAPlaceBecauseItLasts) {
  SensorWatch watch{kLength, kWheelbase};
  for (double time = 0.0; time < 300.0; time += kCycle) {
    const model::State expected = car_at(time, kYawRate);
    model::Measurement now = measured(time, expected);
    if (time >= 5.0) now.y += 6.0;
    EXPECT_EQ(watch.see(now, expected).place, time >= 5.0);
  }
}

TEST(SensorWatch, LeavesACarThatSlidesAlone) {
  SensorWatch watch{kLength, kWheelbase};
  for (double time = 0.0; time < 20.0; time += kCycle) {
    const model::State expected = car_at(time, 0.0);
    model::Measurement now = measured(time, expected);
    // The slide begins little by little: the model is wrong by more in each step.
    const double slide = std::clamp(0.5 * (time - 10.0), 0.0, 1.0);
    now.psi += 0.15 * slide;
    now.y += 0.5 * slide;
    const SensorDoubts& doubts = watch.see(now, expected);
    EXPECT_FALSE(doubts.late || doubts.heading || doubts.speed || doubts.place) << time;
  }
}

}  // namespace
}  // namespace chicane::safety
