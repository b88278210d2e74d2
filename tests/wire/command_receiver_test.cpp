// SPDX-License-Identifier: MIT
#include "chicane/wire/simulate.hpp"
#include "support/chicane_test.hpp"

namespace chicane::wire {
namespace {

constexpr double kCycle = 0.12;  // [s] of the original controllers: 100 ms of sleep, 20 ms of turn-around
const model::VehicleParams kCar;

protocol::UdacitySteer straight(double throttle) { return {.command = {.throttle = throttle}}; }

/// A receiver that has picked up commands; the last one acts.
struct Told {
  explicit Told(safety::Receiver kind = safety::Receiver::kStopPlan) : receiver(kCar, kind) {
    static_cast<void>(receiver.sampled(0.0));
  }
  /// Commands for `duration` [s], a cycle apart; when they end.
  double drive(double duration, double cycle = kCycle) {
    double time = 0.0;
    for (; time < duration; time += cycle) {
      receiver.answered(straight(1.0));
      static_cast<void>(receiver.act(time + 0.9 * cycle, 10.0));
      EXPECT_TRUE(receiver.sampled(time + cycle));
    }
    return time;
  }
  double throttle(double time, double speed = 10.0) { return receiver.act(time, speed).throttle; }
  CommandReceiver receiver;
};

TEST(CommandReceiver, StandsUntilTheFirstCommandHoweverLateItComes) {
  Told car;
  EXPECT_EQ(car.throttle(9.0, 0.0), 0.0);
  car.receiver.answered(straight(1.0));
  EXPECT_EQ(car.throttle(9.5, 0.0), 0.0);  // picked up with the next telemetry
  EXPECT_TRUE(car.receiver.sampled(9.6));
  EXPECT_EQ(car.throttle(9.6, 0.0), 1.0);
}

TEST(CommandReceiver, BrakesWithTheLastSteeringAfterThreeOfItsControllersCycles) {
  for (const double cycle : {kCycle, 1.0}) {
    Told car;
    const double end = car.drive(20.0, cycle);
    EXPECT_EQ(car.throttle(end + 2.9 * cycle), 1.0);
    EXPECT_LT(car.throttle(end + 3.1 * cycle), 0.0);
    EXPECT_TRUE(car.receiver.is_timed_out());
  }
}

TEST(CommandReceiver, AnAnswerFromBeforeTheStopIsNotUsedTheNextOneIs) {
  Told car;
  const double end = car.drive(2.0);
  static_cast<void>(car.throttle(end + 2.0));
  car.receiver.answered(straight(0.5));
  EXPECT_FALSE(car.receiver.sampled(end + 2.1));
  EXPECT_LT(car.throttle(end + 2.1), 0.0);
  car.receiver.answered(straight(0.5));
  static_cast<void>(car.throttle(end + 2.15));
  EXPECT_TRUE(car.receiver.sampled(end + 2.2));
  EXPECT_EQ(car.throttle(end + 2.2), 0.5);
  EXPECT_FALSE(car.receiver.is_timed_out());
}

TEST(CommandReceiver, HoldsForEverWhereItIsToldAndForgetsAnAnswerOfAnEndedConnection) {
  Told car(safety::Receiver::kHold);
  const double end = car.drive(2.0);
  car.receiver.answered(straight(-1.0));
  car.receiver.disconnected();
  EXPECT_TRUE(car.receiver.sampled(end + kCycle));
  EXPECT_EQ(car.throttle(end + kCycle), 1.0);
  EXPECT_EQ(car.throttle(end + 60.0), 1.0) << "as the original";
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
