// SPDX-License-Identifier: MIT
// Control cycle: scales a model car's measurement to full size, runs guard and controller, and scales command
// and report back.
#include "chicane/run/control_cycle.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "chicane/run/make.hpp"

namespace chicane::run {

namespace {

constexpr double kRoadSpacing = 2.0;  // [m] spacing of the points of the guard's road, in full size; chosen
constexpr double kLateMemory = 30.0;  // [s] time constant in which a long interval fades; chosen

}  // namespace

road::KnownRoad known_road(const scenario::Scenario& scenario, const road::Track* track) {
  const model::VehicleParams car = full_size(scenario);
  if (track == nullptr) return safety::known_road(scenario.guard, nullptr, car);
  const model::Similarity similarity(scenario.vehicle);
  const road::RoadData road =
      road::road_data(similarity.is_identity() ? *track : track->scaled(similarity.length()), kRoadSpacing);
  return safety::known_road(scenario.guard, &road, car);
}

ControlCycle::ControlCycle(std::unique_ptr<controller::Controller> controller,
                           const scenario::Scenario& scenario, const road::Track* track)
    : ControlCycle(std::move(controller), scenario, known_road(scenario, track)) {}

ControlCycle::ControlCycle(std::unique_ptr<controller::Controller> controller,
                           const scenario::Scenario& scenario, road::KnownRoad road)
    : similarity_{scenario.vehicle},
      guard_{std::move(controller), full_size(scenario), scenario.guard, std::move(road)} {}

void ControlCycle::use_line(std::shared_ptr<const road::RacingRoad> lap) {
  if (lap) guard_.use_line(std::move(lap));
}

void ControlCycle::begin(std::uint64_t cycle, double longest) noexcept {
  guard_.reset();
  longest_ = longest;
  stop_.size = 0;
  prediction_check_.reset();
  next_ = cycle;
  shows_throttle_ = false;
  begins_ = true;
}

void ControlCycle::configure(const scenario::Scenario& scenario) noexcept {
  const model::VehicleParams car = full_size(scenario);
  controller::Registry::configure(guard_.controller(), scenario.controllers, car);
  guard_.set_vehicle(car);
  if (scenario.guard.road == safety::GuardRoad::kWaypoints) guard_.forget_road();
}

void ControlCycle::to_scale(controller::StepResult& result) const noexcept {
  const double length = similarity_.length(), time = similarity_.time(), speed = similarity_.speed();
  controller::Plan& plan = result.plan;
  for (int i = 0; i < plan.size; ++i) {
    controller::PlanPoint& point = plan.points[static_cast<std::size_t>(i)];
    point.time /= time;
    point.x /= length;
    point.y /= length;
    point.speed /= speed;
  }
  for (int i = 0; i < plan.reference_size; ++i) plan.reference[static_cast<std::size_t>(i)] /= length;
  controller::StepReport& report = result.report;
  report.act_time /= time;
  report.delay /= time;
  report.learned.delay.value /= time;
  report.learned.delay.deviation /= time;
  report.lateral_error /= length;
  report.sight /= length;
  report.speed_reference /= speed;
  report.explanation.speed_limit /= speed;
}

void ControlCycle::scale_stop() noexcept {
  const safety::StopPlan& stop = guard_.stop();
  stop_.size = stop.size;
  for (std::size_t i = 0; i < static_cast<std::size_t>(stop.size); ++i) {
    stop_.points[i] = stop.points[i];
    stop_.points[i].time /= similarity_.time();
    stop_.points[i].distance /= similarity_.length();
    stop_.points[i].speed /= similarity_.speed();
  }
}

void ControlCycle::step(const CycleInput& input, telemetry::Frame& frame) noexcept {
  const auto started = std::chrono::steady_clock::now();
  DeadlineLog questions{.spent_at = input.deadline_spent_at};
  frame.begins = std::exchange(begins_, false);
  frame.cycle = next_++;
  frame.time = frame.measurement.time;
  frame.gate_interval = frame.begins ? 0.0 : input.interval;
  longest_ = std::max(frame.gate_interval, longest_ * (1.0 - frame.gate_interval / kLateMemory));
  const double time = similarity_.time();
  shows_throttle_ |= !frame.begins && frame.measurement.throttle > 0.0;  // the first may be of a last run
  if (shows_throttle_ &&
      guard_.is_stopped_by_receiver(similarity_.full_size(frame.measurement), time * longest_))
    longest_ = std::max(
        longest_, std::min(longest_ + frame.gate_interval, safety::PredictiveFilter::kLongestHold / time));
  frame.longest_interval = longest_;
  frame.is_manual = input.manual.has_value();
  if (input.manual) frame.manual = *input.manual;
  const safety::Guard::Cycle cycle{
      .interval = time * frame.gate_interval, .manual = input.manual, .longest = time * longest_};
  const Deadline deadline = input.deadline.counted_in(questions);
  if (similarity_.is_identity()) {
    frame.asked = guard_.step(frame.measurement, deadline, cycle, frame.result);
  } else {
    frame.asked = guard_.step(similarity_.full_size(frame.measurement), deadline, cycle, frame.result);
    to_scale(frame.result);
    scale_stop();
  }
  frame.guard = guard_.report();
  frame.guard.stop_edge /= similarity_.length();
  frame.guard.stop_distance /= similarity_.length();
  frame.deadline_spent_at = questions.spent_at;
  frame.step_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  frame.solve_time = frame.result.report.solve_time;

  const Vec2 position =
      frame.has_truth ? Vec2{frame.truth.x, frame.truth.y} : Vec2{frame.measurement.x, frame.measurement.y};
  frame.prediction_error = prediction_check_.error(frame.time, position);
  prediction_check_.add(frame.result.plan, input.interval);
}

}  // namespace chicane::run
