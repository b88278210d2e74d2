// SPDX-License-Identifier: MIT
#include "chicane/run/closed_loop.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "chicane/protocol/schema.hpp"
#include "chicane/run/make.hpp"
#include "chicane/run/observe.hpp"

namespace chicane::run {
namespace {

constexpr double kLostDistance = 25.0;  // [m] off the line ...
constexpr double kLostTime = 3.0;       // [s] ... for this long: the run is over
constexpr double kTimePerLap = 600.0;   // [s] when no limit was given
constexpr int kLapsRemembered = 1000;   // one by one, beyond those asked for

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

ClosedLoop::ClosedLoop(const scenario::Scenario& scenario, path::Track track, path::Track waypoints,
                       std::unique_ptr<sim::Plant> plant, std::unique_ptr<controller::Controller> controller)
    : scenario_{scenario},
      track_{std::move(track)},
      waypoints_{std::move(waypoints)},
      plant_{std::move(plant)},
      controller_{std::move(controller)},
      world_{*plant_, track_},
      sensor_{scenario.sensor, scenario.seed},
      gate_{scenario.vehicle},
      faults_{scenario.faults, scenario.seed},
      arrivals_{scenario.control_period},
      metrics_{std::max(scenario.laps, kLapsRemembered), scenario.control_period} {
  restart();
}

Result<std::unique_ptr<ClosedLoop>> ClosedLoop::create(const scenario::Scenario& scenario) {
  Result<path::Track> track = make_track(scenario);
  if (!track) return fail(track.error());
  Result<path::Track> waypoints = make_waypoints(*track);
  if (!waypoints) return fail(waypoints.error());
  Result<std::unique_ptr<sim::Plant>> plant = make_plant(scenario);
  if (!plant) return fail(plant.error());
  Result<std::unique_ptr<controller::Controller>> controller = make_controller(scenario);
  if (!controller) return fail(controller.error());
  return std::unique_ptr<ClosedLoop>(new ClosedLoop(scenario, std::move(*track), std::move(*waypoints),
                                                    std::move(*plant), std::move(*controller)));
}

void ClosedLoop::restart() {
  world_.place(track_.start_s(), track_.start_d());
  controller_->reset();
  gate_.reset();
  in_flight_.reset({});
  hands_.restart();
  faults_.reset();
  arrivals_.reset();
  sensor_ = sim::Sensor(scenario_.sensor, scenario_.seed);
  metrics_ = telemetry::Metrics(std::max(scenario_.laps, kLapsRemembered), scenario_.control_period);
  promises_.reset();
  frame_ = {};
  next_control_ = 0.0;
  step_time_ = 0.0;
  cycle_ = 0;
  off_for_ = 0.0;
  over_ = false;
  end_reason_.clear();
}

void ClosedLoop::drive_on() {
  is_endless_ = true;
  over_ = false;
  if (off_for_ > kLostTime) restart();
}

bool ClosedLoop::advance(double budget) noexcept {
  const bool is_due = is_control_due();
  if (is_due) control(budget, nullptr);
  watch_faults();
  world_.advance(acting());
  judge();
  return is_due;
}

bool ClosedLoop::advance(const GivenStep& given) noexcept {
  const bool is_due = is_control_due();
  if (is_due) control(0.0, &given);
  watch_faults();
  world_.advance(acting());
  judge();
  return is_due;
}

void ClosedLoop::apply(const telemetry::Change& change) noexcept {
  if (hands_.apply(change)) return;
  const std::string_view name = change.name.view();
  const std::string_view value = change.value.view();
  constexpr std::string_view kFault = "fault.";
  if (name.starts_with(kFault))
    return static_cast<void>(set_fault(name.substr(kFault.size()), value == "true"));
  if (name == "run.pace") {
    std::from_chars(value.data(), value.data() + value.size(), pace_);
    pace_ = std::clamp(pace_, kSlowestPace, kFastestPace);
    return;
  }
  const protocol::Parameter* row = protocol::find(name);
  if (row == nullptr || !protocol::is_live(*row) || !protocol::set_text(scenario_, name, value)) return;
  configure(*controller_, scenario_);
  gate_.set_vehicle(scenario_.vehicle);
  sensor_.configure(scenario_.sensor);
  plant_->deviate({.friction_scale = scenario_.plant_options.friction_scale,
                   .mass_scale = scenario_.plant_options.mass_scale});
}

bool ClosedLoop::set_fault(std::string_view name, bool on) noexcept {
  const std::optional<sim::Fault> fault = sim::fault_named(name);
  if (fault) faults_.set(*fault, on, time());
  return fault.has_value();
}

/// Begins and ends faults; the plant feels them from this step on.
void ClosedLoop::watch_faults() noexcept {
  faults_.update(time());
  plant_->disturb({.grip = faults_.grip(), .side_acceleration = faults_.side_acceleration()});
}

/// What the actuators do now: the command that has arrived; when none has for long, the car brakes by itself.
model::Command ClosedLoop::acting() noexcept {
  const double late = faults_.extra_delay(scenario_.latency);
  const model::Command& arrived = in_flight_.at(time() + 1e-9 - late);
  return faults_.done(arrivals_.guard(arrived, time() - late, plant_->output().speed,
                                      scenario_.vehicle.brake_throttle_limit));
}

void ClosedLoop::control(double budget, const GivenStep* given) noexcept {
  faults_.update(time());
  model::Measurement now = sensor_.sample(time(), *plant_);
  sim::select_waypoints(waypoints_, {now.x, now.y, now.psi}, scenario_.waypoints_sent, now);
  now = faults_.seen(now);
  // Commands act in the order they are sent: behind a latency that has just been shortened they still wait.
  now.delay = std::max(scenario_.latency + step_time_, in_flight_.last_time() - now.time);
  DeadlineLog questions{.spent_at = faults_.deadline_questions()};
  if (given != nullptr) {
    now.delay = given->delay;
    questions.spent_at = given->deadline_spent_at;
  }

  const auto start = std::chrono::steady_clock::now();
  const Deadline deadline =
      budget > 0.0 ? Deadline::after(std::chrono::nanoseconds(static_cast<long long>(budget * 1e9)))
                   : Deadline::stopwatch();
  const controller::StepResult& answer = controller_->step(now, deadline.counted_in(questions));
  frame_.begins = cycle_ == 0;
  frame_.gate_interval = frame_.begins ? 0.0 : scenario_.control_period;
  frame_.deadline_spent_at = questions.spent_at;
  frame_.is_manual = hands_.is_on();
  if (frame_.is_manual) frame_.manual = hands_.wish(now, scenario_.vehicle);
  const safety::GateResult gated =
      gate_.pass(frame_.is_manual ? frame_.manual : answer.command, frame_.gate_interval);
  if (frame_.is_manual) controller_->note_sent(gated.command);
  const double taken = seconds_since(start);
  if (budget > 0.0) step_time_ += 0.1 * (std::min(taken, budget) - step_time_);

  frame_.result = answer;
  frame_.asked = answer.command;
  frame_.pace = pace_;
  frame_.result.command = gated.command;
  frame_.result.report.gated = gated.reason != safety::GateReason::kNone;
  fill_frame(now, taken);
  if (faults_.is_delivered()) {
    in_flight_.push(now.time + now.delay, gated.command);
    arrivals_.arrived(now.time + now.delay);
  }
  metrics_.add(frame_);
  next_control_ += scenario_.control_period;
  ++cycle_;
}

void ClosedLoop::fill_frame(const model::Measurement& now, double step_time) noexcept {
  observe(world_, frame_);
  frame_.cycle = cycle_;
  frame_.time = now.time;
  frame_.measurement = now;
  frame_.applied = acting();
  frame_.active_faults = faults_.bits();
  frame_.step_time = step_time;
  frame_.solve_time = frame_.result.report.solve_time;
  frame_.prediction_error = promises_.error(now.time, {frame_.truth.x, frame_.truth.y});
  promises_.add(frame_.result.plan, scenario_.control_period);
}

void ClosedLoop::judge() noexcept {
  const sim::WorldState& world = world_.state();
  metrics_.add_physics(physics_sample(world_));
  if (world.lap > metrics_.laps_completed()) {
    metrics_.lap_completed(world.last_lap_time, world.last_sector_times);
    frame_.completed_lap = completed_lap(world, metrics_.last_lap());
  }

  const bool is_lost = std::fabs(world.lateral_error) > kLostDistance && !hands_.is_on();
  off_for_ = is_lost ? off_for_ + plant_->step_length() : 0.0;
  const double default_limit =
      scenario_.laps > 0 ? kTimePerLap * scenario_.laps : std::numeric_limits<double>::infinity();
  const double limit = scenario_.time_limit > 0.0 ? scenario_.time_limit : default_limit;
  if (!is_endless_ && scenario_.laps > 0 && (world.lap >= scenario_.laps || world.is_finished)) {
    over_ = true;
  } else if (off_for_ > kLostTime) {
    over_ = true;
    end_reason_ = "the car left the road and did not come back";
  } else if (!is_endless_ && world_.time() >= limit) {
    over_ = true;
    end_reason_ = "time limit reached";
  }
}

telemetry::RunSummary ClosedLoop::summary() const {
  telemetry::RunSummary run = metrics_.summary();
  run.track = track_.name();
  run.car = scenario_.car;
  run.controller = scenario_.controller;
  run.preset = scenario_.preset;
  run.seed = scenario_.seed;
  run.latency = scenario_.latency;
  run.laps_wanted = scenario_.laps;
  run.duration = world_.time();
  run.completed = scenario_.laps > 0 && run.laps_completed >= scenario_.laps;
  run.end_reason = run.completed || !end_reason_.empty() ? end_reason_ : "stopped";
  return run;
}

telemetry::RunSummary run_closed_loop(ClosedLoop& loop,
                                      const std::function<void(const telemetry::Frame&)>& on_frame,
                                      const std::function<bool()>& stop) {
  const auto start = std::chrono::steady_clock::now();
  while (!loop.is_over()) {
    if (!loop.advance()) continue;
    if (on_frame) on_frame(loop.frame());
    if (stop && stop()) break;
  }
  telemetry::RunSummary run = loop.summary();
  run.wall_time = seconds_since(start);
  return run;
}

}  // namespace chicane::run
