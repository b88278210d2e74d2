// SPDX-License-Identifier: MIT
// A controller of ten lines drives a lap: what it is told, what it answers, and the world that answers back.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "chicane/protocol/library.hpp"
#include "chicane/run/make.hpp"
#include "chicane/sim/sensor.hpp"
#include "chicane/sim/world.hpp"

using namespace chicane;

// [controller]
/// Steers at the third waypoint it is shown and holds 10 m/s.
class ChaseThirdWaypoint final : public controller::Controller {
 public:
  const controller::StepResult& step(const model::Measurement& now, Deadline) noexcept override {
    const Vec2 ahead = now.waypoints[2] - Vec2(now.x, now.y);
    const double to_the_left = chicane::cos(now.psi) * ahead.y() - chicane::sin(now.psi) * ahead.x();
    const double curvature = 2.0 * to_the_left / std::max(1.0, ahead.squared_norm());  // of the circle there
    result_.command.steer = std::clamp(2.87 * curvature, -0.4, 0.4);
    result_.command.throttle = std::clamp(0.2 * (10.0 - now.speed) + 0.2, 0.0, 1.0);
    return result_;
  }
  void reset() noexcept override {}
  [[nodiscard]] std::string_view name() const noexcept override { return "chase-third-waypoint"; }

 private:
  controller::StepResult result_;
};
// [/controller]

/// One lap in virtual time, 25 commands a second that act at once.
int drive(controller::Controller& controller, sim::Plant& plant, const path::Track& track) {
  sim::World world(plant, track);
  sim::Sensor sensor({}, 1);
  const long steps = std::lround(0.04 / plant.step_length());
  while (world.state().lap < 1 && world.time() < 600.0) {
    model::Measurement now = sensor.sample(world.time(), plant);
    sim::select_waypoints(track, {now.x, now.y, now.psi}, 6, now);
    const model::Command command = controller.step(now, Deadline::never()).command;
    for (long i = 0; i < steps; ++i) world.advance(command);
  }
  std::printf("%.1f s, %d times off the road\n", world.state().last_lap_time, world.state().off_track_events);
  return world.state().lap == 1 && world.state().off_track_events == 0 ? 0 : 1;
}

int main() {
  const auto scenario = protocol::compose({.scenario_file = "first-lap", .settings = {}});
  const auto plant = scenario.and_then(run::make_plant);
  const auto track = scenario.and_then(run::make_track);
  if (!plant || !track) return std::puts((plant ? track.error() : plant.error()).message.c_str()), 2;
  ChaseThirdWaypoint controller;
  return drive(controller, **plant, *track);
}
