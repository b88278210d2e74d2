// SPDX-License-Identifier: MIT
// Simulated car: plant, world, sensor, latency and receiver, advanced step by step.
#include "chicane/run/simulated_car.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "chicane/run/make.hpp"

namespace chicane::run {

SimulatedCar::SimulatedCar(const scenario::Scenario& scenario, road::Track road, road::Track shown,
                           std::unique_ptr<sim::Plant> car, AccountTerms terms)
    : track{std::move(road)},
      waypoints{std::move(shown)},
      plant{std::move(car)},
      world{*plant, track},
      sensor{scenario.sensor, scenario.seed},
      receiver{scenario.vehicle, scenario.control_period, scenario.guard.receiver},
      account{std::move(terms)} {
  restart(scenario);
}

SimulatedCar::SimulatedCar(const SimulatedCar& other)
    : track{other.track},
      waypoints{other.waypoints},
      plant{other.plant},
      world{other.world},
      sensor{other.sensor},
      in_flight{other.in_flight},
      receiver{other.receiver},
      account{other.account} {
  if (plant) world.stand_on(*plant, track);
}

Result<std::unique_ptr<SimulatedCar>> SimulatedCar::create(const scenario::Scenario& scenario,
                                                           double latency) {
  Result<road::Track> track = make_track(scenario);
  if (!track) return fail(track.error());
  Result<road::Track> waypoints = make_waypoints(*track, scenario.vehicle.scale);
  if (!waypoints) return fail(waypoints.error());
  Result<std::unique_ptr<sim::Plant>> plant = make_plant(scenario);
  if (!plant) return fail(plant.error());
  AccountTerms terms = terms_of(scenario, &*track);
  terms.controller = terms.preset = "external";
  terms.guard.reset();
  terms.latency = latency;
  terms.remedy = telemetry::kControllerRemedy;
  terms.step_deadline = std::numeric_limits<double>::infinity();  // no deadline
  return std::make_unique<SimulatedCar>(scenario, std::move(*track), std::move(*waypoints), std::move(*plant),
                                        std::move(terms));
}

void SimulatedCar::restart(const scenario::Scenario& scenario) {
  world.place(track.start_s(), track.start_d());
  sensor = sim::Sensor(scenario.sensor, scenario.seed);
  in_flight.reset({});
  receiver.reset();
  account.restart();
}

void SimulatedCar::advance(const model::Command& command, bool is_manual) noexcept {
  world.advance(command);
  account.add_physics(world, is_manual);
}

double SimulatedCar::catch_up(double time, const std::function<model::Command()>& act) {
  const double late = std::max(0.0, time - world.time() - kCatchUp);
  while (world.time() + plant->step_length() <= time - late && !account.is_over()) advance(act());
  return late;
}

model::Measurement SimulatedCar::sense(int waypoint_count) noexcept {
  model::Measurement now = sensor.sample(world.time(), *plant);
  sim::select_waypoints(waypoints, {.x = now.x, .y = now.y, .psi = now.psi}, waypoint_count, now);
  return now;
}

void SimulatedCar::write(const model::Measurement& seen, const model::Command& applied,
                         telemetry::Frame& frame) const noexcept {
  observe(world, frame);
  frame.completed_lap = account.completed_lap();
  frame.time = seen.time;
  frame.measurement = seen;
  frame.applied = applied;
}

void SimulatedCar::count(telemetry::Frame& frame) noexcept {
  ++frame.cycle;
  // Gate and solver of the other program are unknown: count its answer as ungated and optimal.
  frame.asked = frame.result.command;
  frame.result.report.solve.status = solver::SolveStatus::kOptimal;
  account.add(frame);
}

StopNews::StopNews(const scenario::Scenario& scenario, Say say)
    : standing_{kStanding * std::sqrt(scenario.vehicle.scale)}, say_{std::move(say)} {}

bool StopNews::look(const SimulatedCar& car, bool is_timed_out, double speed,
                    const std::function<std::string()>& why) {
  const bool begins = is_timed_out && !std::exchange(is_timed_out_, is_timed_out) && speed > standing_;
  is_timed_out_ = is_timed_out;
  if (begins) {
    is_said_ = is_moving_ = true;
    say_(fmt::format("no command in time: the car is stopped from {:.1f} m/s: {}", speed, why()));
  }
  if (!is_timed_out && std::exchange(is_said_, false))
    say_(fmt::format("commands again: the car drives on from {:.1f} m/s", car.speed()));
  if (!is_said_ || !is_moving_ || car.speed() >= standing_) return begins;
  is_moving_ = false;
  const double edge = car.world.state().edge_distance;
  say_(fmt::format("the car stands, its outermost wheel {:.2f} m {} the road's edge: {}", std::fabs(edge),
                   edge < 0.0 ? "beyond" : "inside", why()));
  return begins;
}

}  // namespace chicane::run
