// SPDX-License-Identifier: MIT
#include "chicane/run/control_cycle.hpp"

#include <chrono>
#include <utility>

#include "chicane/path/road_data.hpp"
#include "chicane/run/make.hpp"

namespace chicane::run {

namespace {

constexpr double kRoadSpacing = 2.0;  // [m] of the road that the guard knows

safety::Guard make_guard(std::unique_ptr<controller::Controller> controller,
                         const scenario::Scenario& scenario, const path::Track* track) {
  if (track == nullptr) return {std::move(controller), scenario.vehicle, scenario.guard};
  const path::RoadData road = path::road_data(*track, kRoadSpacing);
  return {std::move(controller), scenario.vehicle, scenario.guard, &road};
}

}  // namespace

ControlCycle::ControlCycle(std::unique_ptr<controller::Controller> controller,
                           const scenario::Scenario& scenario, const path::Track* track)
    : guard_{make_guard(std::move(controller), scenario, track)} {}

void ControlCycle::begin(std::uint64_t cycle) noexcept {
  guard_.reset();
  prediction_check_.reset();
  next_ = cycle;
  begins_ = true;
}

void ControlCycle::configure(const scenario::Scenario& scenario) noexcept {
  run::configure(guard_.controller(), scenario);
  guard_.set_vehicle(scenario.vehicle);
}

void ControlCycle::step(const CycleInput& input, telemetry::Frame& frame) noexcept {
  const auto started = std::chrono::steady_clock::now();
  DeadlineLog questions{.spent_at = input.deadline_spent_at};
  frame.begins = std::exchange(begins_, false);
  frame.cycle = next_++;
  frame.time = frame.measurement.time;
  frame.gate_interval = frame.begins ? 0.0 : input.interval;
  frame.is_manual = input.manual.has_value();
  if (input.manual) frame.manual = *input.manual;
  frame.asked = guard_.step(frame.measurement, input.deadline.counted_in(questions),
                            {.interval = frame.gate_interval, .manual = input.manual}, frame.result);
  frame.deadline_spent_at = questions.spent_at;
  frame.step_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  frame.solve_time = frame.result.report.solve_time;

  const Vec2 position =
      frame.has_truth ? Vec2{frame.truth.x, frame.truth.y} : Vec2{frame.measurement.x, frame.measurement.y};
  frame.prediction_error = prediction_check_.error(frame.time, position);
  prediction_check_.add(frame.result.plan, input.interval);
}

}  // namespace chicane::run
