// SPDX-License-Identifier: MIT
#include "chicane/safety/measurement_monitor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "chicane/base/random.hpp"

namespace chicane::safety {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kCycle = 0.04;  // [s]

/// Straight on along x at 20 m/s, measured each 40 ms.
model::Measurement at(int cycle, double speed = 20.0) {
  model::Measurement now;
  now.time = kCycle * cycle;
  now.x = speed * now.time;
  now.speed = speed;
  now.waypoint_count = 6;
  return now;
}

/// What a perfect estimator expects of the same car.
model::State expected(int cycle, double speed = 20.0) {
  return {.x = speed * kCycle * cycle, .y = 0.0, .psi = 0.0, .vx = speed};
}

const Findings& look(MeasurementMonitor& monitor, const model::Measurement& now, const model::State& state) {
  const model::Measurement& checked = monitor.check(now, &state);
  EXPECT_EQ(checked.waypoint_count, now.waypoint_count);
  return monitor.findings();
}

bool is_plausible(const Findings& f) {
  return !f.unmeasured && !f.frozen && !f.speed_mismatch && !f.heading_jump && !f.position_jump;
}

TEST(MeasurementMonitor, AcceptsACarThatDrivesBrakesAndTurns) {
  MeasurementMonitor monitor{4.5, 2.7};
  double x = 0.0;
  double y = 0.0;
  for (int i = 0; i < 50; ++i) {
    model::Measurement now = at(i);
    now.speed = 20.0 - 9.0 * now.time;
    now.psi = 0.5 * now.time;
    now.x = x;
    now.y = y;
    const model::State state{.x = x, .y = y, .psi = now.psi, .vx = now.speed};
    EXPECT_TRUE(is_plausible(look(monitor, now, state))) << i;
    x += kCycle * now.speed * std::cos(now.psi);
    y += kCycle * now.speed * std::sin(now.psi);
  }
}

/// 30 m/s on a circle, turning by 2.9 rad/s: in a second the car has moved by two thirds of the way it drove.
/// Its speed is measured as `unit` times what it is.
Findings after_a_hairpin(double unit) {
  constexpr double kSpeed = 30.0, kRate = 2.9;
  MeasurementMonitor monitor{4.5, 2.7};
  Findings found;
  for (int i = 0; i < 50; ++i) {
    model::Measurement now = at(i);
    now.psi = kRate * now.time;
    now.x = kSpeed / kRate * std::sin(now.psi);
    now.y = kSpeed / kRate * (1.0 - std::cos(now.psi));
    now.speed = unit * kSpeed;
    const model::State state{.x = now.x, .y = now.y, .psi = now.psi, .vx = now.speed, .r = kRate};
    const Findings& look_now = look(monitor, now, state);
    found.speed_mismatch |= look_now.speed_mismatch;
  }
  return found;
}

TEST(MeasurementMonitor, AcceptsACarInAHairpin) {
  EXPECT_FALSE(after_a_hairpin(1.0).speed_mismatch);
  EXPECT_TRUE(after_a_hairpin(2.24).speed_mismatch) << "miles per hour";
  EXPECT_TRUE(after_a_hairpin(0.4).speed_mismatch);
}

/// Counted on with the estimate's own slip, a place would tell the estimate that its slip is right.
TEST(MeasurementMonitor, HandsOnNoPlaceAfterAJump) {
  for (const double side : {1.0, -1.0}) {
    MeasurementMonitor monitor{4.5, 2.7};
    for (int i = 0; i < 200; ++i) {
      model::Measurement now = at(i);
      const model::State expected{.x = now.x, .y = now.y, .psi = now.psi, .vx = now.speed, .vy = 0.5 * side};
      const bool is_wrong = i >= 150;
      if (is_wrong) now.y += 5.0 * side;
      const model::Measurement& seen = monitor.check(now, &expected);
      ASSERT_EQ(std::isnan(seen.x), is_wrong) << i;
      ASSERT_EQ(std::isnan(seen.y), is_wrong) << i;
    }
  }
}

TEST(MeasurementMonitor, AcceptsACarThatStands) {
  MeasurementMonitor monitor{4.5, 2.7};
  for (int i = 0; i < 100; ++i) {
    model::Measurement standing;
    standing.time = kCycle * i;
    EXPECT_TRUE(is_plausible(look(monitor, standing, {})));
  }
}

TEST(MeasurementMonitor, AcceptsTheNoiseOfAGoodReceiver) {
  MeasurementMonitor monitor{4.5, 2.7};
  Random random(3);
  for (int i = 0; i < 20000; ++i) {
    model::Measurement now = at(i);
    now.x += 0.5 * random.normal();
    now.y += 0.5 * random.normal();
    now.psi += 0.017 * random.normal();
    now.speed += 0.3 * random.normal();
    ASSERT_TRUE(is_plausible(look(monitor, now, expected(i)))) << i;
  }
}

TEST(MeasurementMonitor, SaysWhatIsNotMeasured) {
  MeasurementMonitor monitor{4.5, 2.7};
  EXPECT_TRUE(is_plausible(look(monitor, at(0), expected(0))));
  for (double model::Measurement::*field : {&model::Measurement::x, &model::Measurement::y,
                                            &model::Measurement::psi, &model::Measurement::speed}) {
    model::Measurement now = at(1);
    now.*field = kNaN;
    EXPECT_TRUE(look(monitor, now, expected(1)).unmeasured);
  }
  EXPECT_TRUE(look(monitor, at(0), expected(0)).unmeasured) << "time ran backwards";
}

TEST(MeasurementMonitor, FindsAFrozenSensorInACarThatMoves) {
  MeasurementMonitor monitor{4.5, 2.7};
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(is_plausible(look(monitor, at(i), expected(i))));
  for (int i = 10; i < 200; ++i) {
    model::Measurement frozen = at(9);
    frozen.time = kCycle * i;
    EXPECT_TRUE(look(monitor, frozen, expected(i)).frozen)
        << "0.8 m should have been driven; it never ends by itself";
    EXPECT_TRUE(std::isnan(monitor.check(frozen, nullptr).x)) << i;
  }
}

TEST(MeasurementMonitor, RejectsAJumpHoweverLongItLasts) {
  for (const double side : {5.0, -5.0}) {
    MeasurementMonitor monitor{4.5, 2.7};
    for (int i = 0; i < 10; ++i) EXPECT_TRUE(is_plausible(look(monitor, at(i), expected(i))));
    for (int i = 10; i < 150; ++i) {  // 112 m: a stop from any speed here
      model::Measurement jumped = at(i);
      jumped.y += side;
      jumped.psi += 1e-4 * (i % 2);  // another one each time: the sensor is not stuck
      EXPECT_TRUE(look(monitor, jumped, expected(i)).position_jump) << i;
      const model::State there = expected(i);
      const model::Measurement& checked = monitor.check(jumped, &there);
      EXPECT_TRUE(std::isnan(checked.x + checked.y));
    }
    EXPECT_TRUE(is_plausible(look(monitor, at(151), expected(151)))) << "it agrees again";
  }
}

/// What is expected drifts while the place is rejected, and may come upon a place that is still wrong.
TEST(MeasurementMonitor, AcceptsAPlaceAgainOnlyWhenItJumpsBack) {
  for (const double side : {5.0, -5.0}) {
    MeasurementMonitor monitor{4.5, 2.7};
    for (int i = 0; i < 10; ++i) look(monitor, at(i), expected(i));
    for (int i = 10; i < 150; ++i) {
      model::Measurement jumped = at(i);
      jumped.y += side;
      model::State drifted = expected(i);
      drifted.y += side * (i - 10) / 140.0;
      EXPECT_TRUE(look(monitor, jumped, drifted).position_jump) << i;
    }
    model::State drifted = expected(150);
    drifted.y += 0.4 * side;
    EXPECT_FALSE(look(monitor, at(150), drifted).position_jump) << "it jumps back";
  }
}

TEST(MeasurementMonitor, KeepsWhatIsPlausibleBesideAJump) {
  MeasurementMonitor monitor{4.5, 2.7};
  for (int i = 0; i < 10; ++i) look(monitor, at(i), expected(i));
  model::Measurement jumped = at(10);
  jumped.y += 5.0;
  jumped.speed += 0.01;
  jumped.psi += 0.001;
  const model::State there = expected(10);
  const model::Measurement& checked = monitor.check(jumped, &there);
  EXPECT_EQ(checked.speed, jumped.speed);
  EXPECT_EQ(checked.psi, jumped.psi);
}

// A sensor that is stuck and noisy repeats in what has no noise. Its heading turned the car off the road.
TEST(MeasurementMonitor, AcceptsNothingThatRepeatsBesideADoubt) {
  using Change = void (*)(model::Measurement&, int);
  const Change changes[] = {[](model::Measurement& m, int i) { m.x += i % 2 == 0 ? 0.7 : -0.7; },
                            [](model::Measurement& m, int) { m.y += 6.0; },
                            [](model::Measurement& m, int) { m.speed = 0.0; }};
  for (const Change& change : changes) {
    MeasurementMonitor monitor{4.5, 2.7};
    const auto turning = [](int cycle) {
      model::Measurement now = at(cycle);
      now.psi = 0.3 * now.time;
      now.x = 20.0 / 0.3 * std::sin(now.psi);
      now.y = 20.0 / 0.3 * (1.0 - std::cos(now.psi));
      now.speed += 0.001 * cycle;
      return now;
    };
    const auto state = [&](int cycle) {
      const model::Measurement m = turning(cycle);
      return model::State{.x = m.x, .y = m.y, .psi = m.psi, .vx = m.speed};
    };
    for (int i = 0; i < 100; ++i) EXPECT_TRUE(is_plausible(look(monitor, turning(i), state(i)))) << i;
    for (int i = 100; i < 150; ++i) {
      model::Measurement stuck = turning(100);
      stuck.time = kCycle * i;
      change(stuck, i);
      const model::State there = state(i);
      const model::Measurement& checked = monitor.check(stuck, &there);
      if (i < 110) continue;
      EXPECT_TRUE(monitor.findings().frozen) << i;
      EXPECT_TRUE(std::isnan(checked.psi) && std::isnan(checked.speed) && std::isnan(checked.x)) << i;
    }
    EXPECT_FALSE(look(monitor, turning(150), state(150)).frozen);
  }
}

TEST(MeasurementMonitor, RejectsASpeedThatNoBrakingExplains) {
  MeasurementMonitor monitor{4.5, 2.7};
  for (int i = 0; i < 10; ++i) look(monitor, at(i), expected(i));
  model::Measurement zero = at(10);
  zero.speed = 0.0;
  EXPECT_TRUE(look(monitor, zero, expected(10)).speed_mismatch);
  zero.time += kCycle;
  EXPECT_TRUE(look(monitor, zero, {.x = zero.x, .vx = 0.5}).speed_mismatch)
      << "a zero does not become true because the car has come to rest";
  EXPECT_FALSE(look(monitor, at(12), expected(12)).speed_mismatch);
}

TEST(MeasurementMonitor, FindsASpeedInAnotherUnitByTheDisplacement) {
  MeasurementMonitor monitor{4.5, 2.7};
  int found_at = 0;
  for (int i = 0; i < 100 && found_at == 0; ++i) {
    model::Measurement now = at(i);
    now.speed *= 2.236936;  // mph sent as m/s, from the first message on: the expectation follows it
    model::State state = expected(i);
    state.vx = now.speed;
    if (look(monitor, now, state).speed_mismatch) found_at = i;
  }
  EXPECT_GT(found_at, 0);
  EXPECT_LT(kCycle * found_at, 0.5);
}

TEST(MeasurementMonitor, RejectsAYawThatNoCarTurnsTo) {
  MeasurementMonitor monitor{4.5, 2.7};
  for (int i = 0; i < 10; ++i) look(monitor, at(i), expected(i));
  model::Measurement turned = at(10);
  turned.psi = -0.6;
  EXPECT_TRUE(look(monitor, turned, expected(10)).heading_jump);
  turned.psi = 6.283185307 - 0.05;
  EXPECT_FALSE(look(monitor, turned, expected(10)).heading_jump) << "angles wrap";
}

TEST(MeasurementMonitor, NeverAcceptsAPlaceBecauseItLasts) {
  MeasurementMonitor monitor{4.5, 2.7};
  for (int i = 0; i < 10; ++i) look(monitor, at(i), expected(i));
  for (int i = 10; i < 100; ++i) {
    model::Measurement start;
    start.time = kCycle * i;
    start.x = -200.0;
    EXPECT_TRUE(look(monitor, start, expected(10)).position_jump) << "it stands elsewhere; cycle " << i;
  }
}

TEST(MeasurementMonitor, RejectsTheHeadingWherePlaceAndSpeedAreWrong) {
  MeasurementMonitor monitor{4.5, 2.7};
  for (int i = 0; i < 10; ++i) look(monitor, at(i), expected(i));
  model::Measurement now = at(10);
  now.y += 6.0;
  EXPECT_FALSE(look(monitor, now, expected(10)).heading_jump) << "the place alone";
  now = at(11);
  now.y += 6.0;
  now.speed = 0.0;
  EXPECT_TRUE(look(monitor, now, expected(11)).heading_jump) << "place and speed";
}

}  // namespace
}  // namespace chicane::safety
