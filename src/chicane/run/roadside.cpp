// SPDX-License-Identifier: MIT
#include "chicane/run/roadside.hpp"

#include <cmath>

#include "chicane/model/vehicle.hpp"
#include "chicane/run/observe.hpp"

namespace chicane::run {
namespace {

constexpr int kLapsRemembered = 1000;  // one by one

telemetry::Metrics empty_metrics(const scenario::Scenario& scenario) {
  return {kLapsRemembered, scenario.control_period};
}

/// What was measured, with the wheels where they are believed to be.
sim::Sighting sighting_of(const model::Measurement& seen, const model::VehicleParams& car) {
  const double edge = 0.5 * (car.track_width + car.tire_width);
  return {.pose = {.x = seen.x, .y = seen.y, .psi = seen.psi},
          .speed = std::fabs(seen.speed),
          .contact_points = {Vec2{car.front_axle, edge}, Vec2{car.front_axle, -edge},
                             Vec2{-car.rear_axle, edge}, Vec2{-car.rear_axle, -edge}}};
}

}  // namespace

Roadside::Roadside(const path::Track* track, const scenario::Scenario& scenario)
    : track_{track}, scenario_{scenario}, metrics_{empty_metrics(scenario)} {
  restart();
}

void Roadside::restart() {
  judge_.reset();
  if (track_ != nullptr) judge_.emplace(*track_);
  metrics_ = empty_metrics(scenario_);
  completed_lap_ = {};
  has_seen_ = false;
}

void Roadside::judge(telemetry::Frame& frame) noexcept {
  frame.is_judged = judge_ && frame.has_measurement;
  if (frame.is_judged) look(frame);
  metrics_.add(frame);
  if (judge_ && judge_->state().lap > metrics_.laps_completed()) {
    metrics_.lap_completed(judge_->state().last_lap_time, judge_->state().last_sector_times);
    completed_lap_ = completed_lap(judge_->state(), metrics_.last_lap());
  }
  frame.completed_lap = completed_lap_;
}

void Roadside::look(telemetry::Frame& frame) noexcept {
  const sim::Sighting car = sighting_of(frame.measurement, scenario_.vehicle);
  if (has_seen_) {
    judge_->see(frame.time, car);
  } else {
    judge_->reset(frame.time, car);
  }
  has_seen_ = true;
  observe(judge_->state(), frame);
}

telemetry::RunSummary Roadside::summary() const {
  telemetry::RunSummary run = metrics_.summary();
  if (track_ != nullptr) run.track = track_->name();
  run.car = scenario_.vehicle.name;
  run.controller = scenario_.controller;
  run.preset = scenario_.preset;
  run.seed = scenario_.seed;
  run.latency = scenario_.latency;
  run.laps_wanted = 0;
  run.end_reason = "stopped";
  return run;
}

}  // namespace chicane::run
