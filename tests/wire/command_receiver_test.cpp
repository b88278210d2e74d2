// SPDX-License-Identifier: MIT
#include "chicane/wire/command_receiver.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <variant>

#include "chicane/protocol/udacity_codec.hpp"
#include "chicane/run/control_cycle.hpp"
#include "chicane/run/make.hpp"
#include "chicane/sim/sensor.hpp"
#include "chicane/sim/world.hpp"

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
  EXPECT_TRUE(receiver.is_forsaken());
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
  EXPECT_FALSE(receiver.is_forsaken());
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
  steer.stop.size = 2;
  steer.stop.points[0] = {.time = 0.3, .distance = 0.0, .speed = 8.0, .command = {0.1, -0.2}};
  steer.stop.points[1] = {.time = 2.3, .distance = 8.0, .speed = 0.0, .command = {0.3, -0.2}};
  receiver.answered(steer);
  EXPECT_TRUE(receiver.sampled(5.1));
  EXPECT_EQ(receiver.act(5.29, 8.0).throttle, 1.0);  // 0.3 s after the telemetry that was sampled at 5.0
  EXPECT_DOUBLE_EQ(receiver.act(5.31, 8.0).steer, 0.1);
  EXPECT_NEAR(receiver.act(5.81, 8.0).steer, 0.2, 1e-9);  // half of the way
  EXPECT_LT(receiver.acting().throttle, 0.0);
}

/// Our controller and our car at both ends of the messages, in simulated time; the controller vanishes.
struct Outcome {
  double least_edge = 1e9;  ///< after that [m]
  double speed_then = 0.0;  ///< [m/s]
  double speed_at_end = 0.0;
};

Outcome vanish(scenario::Scenario scenario, double moment, bool has_plan = true) {
  scenario.guard.road = safety::GuardRoad::kWaypoints;
  const path::Track track = run::make_track(scenario).value();
  const path::Track waypoints = run::make_waypoints(track).value();
  const std::unique_ptr<sim::Plant> plant = run::make_plant(scenario).value();
  sim::World world(*plant, track);
  sim::Sensor sensor(scenario.sensor, scenario.seed);
  run::ControlCycle cycle(run::make_controller(scenario).value(), scenario, nullptr);
  CommandReceiver receiver(scenario.vehicle, scenario.guard.receiver);
  auto frame = std::make_unique<telemetry::Frame>();
  world.place(track.start_s(), track.start_d());
  Outcome outcome;
  double next = 0.0;
  while (world.time() < moment + 12.0) {
    if (world.time() >= next - 1e-9 && world.time() < moment) {
      model::Measurement now = sensor.sample(world.time(), *plant);
      sim::select_waypoints(waypoints, {now.x, now.y, now.psi}, scenario.waypoints_sent, now);
      EXPECT_TRUE(receiver.sampled(world.time()));
      frame->measurement =
          std::get<model::Measurement>(protocol::parse_telemetry(protocol::encode_telemetry(now)));
      frame->measurement.time = world.time() + 100.0;  // the controller's clock is another one
      frame->measurement.delay = kCycle;
      cycle.step({.interval = kCycle}, *frame);
      const std::string text =
          protocol::encode_steer(frame->result.command, frame->result.plan, {},
                                 has_plan ? cycle.stop() : safety::StopPlan{}, frame->time);
      receiver.answered(std::get<protocol::UdacitySteer>(protocol::parse_reply(text)));
      next += kCycle;
      outcome.speed_then = plant->output().speed;
    }
    world.advance(receiver.act(world.time(), plant->output().speed));
    if (world.time() > moment) outcome.least_edge = std::min(outcome.least_edge, world.state().edge_distance);
  }
  outcome.speed_at_end = plant->output().speed;
  return outcome;
}

TEST(AControllerThatVanishes, LeavesTheCarStandingOnTheRoadWhereItSentStopPlans) {
  for (const double moment : {4.0, 7.3, 10.1, 12.7, 14.2, 16.9, 19.4, 22.6, 25.8, 28.3, 31.7, 35.2, 41.3}) {
    const Outcome outcome = vanish({}, moment);
    EXPECT_GT(outcome.speed_then, 5.0) << moment;
    EXPECT_GE(outcome.least_edge, 0.0) << moment;
    EXPECT_LT(outcome.speed_at_end, 0.1) << moment;
  }
}

TEST(AControllerThatVanishes, LeavesTheCarOffTheRoadWhereTheLastCommandIsHeld) {
  scenario::Scenario as_original;
  as_original.guard.receiver = safety::Receiver::kHold;
  for (const double moment : {10.1, 16.9, 25.8})
    EXPECT_LT(vanish(as_original, moment).least_edge, 0.0) << moment;
}

TEST(AControllerThatVanishes, LeavesTheCarStandingSomewhereWhereItSentNoPlan) {
  for (const double moment : {10.1, 16.9, 25.8})
    EXPECT_LT(vanish({}, moment, false).speed_at_end, 0.1) << moment;
}

}  // namespace
}  // namespace chicane::wire
