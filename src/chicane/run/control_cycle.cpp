// SPDX-License-Identifier: MIT
#include "chicane/run/control_cycle.hpp"

#include <chrono>
#include <utility>

#include "chicane/path/road_data.hpp"
#include "chicane/run/make.hpp"

namespace chicane::run {

namespace {

constexpr double kRoadSpacing = 2.0;  // [m] of the road that the guard knows

}  // namespace

road::KnownRoad known_road(const scenario::Scenario& scenario, const path::Track* track) {
  if (track == nullptr) return safety::known_road(scenario.guard, nullptr, scenario.vehicle);
  const path::RoadData road = path::road_data(*track, kRoadSpacing);
  return safety::known_road(scenario.guard, &road, scenario.vehicle);
}

ControlCycle::ControlCycle(std::unique_ptr<controller::Controller> controller,
                           const scenario::Scenario& scenario, const path::Track* track)
    : ControlCycle(std::move(controller), scenario, known_road(scenario, track)) {}

ControlCycle::ControlCycle(std::unique_ptr<controller::Controller> controller,
                           const scenario::Scenario& scenario, road::KnownRoad road)
    : guard_{std::move(controller), scenario.vehicle, scenario.guard, std::move(road)} {}

void ControlCycle::use_line(std::shared_ptr<const road::RacingRoad> lap) {
  if (lap) guard_.use_line(std::move(lap));
}

void ControlCycle::begin(std::uint64_t cycle) noexcept {
  guard_.reset();
  prediction_check_.reset();
  next_ = cycle;
  begins_ = true;
}

void ControlCycle::configure(const scenario::Scenario& scenario) noexcept {
  run::configure(guard_.controller(), scenario);
  guard_.set_vehicle(scenario.vehicle);
  if (scenario.guard.road == safety::GuardRoad::kWaypoints) guard_.forget_road();
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
