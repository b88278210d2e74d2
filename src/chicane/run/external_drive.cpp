// SPDX-License-Identifier: MIT
// Control cycles of an external car: its clock, gaps in its measurements, its road, settings and planned
// laps.
#include "chicane/run/external_drive.hpp"

#include <limits>
#include <utility>
#include <variant>

#include "chicane/base/duration.hpp"
#include "chicane/run/roads.hpp"

namespace chicane::run {
namespace {

// Assumed interval by a new clock, before one was measured; chosen [s].
constexpr double kFirstInterval = 0.42;
// Delays that a gap may last beyond ExternalDriveOptions::forget_after; chosen.
constexpr double kGapInDelays = 2.0;

/// Measurement of a cycle in which nothing was measured: not-a-number everywhere.
model::Measurement nothing_measured() {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  model::Measurement none;
  none.x = none.y = none.psi = none.speed = none.steer = none.throttle = kUnknown;
  return none;
}

}  // namespace

ExternalDrive::ExternalDrive(ExternalDriveOptions options, std::unique_ptr<controller::Controller> controller,
                             const ExternalDriveHooks& hooks)
    : options_{std::move(options)},
      hooks_{hooks},
      scenario_{options_.scenario},
      cycle_{std::move(controller), options_.scenario, options_.track},
      account_{options_.track, options_.scenario, options_.remedy},
      clock_{options_.clock, options_.scenario.vehicle, Clock::now()} {
  cycle_.use_line(options_.lap);
}

void ExternalDrive::begin() {
  clock_.begin();
  has_clock_news_ = false;
  begin_on_link(0.0);
  begins_again_ = false;
}

void ExternalDrive::begin_on_link(double longest) {
  clock_.pause();
  cycle_.begin(cycle_.next(), longest);
  last_received_.reset();
  last_time_.reset();
  account_.resume();
}

std::optional<double> ExternalDrive::gap(Clock::time_point received) const {
  if (!last_received_) return std::nullopt;
  return seconds(received - *last_received_);
}

const telemetry::Frame& ExternalDrive::step(const Sighting& sighting) {
  if (const auto since = gap(sighting.received)) watch_gap(*since, sighting.usual_delay);
  const bool is_another_clock = count_time(sighting);
  last_received_ = sighting.received;
  const double now = time(sighting.received);
  take_up_changes(now);
  check_road(sighting);
  frame_.has_measurement = sighting.measured.has_value();
  frame_.measurement = frame_.has_measurement ? *sighting.measured : nothing_measured();
  frame_.measurement.time = now;
  frame_.measurement.delay = clock_.delay(sighting.delay);
  if (is_another_clock) {
    frame_.measurement.steer = last_sent_.steer;
    frame_.measurement.throttle = last_sent_.throttle;
  }
  frame_.applied = last_sent_;
  const Deadline deadline =
      options_.step_budget.count() > 0 ? Deadline::after(options_.step_budget) : Deadline::stopwatch();
  cycle_.step({.deadline = deadline, .interval = last_time_ ? now - *last_time_ : 0.0}, frame_);
  last_time_ = now;
  last_sent_ = frame_.result.command;
  return frame_;
}

void ExternalDrive::finish() {
  frame_.lateral_error = frame_.result.report.lateral_error;
  frame_.heading_error = frame_.result.report.heading_error;
  account_.judge(frame_);
  if (const auto lap = account_.take_lap(); lap && hooks_.on_lap) hooks_.on_lap(*lap);
  if (hooks_.on_frame) hooks_.on_frame(frame_);
  const road::Track* track = is_other_road_ ? nullptr : options_.track;
  const auto planned = planner_.advance(cycle_, scenario_, track, frame_.time);
  if (planned && hooks_.on_change) hooks_.on_change(*planned);
}

// After a gap it is unknown whether the car stopped or continued with the last command. The first measurement
// after a gap may have waited as long, so that the second restarts the cycle as well.
void ExternalDrive::watch_gap(double gap, double delay) {
  const bool is_long = gap > seconds(options_.forget_after) + kGapInDelays * delay;
  if (is_long || begins_again_) begin_anew();
  begins_again_ = is_long;
}

bool ExternalDrive::count_time(const Sighting& sighting) {
  const model::Measurement* measured = sighting.measured ? &*sighting.measured : nullptr;
  const bool is_another = clock_.advance(sighting.received, measured, std::exchange(acting_, last_sent_));
  if (is_another) begin_on_link(clock_.delay(kFirstInterval));
  has_clock_news_ |= is_another;
  if (has_clock_news_ && clock_.is_settled()) {
    has_clock_news_ = false;
    if (hooks_.on_clock) hooks_.on_clock(clock_.news());
  }
  return is_another;
}

void ExternalDrive::check_road(const Sighting& sighting) {
  if (options_.track == nullptr || is_other_road_ || !sighting.measured) return;
  const auto distance = distance_to_other_road(*options_.track, *sighting.measured);
  if (!distance) return;
  is_other_road_ = true;
  const telemetry::Change change{
      .cycle = cycle_.next(), .time = time(sighting.received), .name = "guard.road", .value = "waypoints"};
  scenario_.guard.road = safety::GuardRoad::kWaypoints;
  cycle_.configure(scenario_);
  account_.forget_track();
  if (hooks_.on_change) hooks_.on_change(change);
  if (hooks_.on_other_road) hooks_.on_other_road(*distance);
}

void ExternalDrive::take_up_changes(double time) {
  while (const Setting* next = hooks_.settings == nullptr ? nullptr : hooks_.settings->front()) {
    telemetry::Change change = next->change;
    change.cycle = cycle_.next();
    change.time = time;
    if (const auto* field = std::get_if<FieldValue>(&next->action)) {
      write(scenario_, *field);
      cycle_.configure(scenario_);
    }
    hooks_.settings->pop();
    if (hooks_.on_change) hooks_.on_change(change);
  }
}

}  // namespace chicane::run
