// SPDX-License-Identifier: MIT
// Account of a run: laps, counts and the reasons of its end, from our plant or from sightings of a car that
// another program simulates.
#include "chicane/run/account.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "chicane/base/math.hpp"
#include "chicane/base/text.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/run/simulated_car.hpp"

namespace chicane::run {
namespace {

constexpr double kStanding = 0.02;  // [m/s] speed below which a simulated car stands; chosen
constexpr const char* kTimeLimit = "time limit reached";
constexpr double kNever = std::numeric_limits<double>::infinity();

telemetry::Metrics empty_metrics(const AccountTerms& terms) {
  return {std::max(terms.laps, Account::kLapsRemembered), terms.step_deadline, terms.corners.size()};
}

telemetry::PhysicsSample physics_sample(const sim::World& world) noexcept {
  return {.step = world.plant().step_length(),
          .state = world.plant().state(),
          .lateral_acceleration = world.plant().output().ay,
          .lateral_error = world.state().lateral_error,
          .edge_distance = world.state().edge_distance,
          .is_off_track = world.state().is_off_track};
}

}  // namespace

AccountTerms terms_of(const scenario::Scenario& scenario, const road::Track* track) {
  return {.track = track != nullptr ? track->name() : "",
          .car = scenario.car,
          .controller = scenario.controller,
          .preset = scenario.preset,
          .corners = track != nullptr ? road::corners_of(*track) : std::vector<road::Corner>{},
          .notices = scenario.notices,
          .seed = scenario.seed,
          .scale = scenario.vehicle.scale,
          .guard = scenario.guard,
          .latency = scenario.latency,
          .laps = scenario.laps,
          .time_limit = scenario.time_limit,
          .full_brake = scenario.vehicle.brake_throttle_limit,
          .step_deadline = scenario.control_period};
}

Account::Account(AccountTerms terms) : terms_{std::move(terms)}, metrics_{empty_metrics(terms_)} {}

void Account::restart() {
  metrics_ = empty_metrics(terms_);
  completed_lap_ = {};
  has_new_lap_ = false;
  laps_seen_ = 0;
  nearest_ = kNever;
  lost_for_ = stood_for_ = 0.0;
  is_over_ = has_finished_ = false;
  end_reason_ = "";
}

void Account::resume() noexcept {
  metrics_.drop_lap();
  laps_seen_ = 0;
  nearest_ = kNever;
  lost_for_ = 0.0;
}

void Account::set_terms(int laps, double time_limit, double latency) noexcept {
  terms_.laps = laps;
  terms_.time_limit = time_limit;
  terms_.latency = latency;
}

void Account::add_physics(const sim::World& world, bool is_manual) noexcept {
  metrics_.add_physics(physics_sample(world));
  edge_distance_ = world.state().edge_distance;
  const bool stands = std::fabs(world.plant().output().speed) < kStanding;
  stood_for_ = stands ? stood_for_ + world.plant().step_length() : 0.0;
  add_sighting(world.state(), world.judge().last_corner_times());
  look_for_end(world.state(), world.time(), world.plant().step_length(), is_manual);
}

void Account::add(telemetry::Frame& frame) noexcept {
  metrics_.add(frame);
  frame.situation = telemetry::situation_of(
      frame, frame.situation,
      {.full_brake = terms_.full_brake, .corners = terms_.corners, .remedy = terms_.remedy});
}

void Account::add_sighting(const sim::WorldState& car, std::span<const double> corner_times) noexcept {
  if (car.lap <= laps_seen_) return;
  laps_seen_ = car.lap;
  metrics_.lap_completed(car.last_lap_time, car.last_sector_times, corner_times);
  const telemetry::LapSummary& measured = metrics_.last_lap();
  completed_lap_ = {.lap = metrics_.laps_completed(),
                    .lap_time = measured.lap_time,
                    .sector_times = measured.sector_times,
                    .is_clean = car.last_lap_was_clean,
                    .mean_speed = measured.mean_speed,
                    .top_speed = measured.top_speed,
                    .min_edge_distance = measured.min_edge_distance,
                    .rms_lateral_error = measured.rms_lateral_error};
  has_new_lap_ = true;
}

std::optional<telemetry::CompletedLap> Account::take_lap() noexcept {
  if (!std::exchange(has_new_lap_, false)) return std::nullopt;
  return completed_lap_;
}

void Account::look_for_end(const sim::WorldState& car, double time, double step, bool is_manual) noexcept {
  const double distance = std::fabs(car.lateral_error);
  if (distance <= kLostDistance * terms_.scale || is_manual) {
    nearest_ = kNever;
    lost_for_ = 0.0;
  } else if (distance < nearest_ - kNearer * terms_.scale) {
    nearest_ = distance;
    lost_for_ = 0.0;
  } else {
    lost_for_ += step;
  }
  const bool has_laps = terms_.laps > 0;
  if (has_laps && !is_endless_ && (metrics_.laps_completed() >= terms_.laps || car.is_finished)) {
    is_over_ = true;
    has_finished_ = car.is_finished;
    if (metrics_.laps_completed() == 0) end_reason_ = "the finish was reached without a lap from the start";
  } else if (has_laps && is_lost()) {
    is_over_ = true;
    end_reason_ = "the car left the road and did not come back";
  } else if (!is_endless_ && time >= time_limit()) {
    is_over_ = true;
    end_reason_ = kTimeLimit;
  }
}

double Account::time_limit() const noexcept {
  if (terms_.time_limit > 0.0) return terms_.time_limit;
  return terms_.laps > 0 ? kTimePerLap * terms_.laps : kNever;
}

void Account::drive_on() noexcept {
  is_endless_ = true;
  is_over_ = false;
}

telemetry::RunSummary Account::summary(std::optional<double> duration) const {
  telemetry::RunSummary run = metrics_.summary();
  run.track = terms_.track;
  run.car = terms_.car;
  run.controller = terms_.controller;
  run.preset = terms_.preset;
  run.corners = terms_.corners;
  run.guard = terms_.guard;
  run.notices = terms_.notices;
  run.seed = terms_.seed;
  run.latency = terms_.latency;
  run.laps_wanted = terms_.laps;
  if (duration) run.duration = *duration;
  if (has_finished_) run.laps_wanted = 1;  // the only lap of an open road
  run.completed = terms_.laps > 0 && run.laps_completed >= run.laps_wanted;
  run.end_reason = end_reason_;
  if (end_reason_ == kTimeLimit && stood_for_ > kStoodTime) {
    const std::string edge = number_text(std::round(100.0 * std::fabs(edge_distance_)) / 100.0);
    run.end_reason += ": the car stood for the last " + number_text(std::round(stood_for_)) +
                      " s, its outermost tyre " + edge + " m " +
                      (edge_distance_ < 0.0 ? "beyond" : "inside") + " the edge";
  }
  if (!run.completed && run.end_reason.empty()) run.end_reason = "stopped";
  return run;
}

namespace {

constexpr double kLeastShare = 0.9;   // least length of a lap over the first lap's; chosen
constexpr double kMostTurned = 0.45;  // [rad] largest angle of a crossing to the first one; chosen: below
                                      // 30°, the least angle between two roads that cross
// Distance beyond what the speed explains that shows that a car was placed elsewhere [m]; chosen.
constexpr double kMoved = 5.0;

}  // namespace

void LapLearner::start(double time, const model::Pose& car) noexcept {
  reset();
  has_line_ = true;
  line_ = last_ = {car.x, car.y};
  direction_ = {cos(car.psi), sin(car.psi)};
  lap_start_ = state_.time = time;
  state_.is_timed = true;
}

void LapLearner::see(double time, const model::Pose& car, double speed) noexcept {
  const Vec2 position{car.x, car.y};
  const double moved = (position - last_).norm();
  const double elapsed = time - state_.time;
  if (!has_line_ || moved > 2.0 * speed * elapsed + kMoved) return start(time, car);
  const double before = (last_ - line_).dot(direction_);
  const Vec2 from_line = position - line_;
  const double after = from_line.dot(direction_);
  const double beside = direction_.x() * from_line.y() - direction_.y() * from_line.x();
  driven_ += moved;
  last_ = position;
  state_.time = time;
  state_.lap_time = time - lap_start_;
  if ((before < 0.0) == (after < 0.0) || std::fabs(beside) > kReach) return;
  // A crossing road leads over the start line at another angle: ignore it. Backwards counts in both
  // directions of the car, forwards only in the first one.
  const double turned = std::fabs(angle_difference(car.psi, atan2(direction_.y(), direction_.x())));
  if ((after > 0.0 ? turned : std::min(turned, kPi - turned)) > kMostTurned) return;
  if (after < 0.0) {
    ++backward_;
  } else if (backward_ > 0) {
    --backward_;
  } else {
    cross_line(time - elapsed * after / (after - before));
  }
}

void LapLearner::cross_line(double crossing) noexcept {
  const bool is_lap = driven_ >= std::max(kLeast, kLeastShare * lap_length_);
  if (is_lap) count_lap(crossing);
  state_.lap_time = state_.time - crossing;
  lap_start_ = crossing;
  driven_ = 0.0;
}

void LapLearner::count_lap(double crossing) noexcept {
  if (lap_length_ == 0.0) lap_length_ = driven_;
  ++state_.lap;
  state_.last_lap_time = crossing - lap_start_;
  state_.last_sector_times.fill(telemetry::kNotMeasured);
  const bool is_best = state_.lap == 1 || state_.last_lap_time < state_.best_lap_time;
  if (is_best) state_.best_lap_time = state_.last_lap_time;
  state_.last_lap_was_clean = true;  // without a road no lap can be judged otherwise
}

namespace {

/// Terms of a run without an end, for a car of another program.
AccountTerms external_terms(const road::Track* track, const scenario::Scenario& scenario,
                            std::string_view remedy) {
  AccountTerms terms = terms_of(scenario, track);
  terms.car = scenario.vehicle.name;
  terms.laps = 0;
  terms.time_limit = 0.0;
  terms.remedy = remedy;
  return terms;
}

/// Sighting of a measured car: contact patches where the vehicle's parameters have its wheels.
sim::Sighting sighting_of(const model::Measurement& seen, const model::VehicleParams& car) {
  const double edge = 0.5 * (car.track_width + car.tire_width);
  return {.pose = {.x = seen.x, .y = seen.y, .psi = seen.psi},
          .speed = std::fabs(seen.speed),
          .contact_points = {Vec2{car.front_axle, edge}, Vec2{car.front_axle, -edge},
                             Vec2{-car.rear_axle, edge}, Vec2{-car.rear_axle, -edge}}};
}

}  // namespace

Roadside::Roadside(const road::Track* track, const scenario::Scenario& scenario, std::string_view remedy)
    : scenario_{scenario}, remedy_{remedy}, account_{external_terms(track, scenario, remedy)} {
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
  account_ = Account(external_terms(nullptr, scenario_, remedy_));
  events_before_ = 0;
  has_seen_ = false;
}

void Roadside::judge(telemetry::Frame& frame) noexcept {
  frame.is_judged = judge_ && frame.has_measurement;
  if (frame.is_judged) judge_on_road(frame);
  account_.add(frame);
  if (frame.is_judged) {
    account_.add_sighting(judge_->state(), judge_->last_corner_times());
    frame.lap = account_.laps_completed();
  } else if (!judge_ && frame.has_measurement) {
    time_without_road(frame);
  }
  frame.completed_lap = account_.completed_lap();
}

void Roadside::judge_on_road(telemetry::Frame& frame) noexcept {
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

void Roadside::time_without_road(telemetry::Frame& frame) noexcept {
  const model::Measurement& seen = frame.measurement;
  learner_.see(frame.time, {.x = seen.x, .y = seen.y, .psi = seen.psi}, seen.speed);
  account_.add_sighting(learner_.state());
  frame.lap = account_.laps_completed();
  frame.lap_time = learner_.state().lap_time;
  frame.last_lap_time = learner_.state().last_lap_time;
}

}  // namespace chicane::run
