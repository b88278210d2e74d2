// SPDX-License-Identifier: MIT
#include "chicane/safety/fallback.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>

#include "chicane/base/random.hpp"

namespace chicane::safety {
namespace {

using controller::Plan;
using controller::Rung;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

model::Measurement driving(double speed) {
  model::Measurement now;
  now.speed = speed;
  return now;
}

/// A plan of `size` points, 0.1 s apart from `start`, whose steering counts 0.01, 0.02, ...
std::unique_ptr<Plan> counting_plan(double start, int size) {
  auto plan = std::make_unique<Plan>();
  plan->size = size;
  for (int i = 0; i < size; ++i) {
    plan->points[static_cast<std::size_t>(i)] = {start + 0.1 * i, 0.0, 0.0, 0.0, 20.0, {0.01 * (i + 1), 0.5}};
  }
  return plan;
}

TEST(Fallback, GivesTheCommandOfTheLastPlanForTheTimeThatHasCome) {
  Fallback fallback{model::VehicleParams{}};
  fallback.accept(*counting_plan(10.0, 8));
  const auto early = fallback.command(10.15, driving(20.0));
  EXPECT_EQ(early.rung, Rung::kShiftedPlan);
  EXPECT_DOUBLE_EQ(early.command.steer, 0.02);
  EXPECT_DOUBLE_EQ(early.command.throttle, 0.5);
  EXPECT_DOUBLE_EQ(fallback.command(10.45, driving(20.0)).command.steer, 0.05);
}

TEST(Fallback, WalksDownTheLadderAsTimePasses) {
  const model::VehicleParams vehicle;
  Fallback fallback{vehicle};
  fallback.accept(*counting_plan(10.0, 20));
  EXPECT_EQ(fallback.command(10.45, driving(20.0)).rung, Rung::kShiftedPlan);

  const auto hold = fallback.command(10.55, driving(20.0));
  EXPECT_EQ(hold.rung, Rung::kHoldAndBrake);
  EXPECT_DOUBLE_EQ(hold.command.steer, 0.05);  // the wheel stays where the plan last put it
  EXPECT_DOUBLE_EQ(hold.command.throttle, -Fallback::kGentleBraking * vehicle.brake_throttle_limit);

  const auto brake = fallback.command(11.6, driving(20.0));
  EXPECT_EQ(brake.rung, Rung::kBrake);
  EXPECT_DOUBLE_EQ(brake.command.steer, 0.05);
  EXPECT_DOUBLE_EQ(brake.command.throttle, -vehicle.brake_throttle_limit);
}

/// The same plan along x at 20 m/s: 2 m from point to point.
std::unique_ptr<Plan> moving_plan(double start, int size) {
  auto plan = counting_plan(start, size);
  for (int i = 0; i < size; ++i) plan->points[static_cast<std::size_t>(i)].x = 2.0 * i;
  return plan;
}

TEST(Fallback, SteersAlongThePlansPathWhileItBrakes) {
  model::VehicleParams neutral;
  neutral.cornering_front = neutral.cornering_rear = 5.0;  // then equation 4 leaves the angle as planned
  Fallback fallback{neutral};
  fallback.accept(*moving_plan(10.0, 30));
  for (int i = 1; i <= 5; ++i) static_cast<void>(fallback.command(10.0 + 0.1 * i, driving(20.0)));
  // 10 m driven; at 10 m/s it takes as long again to reach each further point.
  const auto hold = fallback.command(10.75, driving(10.0));
  EXPECT_EQ(hold.rung, Rung::kHoldAndBrake);
  EXPECT_DOUBLE_EQ(hold.command.steer, 0.07);  // 12.5 m: the seventh point
  EXPECT_DOUBLE_EQ(fallback.command(10.95, driving(10.0)).command.steer, 0.08);
}

TEST(Fallback, BrakesToStopWhereThePlanEnds) {
  const model::VehicleParams vehicle;
  Fallback fallback{vehicle};
  fallback.accept(*moving_plan(10.0, 7));  // 12 m long; 20 m/s need far more
  const auto hold = fallback.command(10.7, driving(20.0));
  EXPECT_EQ(hold.rung, Rung::kHoldAndBrake);
  EXPECT_DOUBLE_EQ(hold.command.throttle, -vehicle.brake_throttle_limit);
}

TEST(Fallback, CountsItsSpeedOnWhenNobodyTellsIt) {
  Fallback fallback{model::VehicleParams{}};
  fallback.accept(*moving_plan(10.0, 5));
  double throttle = -1.0;
  double time = 10.0;
  while (throttle < 0.0 && time < 30.0) {
    time += 0.1;
    throttle = fallback.command(time, driving(kNaN)).command.throttle;
    if (time < 11.0) throttle = -1.0;
  }
  // 20 m/s at half of 8.7 m/s² take 4.6 s; fading takes its time.
  EXPECT_GT(time, 13.0);
  double last = throttle;
  for (int i = 0; i < 100; ++i) last = fallback.command(time += 0.1, driving(kNaN)).command.throttle;
  EXPECT_GT(last, -0.2 * model::VehicleParams{}.brake_throttle_limit)
      << "0.013 m/s² of the reverse gear, less than the drag: a blind car that stands does not back up";
}

TEST(Fallback, DoesNotReadBeyondTheEndOfAShortPlan) {
  Fallback fallback{model::VehicleParams{}};
  fallback.accept(*counting_plan(10.0, 3));
  EXPECT_EQ(fallback.command(10.2, driving(20.0)).rung, Rung::kShiftedPlan);
  EXPECT_EQ(fallback.command(10.25, driving(20.0)).rung, Rung::kHoldAndBrake);
}

TEST(Fallback, ClimbsBackUpWithTheNextUsablePlan) {
  Fallback fallback{model::VehicleParams{}};
  EXPECT_EQ(fallback.command(0.0, driving(20.0)).rung, Rung::kHoldAndBrake);
  EXPECT_EQ(fallback.command(2.0, driving(20.0)).rung, Rung::kBrake);
  fallback.accept(*counting_plan(2.1, 8));
  EXPECT_EQ(fallback.command(2.2, driving(20.0)).rung, Rung::kShiftedPlan);
}

TEST(Fallback, ReachesTheLastRungAlsoWithoutAClock) {
  for (const double time : {kNaN, -5.0}) {  // not finite; running backwards
    Fallback fallback{model::VehicleParams{}};
    fallback.accept(*counting_plan(10.0, 8));
    Rung rung = Rung::kController;
    for (int i = 0; i < 20; ++i) rung = fallback.command(time, driving(20.0)).rung;
    EXPECT_EQ(rung, Rung::kBrake) << time;
  }
}

TEST(Fallback, FadesTheBrakeTowardsStandstill) {
  Fallback fallback{model::VehicleParams{}};
  EXPECT_EQ(fallback.command(0.0, driving(0.0)).command.throttle, 0.0);
  const double slow = fallback.command(0.1, driving(1.0)).command.throttle;
  const double fast = fallback.command(0.2, driving(20.0)).command.throttle;
  EXPECT_LT(slow, 0.0);
  EXPECT_LT(fast, slow);
  EXPECT_EQ(fallback.command(0.3, driving(kNaN)).command.throttle, fast);
}

TEST(Fallback, KeepsThePlanBeforeTheFirstPointThatIsNotFinite) {
  Fallback fallback{model::VehicleParams{}};
  auto plan = counting_plan(10.0, 8);
  plan->points[3].command.steer = kNaN;
  fallback.accept(*plan);
  EXPECT_EQ(fallback.command(10.15, driving(20.0)).rung, Rung::kShiftedPlan);
  EXPECT_EQ(fallback.command(10.35, driving(20.0)).rung, Rung::kHoldAndBrake);
}

TEST(Fallback, ForgetsEverythingOnReset) {
  Fallback fallback{model::VehicleParams{}};
  fallback.accept(*counting_plan(10.0, 8));
  fallback.reset();
  const auto answer = fallback.command(10.1, driving(20.0));
  EXPECT_EQ(answer.rung, Rung::kHoldAndBrake);
  EXPECT_EQ(answer.command.steer, 0.0);
}

TEST(Fallback, StaysFiniteAndInRangeForAnyPlanAndTime) {
  const model::VehicleParams vehicle;
  Fallback fallback{vehicle};
  Random random{11};
  const auto any = [&] {
    return random.bits() % 2U == 0U ? std::bit_cast<double>(random.bits()) : random.uniform(-2.0, 2.0);
  };
  const auto plan = std::make_unique<Plan>();
  for (int turn = 0; turn < 2'000; ++turn) {
    plan->size = static_cast<int>(random.bits() % 600U) - 100;  // also sizes that no plan may have
    for (controller::PlanPoint& point : plan->points)
      point = {any(), any(), any(), any(), any(), {any(), any()}};
    fallback.accept(*plan);
    for (int i = 0; i < 10; ++i) {
      const auto answer = fallback.command(any(), driving(any()));
      ASSERT_TRUE(std::isfinite(answer.command.steer) && std::isfinite(answer.command.throttle));
      ASSERT_LE(std::fabs(answer.command.steer), vehicle.steer_limit);
      ASSERT_LE(std::fabs(answer.command.throttle), 1.0);
    }
  }
}

}  // namespace
}  // namespace chicane::safety
