// SPDX-License-Identifier: MIT
#include "chicane/safety/fallback.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "chicane/base/random.hpp"
#include "chicane/model/actuator.hpp"

namespace chicane::safety {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

model::VehicleParams road_car() {
  model::VehicleParams vehicle;
  vehicle.steer_rate_limit = 1.5;
  vehicle.brake_throttle_limit = 1.0;
  return vehicle;
}

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

TEST(CommandGate, PassesANominalCommandBitForBit) {
  CommandGate gate{road_car()};
  Random random{7};
  double steer = 0.0;
  for (int i = 0; i < 10'000; ++i) {
    steer += random.uniform(-0.01, 0.01);
    steer = std::fmod(steer, 0.4);
    const model::Command asked{steer, random.uniform(-1.0, 1.0)};
    const model::Command sent =
        gate.pass(asked, 0.5);  // 0.5 s at 1.5 rad/s reaches every angle in (-0.4, 0.4) from near
    ASSERT_TRUE(same_bits(sent.steer, asked.steer));
    ASSERT_TRUE(same_bits(sent.throttle, asked.throttle));
  }
}

TEST(CommandGate, PassesTheLimitsThemselvesAndNegativeZero) {
  CommandGate gate{model::VehicleParams{}};
  const double limit = model::VehicleParams{}.steer_limit;
  for (const model::Command asked : {model::Command{limit, 1.0}, {-limit, -1.0}, {-0.0, -0.0}}) {
    const model::Command sent = gate.pass(asked, 0.1);
    EXPECT_TRUE(same_bits(sent.steer, asked.steer));
    EXPECT_TRUE(same_bits(sent.throttle, asked.throttle));
  }
}

TEST(CommandGate, ReplacesWhatIsNotFiniteByTheLastSteeringAndGentleBraking) {
  const model::VehicleParams vehicle;
  CommandGate gate{vehicle};
  ASSERT_EQ(gate.pass({0.2, 0.5}, 0.1), (model::Command{0.2, 0.5}));
  for (const double bad : {kNaN, -kNaN, kInfinity, -kInfinity}) {
    const model::Command steer = gate.pass({bad, 0.5}, 0.1);
    EXPECT_EQ(steer.steer, 0.2);
    EXPECT_EQ(steer.throttle, 0.5);
    const model::Command throttle = gate.pass({0.2, bad}, 0.1);
    EXPECT_EQ(throttle.steer, 0.2);
    EXPECT_DOUBLE_EQ(throttle.throttle, -0.4 * vehicle.brake_throttle_limit);
  }
}

TEST(CommandGate, ClampsToTheRange) {
  const model::VehicleParams vehicle;
  CommandGate gate{vehicle};
  const model::Command high = gate.pass({3.0, 7.0}, 0.1);
  EXPECT_EQ(high.steer, vehicle.steer_limit);
  EXPECT_EQ(high.throttle, 1.0);
  const model::Command low = gate.pass({-3.0, -7.0}, 0.1);
  EXPECT_EQ(low.steer, -vehicle.steer_limit);
  EXPECT_EQ(low.throttle, -1.0);
}

TEST(CommandGate, LimitsTheSteeringRateBothWays) {
  CommandGate gate{road_car()};
  const model::Command left = gate.pass({0.4, 0.0}, 0.1);
  EXPECT_DOUBLE_EQ(left.steer, 0.15);
  const model::Command right = gate.pass({-0.4, 0.0}, 0.1);
  EXPECT_NEAR(right.steer, 0.0, 1e-15);  // rounding of one addition and one subtraction
}

// f1tenth in full size: the wheel follows with 0.5 s. A limit of what is sent kept it from a third of its
// rate.
TEST(CommandGate, LimitsTheRateOfTheWheelBehindItsLag) {
  model::VehicleParams vehicle = road_car();
  vehicle.steer_lag = 0.5;
  vehicle.steer_rate_limit = 1.0;
  CommandGate free{vehicle};
  EXPECT_EQ(free.pass({0.4, 0.0}, 0.08).steer, 0.4);    // 0.8 rad/s of the wheel
  EXPECT_EQ(free.pass({-0.4, 0.0}, 0.08).steer, -0.4);  // 0.92 rad/s, from 0.06 rad
  CommandGate gate{vehicle};
  const model::Actuator unlimited{.low = -1.0, .high = 1.0, .lag = vehicle.steer_lag};
  Random random{11};
  double wheel = 0.0;
  int limited = 0;
  for (int i = 0; i < 2'000; ++i) {
    const bool is_hard = i % 50 < 25;
    const model::Command asked{is_hard ? 0.4 : random.uniform(-0.5, 0.1), 0.0};
    const model::Command sent = gate.pass(asked, 0.08);
    limited += std::fabs(asked.steer) <= vehicle.steer_limit && sent != asked ? 1 : 0;
    const double next = unlimited.next(wheel, sent.steer, 0.08);
    ASSERT_LE(std::fabs(next - wheel), 0.08 * vehicle.steer_rate_limit * (1.0 + 1e-12)) << i;
    wheel = next;
  }
  EXPECT_GT(limited, 50);
}

TEST(CommandGate, SkipsTheRateCheckWithoutAUsableElapsedTime) {
  for (const double elapsed : {0.0, -1.0, kNaN, kInfinity, -kInfinity}) {
    CommandGate gate{road_car()};
    EXPECT_EQ(gate.pass({0.4, 0.0}, elapsed).steer, 0.4) << elapsed;
  }
}

TEST(CommandGate, LimitsThePedalByItself) {
  for (const double pedal : {1.0001, -1.0001}) {
    CommandGate gate{road_car()};
    EXPECT_EQ(gate.pass({0.0, pedal}, 0.1).throttle, std::copysign(1.0, pedal));
  }
}

/// limited() looks ahead: what pass() would send, and nothing changes.
TEST(CommandGate, SaysWhatItWouldSendWithoutSendingIt) {
  CommandGate gate{road_car()};
  EXPECT_DOUBLE_EQ(gate.limited({0.4, 0.0}, 0.1).steer, 0.15);
  EXPECT_DOUBLE_EQ(gate.limited({0.4, 0.0}, 0.1).steer, 0.15);
  EXPECT_DOUBLE_EQ(gate.pass({0.4, 0.0}, 0.1).steer, 0.15);
}

TEST(CommandGate, ForgetsTheLastCommandOnReset) {
  CommandGate gate{model::VehicleParams{}};
  ASSERT_EQ(gate.pass({0.3, 0.0}, 0.1).steer, 0.3);
  gate.reset();
  EXPECT_EQ(gate.pass({kNaN, 0.0}, 0.1).steer, 0.0);
}

/// Any double at all: all bit patterns, with the special ones more often than chance gives them.
double hostile(Random& random) {
  constexpr double kSpecial[] = {kNaN, kInfinity, -kInfinity,      0.0, -0.0, 1e308, -1e308, 5e-324,
                                 1.0,  -1.0,      0.43633231299858};
  const std::uint64_t bits = random.bits();
  if (bits % 4U == 0U) return kSpecial[(bits >> 8U) % std::size(kSpecial)];
  if (bits % 4U == 1U) return random.uniform(-2.0, 2.0);
  return std::bit_cast<double>(random.bits());
}

TEST(CommandGate, LetsNothingOutOfBoundsThroughInAMillionHostileCommands) {
  const model::VehicleParams vehicle = road_car();
  CommandGate gate{vehicle};
  Random random{2024};
  double last = 0.0;
  for (int i = 0; i < 1'000'000; ++i) {
    const double elapsed = hostile(random);
    const model::Command command = gate.pass({hostile(random), hostile(random)}, elapsed);
    ASSERT_TRUE(std::isfinite(command.steer) && std::isfinite(command.throttle)) << i;
    ASSERT_LE(std::fabs(command.steer), vehicle.steer_limit) << i;
    ASSERT_LE(std::fabs(command.throttle), 1.0) << i;
    if (std::isfinite(elapsed) && elapsed > 0.0) {
      // 1e-15: the sum last + rate * elapsed is rounded once.
      ASSERT_LE(std::fabs(command.steer - last), vehicle.steer_rate_limit * elapsed + 1e-15) << i;
    }
    last = command.steer;
  }
}

TEST(CommandGate, DrivesTowardsTheSpeedThatTheParametersHoldTo) {
  model::VehicleParams car;
  EXPECT_EQ(drive_to_valid_speed(car, 1000.0), kInfinity);
  car.valid_speed = 20.0;
  EXPECT_GT(drive_to_valid_speed(car, 10.0), 10.0);
  EXPECT_NEAR(drive_to_valid_speed(car, 21.0), 0.0, 1e-9);
  EXPECT_LT(drive_to_valid_speed(car, 22.0), 0.0);
}

}  // namespace
}  // namespace chicane::safety
