// SPDX-License-Identifier: MIT
#include "chicane/wire/simulate.hpp"
#include "support/chicane_test.hpp"

namespace chicane::wire {
namespace {

constexpr double kCycle = 0.12;  // [s] of the original controllers: 100 ms of sleep, 20 ms of turn-around
const model::VehicleParams kCar;

protocol::UdacitySteer straight(double throttle) { return {.command = {.throttle = throttle}}; }

/// A receiver that has picked up commands for `duration` [s], a cycle apart; what it was told last acts.
double driven(CommandReceiver& receiver, double duration, double cycle = kCycle) {
  double time = 0.0;
  static_cast<void>(receiver.sampled(time));
  for (; time < duration; time += cycle) {
    receiver.answered(straight(1.0));
    static_cast<void>(receiver.act(time + 0.9 * cycle, 10.0));
    EXPECT_TRUE(receiver.sampled(time + cycle));
  }
  return time;
}

TEST(CommandReceiver, StandsUntilTheFirstCommandHoweverLateItComes) {
  CommandReceiver receiver(kCar, safety::Receiver::kStopPlan);
  static_cast<void>(receiver.sampled(0.0));
  EXPECT_EQ(receiver.act(9.0, 0.0).throttle, 0.0);
  receiver.answered(straight(1.0));
  EXPECT_EQ(receiver.act(9.5, 0.0).throttle, 0.0);  // picked up with the next telemetry
  EXPECT_TRUE(receiver.sampled(9.6));
  EXPECT_EQ(receiver.act(9.6, 0.0).throttle, 1.0);
}

TEST(CommandReceiver, BrakesWithTheLastSteeringWhereNoPlanCame) {
  CommandReceiver receiver(kCar, safety::Receiver::kStopPlan);
  const double end = driven(receiver, 2.0);
  EXPECT_EQ(receiver.act(end + 0.3, 10.0).throttle, 1.0);  // three cycles are 0.36 s
  EXPECT_LT(receiver.act(end + 0.4, 10.0).throttle, 0.0);
  EXPECT_TRUE(receiver.is_timed_out());
}

TEST(CommandReceiver, HoldsForEverAsTheOriginalWhereItIsTold) {
  CommandReceiver receiver(kCar, safety::Receiver::kHold);
  const double end = driven(receiver, 2.0);
  EXPECT_EQ(receiver.act(end + 60.0, 10.0).throttle, 1.0);
}

TEST(CommandReceiver, AControllerThatIsSlowAsARuleIsNotSilent) {
  CommandReceiver receiver(kCar, safety::Receiver::kStopPlan);
  const double end = driven(receiver, 20.0, 1.0);
  EXPECT_EQ(receiver.act(end + 2.9, 10.0).throttle, 1.0);
  EXPECT_LT(receiver.act(end + 3.1, 10.0).throttle, 0.0);
}

TEST(CommandReceiver, AnAnswerFromBeforeTheStopIsNotUsedTheNextOneIs) {
  CommandReceiver receiver(kCar, safety::Receiver::kStopPlan);
  const double end = driven(receiver, 2.0);
  static_cast<void>(receiver.act(end + 2.0, 10.0));
  receiver.answered(straight(0.5));
  EXPECT_FALSE(receiver.sampled(end + 2.1));
  EXPECT_LT(receiver.act(end + 2.1, 10.0).throttle, 0.0);
  receiver.answered(straight(0.5));
  static_cast<void>(receiver.act(end + 2.15, 10.0));
  EXPECT_TRUE(receiver.sampled(end + 2.2));
  EXPECT_EQ(receiver.act(end + 2.2, 10.0).throttle, 0.5);
  EXPECT_FALSE(receiver.is_timed_out());
}

TEST(CommandReceiver, AnAnswerOfAnEndedConnectionIsForgotten) {
  CommandReceiver receiver(kCar, safety::Receiver::kHold);
  const double end = driven(receiver, 2.0);
  receiver.answered(straight(-1.0));
  receiver.disconnected();
  EXPECT_TRUE(receiver.sampled(end + kCycle));
  EXPECT_EQ(receiver.act(end + kCycle, 10.0).throttle, 1.0);
}

TEST(CommandReceiver, PlaysThePlanThatCameByTimeAndDistance) {
  CommandReceiver receiver(kCar, safety::Receiver::kStopPlan);
  static_cast<void>(receiver.sampled(5.0));
  protocol::UdacitySteer steer = straight(1.0);
  steer.stop.size = 3;
  steer.stop.points[0] = {.time = 0.3, .distance = 0.0, .speed = 8.0, .command = {0.1, -0.2}};
  steer.stop.points[1] = {.time = 0.9, .distance = 4.0, .speed = 5.0, .command = {0.2, -0.2}};
  steer.stop.points[2] = {.time = 2.3, .distance = 8.0, .speed = 0.0, .command = {0.3, -0.2}};
  receiver.answered(steer);
  EXPECT_TRUE(receiver.sampled(5.1));
  EXPECT_EQ(receiver.act(5.29, 8.0).throttle, 1.0);  // 0.3 s after the telemetry that was sampled at 5.0
  EXPECT_DOUBLE_EQ(receiver.act(5.31, 8.0).steer, 0.1);
  EXPECT_DOUBLE_EQ(receiver.act(5.79, 8.0).steer, 0.1);
  EXPECT_DOUBLE_EQ(receiver.act(5.81, 8.0).steer, 0.2);  // half of the way
  EXPECT_LT(receiver.acting().throttle, 0.0);
}

}  // namespace
}  // namespace chicane::wire
