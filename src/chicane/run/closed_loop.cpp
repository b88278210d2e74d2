// SPDX-License-Identifier: MIT
// Closed loop of a run: simulated car, sensor, faults and control cycle, with the commands in flight between.
#include "chicane/run/closed_loop.hpp"

#include <algorithm>
#include <chrono>

#include "chicane/protocol/schema.hpp"
#include "chicane/run/racing.hpp"

namespace chicane::run {

ClosedLoop::ClosedLoop(const scenario::Scenario& scenario, const Roads::Prepared& road,
                       std::unique_ptr<sim::Plant> plant, std::unique_ptr<controller::Controller> controller)
    : scenario_{scenario},
      car_{scenario, road.track, road.waypoints, std::move(plant), terms_of(scenario, &road.track)},
      cycle_{std::move(controller), scenario, road.known},
      faults_{scenario.faults, scenario.seed} {
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
  return other->car_.plant ? std::move(other) : nullptr;
}

void ClosedLoop::restart() {
  car_.restart(scenario_);
  cycle_.begin();
  configured_act_time_ = -std::numeric_limits<double>::infinity();
  manual_.restart();
  faults_.reset();
  frame_ = {};
  seen_.reset();
  next_control_ = 0.0;
  step_time_ = 0.0;
}

void ClosedLoop::restart_at(const model::State& start) {
  restart();
  car_.world.reset(start);
}

void ClosedLoop::drive_on() {
  const bool is_lost = car_.account.is_lost();
  car_.account.drive_on();
  if (is_lost) restart();
}

bool ClosedLoop::advance_by(const StepTerms& terms) noexcept {
  const bool is_due = is_control_due();
  if (is_due) control(terms);
  move();
  return is_due;
}

void ClosedLoop::follow(double time, const model::State& car, double delay,
                        const model::Command& sent) noexcept {
  car_.world.see(time, car);
  seen_.reset();
  next_control_ = time;
  const GivenStep given{.delay = delay};
  control({.given = &given, .sent = &sent});
  car_.account.add_physics(car_.world, true);
}

void ClosedLoop::move() noexcept {
  update_faults();
  car_.advance(acting(), manual_.is_on());
  frame_.completed_lap = car_.account.completed_lap();
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
  car_.account.set_terms(scenario_.laps, scenario_.time_limit, scenario_.latency);
  car_.sensor.configure(scenario_.sensor);
  car_.plant->deviate({.friction_scale = scenario_.plant_options.friction_scale,
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
  request.terms = learned;
  const auto lap = plan_wanted_lap(scenario_, &car_.track, request);
  if (lap) use_line(*lap);
}

bool ClosedLoop::set_fault(std::string_view name, bool on) noexcept {
  const std::optional<sim::Fault> fault = sim::fault_named(name);
  if (fault) faults_.set(*fault, on, time());
  return fault.has_value();
}

void ClosedLoop::update_faults() noexcept {
  faults_.update(time());
  car_.plant->disturb({.grip = faults_.grip(), .side_acceleration = faults_.side_acceleration()});
}

model::Command ClosedLoop::acting() noexcept {
  const double late = faults_.extra_delay(scenario_.latency);
  const model::Command& arrived = car_.in_flight.at(time() + 1e-9 - late);  // 1e-9 s: rounding of sums
  model::Command command = faults_.done(car_.receiver.guard(arrived, time() - late, car_.speed()));
  if (interceptor_.actuated) interceptor_.actuated(time(), command);
  return command;
}

model::Measurement ClosedLoop::measure() noexcept {
  model::Measurement now = faults_.seen(car_.sense(scenario_.waypoints_sent));
  if (interceptor_.measured) interceptor_.measured(now);
  // Commands act in the order they are sent, also after the latency has been shortened.
  now.delay = std::max(scenario_.latency + step_time_, configured_act_time_ - now.time);
  return now;
}

const model::Measurement& ClosedLoop::look() noexcept {
  if (!is_control_due()) return frame_.measurement;
  if (!seen_) seen_ = take_measurement();
  return *seen_;
}

model::Measurement ClosedLoop::take_measurement() noexcept {
  if (seen_) return *std::exchange(seen_, std::nullopt);
  faults_.update(time());
  return measure();
}

void ClosedLoop::control(const StepTerms& terms) noexcept {
  frame_.measurement = take_measurement();
  CycleInput input{.deadline_spent_at = faults_.deadline_questions(), .interval = scenario_.control_period};
  if (terms.given != nullptr) {
    frame_.measurement.delay = terms.given->delay;
    input.deadline_spent_at = terms.given->deadline_spent_at;
  }
  if (manual_.is_on()) input.manual = manual_.command(frame_.measurement, scenario_.vehicle);
  if (terms.sent != nullptr) input.manual = *terms.sent;

  observe(car_.world, frame_);
  frame_.pace = pace_;
  frame_.applied = acting();
  frame_.active_faults = faults_.bits();
  if (terms.budget > 0.0)
    input.deadline = Deadline::after(std::chrono::nanoseconds(static_cast<long long>(terms.budget * 1e9)));
  cycle_.step(input, frame_);
  constexpr double kNewest = 0.1;  // weight of the newest duration in the smoothed one; chosen
  if (terms.budget > 0.0) step_time_ += kNewest * (std::min(frame_.step_time, terms.budget) - step_time_);

  if (faults_.is_delivered()) {
    configured_act_time_ = frame_.measurement.time + frame_.measurement.delay;
    const double act_time =
        configured_act_time_ + sim::random_delay(scenario_.seed, time(), scenario_.latency_jitter);
    car_.in_flight.push(act_time, frame_.result.command);
    car_.receiver.arrived(act_time, cycle_.stop());
  }
  car_.account.add(frame_);
  next_control_ += scenario_.control_period;
}

telemetry::RunSummary ClosedLoop::summary() const {
  telemetry::RunSummary run = car_.account.summary(time());
  const bool is_full_size = scenario_.vehicle.scale == 1.0;  // times of a plan are those of a full-size car
  if (lap_ && is_full_size) run.planned_corner_times = lap_->corner_times();
  return run;
}

scenario::Scenario endless(scenario::Scenario scenario) {
  scenario.laps = 0;
  scenario.time_limit = 0.0;
  scenario.faults.clear();
  return scenario;
}

}  // namespace chicane::run
