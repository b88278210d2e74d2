// SPDX-License-Identifier: MIT
#include "chicane/run/account.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "chicane/base/text.hpp"

namespace chicane::run {
namespace {

constexpr double kStanding = 0.02;  // [m/s]
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
  count_laps(world.state(), world.judge().last_corner_times());
  look_for_end(world.state(), world.time(), world.plant().step_length(), is_manual);
}

void Account::add(telemetry::Frame& frame) noexcept {
  metrics_.add(frame);
  frame.situation = telemetry::situation_of(
      frame, frame.situation,
      {.full_brake = terms_.full_brake, .corners = terms_.corners, .remedy = terms_.remedy});
}

void Account::add_sighting(const sim::WorldState& car, std::span<const double> corner_times) noexcept {
  count_laps(car, corner_times);
}

void Account::count_laps(const sim::WorldState& car, std::span<const double> corner_times) noexcept {
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
  if (has_finished_) run.laps_wanted = 1;  // an open road has no more
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

}  // namespace chicane::run
