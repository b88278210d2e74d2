// SPDX-License-Identifier: MIT
#include "chicane/run/roadside.hpp"

#include <cmath>

#include "chicane/model/vehicle.hpp"
#include "chicane/run/observe.hpp"

namespace chicane::run {
namespace {

AccountTerms terms(const road::Track* track, const scenario::Scenario& scenario) {
  AccountTerms terms = terms_of(scenario, track);
  terms.car = scenario.vehicle.name;
  terms.laps = 0;
  terms.time_limit = 0.0;
  terms.remedy = telemetry::kSimulatorRemedy;
  return terms;
}

/// The measurement, with the wheels where they are assumed.
sim::Sighting sighting_of(const model::Measurement& seen, const model::VehicleParams& car) {
  const double edge = 0.5 * (car.track_width + car.tire_width);
  return {.pose = {.x = seen.x, .y = seen.y, .psi = seen.psi},
          .speed = std::fabs(seen.speed),
          .contact_points = {Vec2{car.front_axle, edge}, Vec2{car.front_axle, -edge},
                             Vec2{-car.rear_axle, edge}, Vec2{-car.rear_axle, -edge}}};
}

}  // namespace

Roadside::Roadside(const road::Track* track, const scenario::Scenario& scenario)
    : scenario_{scenario}, account_{terms(track, scenario)} {
  if (track != nullptr) judge_.emplace(*track);
}

void Roadside::resume() noexcept {
  account_.resume();
  if (judge_ && has_seen_) events_before_ += judge_->state().off_track_events;
  learner_.reset();
  has_seen_ = false;
}

void Roadside::forget_track() {
  judge_.reset();
  account_ = Account(terms(nullptr, scenario_));
  events_before_ = 0;
  has_seen_ = false;
}

void Roadside::judge(telemetry::Frame& frame) noexcept {
  frame.is_judged = judge_ && frame.has_measurement;
  if (frame.is_judged) look(frame);
  account_.add(frame);
  if (frame.is_judged) {
    account_.add_sighting(judge_->state(), judge_->last_corner_times());
    frame.lap = account_.laps_completed();
  } else if (!judge_ && frame.has_measurement) {
    learn(frame);
  }
  frame.completed_lap = account_.completed_lap();
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
  frame.off_track_events += events_before_;
}

void Roadside::learn(telemetry::Frame& frame) noexcept {
  const model::Measurement& seen = frame.measurement;
  learner_.see(frame.time, {.x = seen.x, .y = seen.y, .psi = seen.psi}, seen.speed);
  account_.add_sighting(learner_.state());
  frame.lap = account_.laps_completed();
  frame.lap_time = learner_.state().lap_time;
  frame.last_lap_time = learner_.state().last_lap_time;
}

telemetry::RunSummary Roadside::summary() const { return account_.summary(); }

}  // namespace chicane::run
