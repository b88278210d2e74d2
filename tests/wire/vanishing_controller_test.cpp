// SPDX-License-Identifier: MIT
// A controller that vanishes at speed: our controller and our car at both ends of the messages, in simulated
// time.

#include <variant>

#include "chicane/protocol/udacity_codec.hpp"
#include "chicane/run/control_cycle.hpp"
#include "chicane/run/make.hpp"
#include "chicane/sim/sensor.hpp"
#include "chicane/sim/world.hpp"
#include "chicane/wire/simulate.hpp"
#include "support/chicane_test.hpp"
#include "support/runs.hpp"
#include "support/slow_tests.hpp"

namespace chicane::wire {
namespace {

constexpr double kLast = 45.0;  // [s] the first lap: later some stops from beyond 37 m/s end beside the road
constexpr double kBetween = kDrivesAll ? 2.3 : 6.9;  // [s]
constexpr double kPeriod = 0.12;  // [s] of the original controllers: 100 ms of sleep, 20 ms of turn-around

struct Vanished {
  double least_edge = 1e9;  ///< after that [m]
  double speed_then = 0.0;  ///< [m/s]
  double speed_at_end = 0.0;
};

Vanished vanish(scenario::Scenario scenario, double moment) {
  scenario.guard.road = safety::GuardRoad::kWaypoints;
  const road::Track track = run::make_track(scenario).value();
  const road::Track waypoints = run::make_waypoints(track).value();
  const std::unique_ptr<sim::Plant> plant = run::make_plant(scenario).value();
  sim::World world(*plant, track);
  sim::Sensor sensor(scenario.sensor, scenario.seed);
  run::ControlCycle cycle(run::make_controller(scenario).value(), scenario, nullptr);
  CommandReceiver receiver(scenario.vehicle, scenario.guard.receiver);
  auto frame = std::make_unique<telemetry::Frame>();
  world.place(track.start_s(), track.start_d());
  Vanished outcome;
  double next = 0.0;
  while (world.time() < moment + 12.0) {
    if (world.time() >= next - 1e-9 && world.time() < moment) {
      model::Measurement now = sensor.sample(world.time(), *plant);
      sim::select_waypoints(waypoints, {now.x, now.y, now.psi}, scenario.waypoints_sent, now);
      static_cast<void>(receiver.sampled(world.time()));
      frame->measurement =
          std::get<model::Measurement>(protocol::parse_telemetry(protocol::encode_telemetry(now)));
      frame->measurement.time = world.time() + 100.0;  // the controller's clock is another one
      frame->measurement.delay = kPeriod;
      cycle.step({.interval = kPeriod}, *frame);
      const std::string text =
          protocol::encode_steer(frame->result.command, frame->result.plan, {}, cycle.stop(), frame->time);
      receiver.answered(std::get<protocol::UdacitySteer>(protocol::parse_reply(text)));
      next += kPeriod;
      outcome.speed_then = plant->output().speed;
    }
    world.advance(receiver.act(world.time(), plant->output().speed));
    if (world.time() > moment) outcome.least_edge = std::min(outcome.least_edge, world.state().edge_distance);
  }
  outcome.speed_at_end = plant->output().speed;
  return outcome;
}

class AControllerThatVanishes : public ::testing::TestWithParam<std::tuple<const char*, const char*>> {
 protected:
  [[nodiscard]] static scenario::Scenario scenario() {
    return test::scenario_of({{"track", std::get<0>(GetParam())}, {"car", std::get<1>(GetParam())}});
  }
};

TEST_P(AControllerThatVanishes, LeavesTheCarStandingOnTheRoadWhereItSentStopPlans) {
  for (double moment = 3.1; moment < kLast; moment += kBetween) {
    const Vanished outcome = vanish(scenario(), moment);
    EXPECT_GE(outcome.least_edge, 0.0) << moment << " s, from " << outcome.speed_then << " m/s";
    EXPECT_LT(outcome.speed_at_end, 0.1) << moment;
  }
}

INSTANTIATE_TEST_SUITE_P(TracksAndCars, AControllerThatVanishes,
                         ::testing::Combine(::testing::Values("lakeside", "oval", "hairpins", "speedway"),
                                            ::testing::Values("udacity", "road-car")),
                         [](const auto& test) {
                           std::string name =
                               std::string(std::get<0>(test.param)) + "_" + std::get<1>(test.param);
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace chicane::wire
