// SPDX-License-Identifier: MIT
#include "chicane/run/closed_loop.hpp"

#include <algorithm>
#include <chrono>
#include <string_view>
#include <utility>

#include "chicane/protocol/schema.hpp"
#include "chicane/run/observe.hpp"
#include "chicane/run/racing.hpp"

namespace chicane::run {

ClosedLoop::ClosedLoop(const scenario::Scenario& scenario, const Roads::Prepared& road,
                       std::unique_ptr<sim::Plant> plant, std::unique_ptr<controller::Controller> controller)
    : scenario_{scenario},
      track_{road.track},
      waypoints_{road.waypoints},
      plant_{std::move(plant)},
      cycle_{std::move(controller), scenario, road.known},
      world_{*plant_, track_},
      sensor_{scenario.sensor, scenario.seed},
      faults_{scenario.faults, scenario.seed},
      receiver_{scenario.vehicle, scenario.control_period, scenario.guard.receiver},
      account_{terms_of(scenario, &track_)} {
  use_line(road.lap);
  restart();
}

Result<std::unique_ptr<ClosedLoop>> ClosedLoop::create(const scenario::Scenario& scenario,
                                                       const Factories& make) {
  Roads roads;
  return create(scenario, roads, make);
}

Result<std::unique_ptr<ClosedLoop>> ClosedLoop::create(const scenario::Scenario& scenario, Roads& roads,
                                                       const Factories& make) {
  const auto road = roads.of(scenario, make.track);
  if (!road) return fail(road.error());
  if (const Result<void> fits = roads.check_room(scenario, **road); !fits) return fail(fits.error());
  return build(scenario, **road, make);
}

Result<std::unique_ptr<ClosedLoop>> ClosedLoop::create(const scenario::Scenario& scenario,
                                                       const Roads::Prepared& road, const Factories& make) {
  if (const Result<void> fits = check_room(scenario, road.track); !fits) return fail(fits.error());
  return build(scenario, road, make);
}

Result<std::unique_ptr<ClosedLoop>> ClosedLoop::build(const scenario::Scenario& scenario,
                                                      const Roads::Prepared& road, const Factories& make) {
  Result<std::unique_ptr<sim::Plant>> plant = make.plant(scenario);
  if (!plant) return fail(plant.error());
  Result<std::unique_ptr<controller::Controller>> controller = make.controller(scenario);
  if (!controller) return fail(controller.error());
  return std::unique_ptr<ClosedLoop>(
      new ClosedLoop(scenario, road, std::move(*plant), std::move(*controller)));
}

std::unique_ptr<ClosedLoop> ClosedLoop::copy() const {
  const bool is_copyable = dynamic_cast<const controller::Copyable*>(&controller()) != nullptr;
  if (!is_copyable) return nullptr;
  std::unique_ptr<ClosedLoop> other(new ClosedLoop(*this));
  if (!other->plant_) return nullptr;
  other->world_.stand_on(*other->plant_, other->track_);
  return other;
}

void ClosedLoop::restart() {
  world_.place(track_.start_s(), track_.start_d());
  cycle_.begin();
  in_flight_.reset({});
  configured_act_time_ = -std::numeric_limits<double>::infinity();
  manual_.restart();
  faults_.reset();
  receiver_.reset();
  sensor_ = sim::Sensor(scenario_.sensor, scenario_.seed);
  account_.restart();
  frame_ = {};
  seen_.reset();
  next_control_ = 0.0;
  step_time_ = 0.0;
}

void ClosedLoop::restart_at(const model::State& start) {
  restart();
  world_.reset(start);
}

void ClosedLoop::drive_on() {
  const bool is_lost = account_.is_lost();
  account_.drive_on();
  if (is_lost) restart();
}

bool ClosedLoop::advance(double budget) noexcept {
  const bool is_due = is_control_due();
  if (is_due) control(budget, nullptr);
  move();
  return is_due;
}

bool ClosedLoop::advance(const GivenStep& given) noexcept {
  const bool is_due = is_control_due();
  if (is_due) control(0.0, &given);
  move();
  return is_due;
}

void ClosedLoop::follow(double time, const model::State& car, double delay,
                        const model::Command& sent) noexcept {
  world_.see(time, car);
  seen_.reset();
  next_control_ = time;
  const GivenStep given{.delay = delay};
  control(0.0, &given, &sent);
  account_.add_physics(world_, true);
}

/// One physics step.
void ClosedLoop::move() noexcept {
  watch_faults();
  world_.advance(acting());
  account_.add_physics(world_, manual_.is_on());
  frame_.completed_lap = account_.completed_lap();
}

void ClosedLoop::apply(const telemetry::Change& change) {
  if (const Result<Setting> setting = read_setting(change)) apply(*setting);
}

void ClosedLoop::apply(const Setting& setting) noexcept {
  std::visit([this](const auto& action) { take(action); }, setting.action);
}

void ClosedLoop::take(const FieldValue& field) noexcept {
  if (!protocol::is_live(*field.row)) return;
  write(scenario_, field);
  cycle_.configure(scenario_);
  account_.set_terms(scenario_.laps, scenario_.time_limit, scenario_.latency);
  sensor_.configure(scenario_.sensor);
  plant_->deviate({.friction_scale = scenario_.plant_options.friction_scale,
                   .mass_scale = scenario_.plant_options.mass_scale});
}

void ClosedLoop::take(const FaultSwitch& fault) noexcept {
  if (fault.to != FaultSwitch::To::kAsGiven)
    return faults_.set(fault.event.fault, fault.to == FaultSwitch::To::kOn, time());
  sim::FaultEvent event = fault.event;
  event.at = time();
  faults_.set(event);
}

void ClosedLoop::take(LearnedLap learned) noexcept {
  controller::LapRequest request = controller().wants_lap();
  request.grip = learned.grip;
  request.slides = learned.slides;
  const auto lap = plan_wanted_lap(scenario_, &track_, request);
  if (lap) use_line(*lap);
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
  model::Command command = faults_.done(receiver_.guard(arrived, time() - late, plant_->output().speed));
  if (interceptor_.actuated) interceptor_.actuated(time(), command);
  return command;
}

/// The controller's measurement now.
model::Measurement ClosedLoop::measure() noexcept {
  model::Measurement now = sensor_.sample(time(), *plant_);
  sim::select_waypoints(waypoints_, {now.x, now.y, now.psi}, scenario_.waypoints_sent, now);
  now = faults_.seen(now);
  if (interceptor_.measured) interceptor_.measured(now);
  // Commands act in the order they are sent: behind a latency that has just been shortened they still wait.
  now.delay = std::max(scenario_.latency + step_time_, configured_act_time_ - now.time);
  return now;
}

const model::Measurement& ClosedLoop::look() noexcept {
  if (!is_control_due()) return frame_.measurement;
  if (!seen_) seen_ = take_measurement();
  return *seen_;
}

/// Of the control step that is due: by look(), or taken now.
model::Measurement ClosedLoop::take_measurement() noexcept {
  if (seen_) return *std::exchange(seen_, std::nullopt);
  faults_.update(time());
  return measure();
}

void ClosedLoop::control(double budget, const GivenStep* given, const model::Command* sent) noexcept {
  frame_.measurement = take_measurement();
  CycleInput input{.deadline_spent_at = faults_.deadline_questions(), .interval = scenario_.control_period};
  if (given != nullptr) {
    frame_.measurement.delay = given->delay;
    input.deadline_spent_at = given->deadline_spent_at;
  }
  if (manual_.is_on()) input.manual = manual_.command(frame_.measurement, scenario_.vehicle);
  if (sent != nullptr) input.manual = *sent;
  observe(world_, frame_);
  frame_.pace = pace_;
  frame_.applied = acting();
  frame_.active_faults = faults_.bits();
  if (budget > 0.0)
    input.deadline = Deadline::after(std::chrono::nanoseconds(static_cast<long long>(budget * 1e9)));
  cycle_.step(input, frame_);
  if (budget > 0.0) step_time_ += 0.1 * (std::min(frame_.step_time, budget) - step_time_);
  if (faults_.is_delivered()) {
    configured_act_time_ = frame_.measurement.time + frame_.measurement.delay;
    const double act_time =
        configured_act_time_ + sim::random_delay(scenario_.seed, time(), scenario_.latency_jitter);
    in_flight_.push(act_time, frame_.result.command);
    receiver_.arrived(act_time, cycle_.stop());
  }
  account_.add(frame_);
  next_control_ += scenario_.control_period;
}

telemetry::RunSummary ClosedLoop::summary() const {
  telemetry::RunSummary run = account_.summary(world_.time());
  const bool is_full_size = scenario_.vehicle.scale == 1.0;  // else the plan has times of full size
  if (lap_ && is_full_size) run.planned_corner_times = lap_->corner_times();
  return run;
}

}  // namespace chicane::run
