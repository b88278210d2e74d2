// SPDX-License-Identifier: MIT
// Publisher of a live run: sends frames, laps, changes and the end to viewers, recorder, log and callbacks.
#include "chicane/live/run_publisher.hpp"

#include <string>
#include <utility>

#include "chicane/run/racing.hpp"

namespace chicane::live {

wire::ViewerServices run_services(run::RunControls& controls) {
  wire::ViewerServices services;
  services.pause = [&controls](bool is_paused) -> Result<void> {
    controls.is_paused = is_paused;
    return {};
  };
  services.step = [&controls]() -> Result<void> {
    if (!controls.is_paused) return fail(ErrorCode::kInvalidArgument, "the run is not paused");
    ++controls.steps;
    return {};
  };
  services.reset = [&controls]() -> Result<void> {
    controls.wants_restart = true;
    return {};
  };
  return services;
}

LiveSettingsOptions with_viewer(wire::ViewerEndpoint& viewer, LiveSettingsOptions options) {
  options.on_building = [&viewer](const std::string& what) {
    viewer.change_run([what](protocol::Run& run) { run.building = what; });
  };
  options.on_accepted = [&viewer](const scenario::Scenario& now) {
    viewer.change_run([latency = now.latency, vehicle = now.vehicle](protocol::Run& run) {
      run.latency = latency;
      run.vehicle = vehicle;
    });
  };
  return options;
}

RunPublisher::RunPublisher(wire::ViewerEndpoint& viewer, LiveSettings& settings, RunListeners listeners)
    : viewer_{viewer}, settings_{settings}, to_{std::move(listeners)}, faults_{protocol::fault_controls()} {}

void RunPublisher::frame(const telemetry::Frame& frame) {
  if (frame.begins && frame.cycle == 0) has_reported_end_ = false;
  record_limit();
  if (to_.recorder != nullptr) to_.recorder->record(frame);
  if (to_.log != nullptr) to_.log->note(frame);
  if (to_.hooks.on_frame) to_.hooks.on_frame(frame);
  viewer_.publish(frame);
  time_ = frame.time;
  tell_faults(frame);
}

void RunPublisher::lap(const telemetry::CompletedLap& lap) {
  if (to_.recorder != nullptr) to_.recorder->record(lap);
  if (to_.log != nullptr) to_.log->note(lap);
  if (to_.hooks.on_lap) to_.hooks.on_lap(lap);
  viewer_.publish(lap, time_);
}

void RunPublisher::tell_faults(const telemetry::Frame& frame) {
  const std::uint32_t changed = frame.active_faults ^ reported_faults_;
  for (std::size_t i = 0; i < faults_.size() && changed != 0U; ++i) {
    if ((changed >> i & 1U) == 0U) continue;
    const bool is_on = (frame.active_faults >> i & 1U) != 0U;
    change({.cycle = frame.cycle + 1,
            .time = frame.time,
            .name = faults_[i].key,
            .value = is_on ? "true" : "false"});
  }
}

void RunPublisher::change(const telemetry::Change& change) {
  for (std::size_t i = 0; i < faults_.size(); ++i) {
    if (faults_[i].key != change.name.view()) continue;
    const bool is_on = change.value.view() != "false";
    reported_faults_ = (reported_faults_ & ~(1U << i)) | (is_on ? 1U << i : 0U);
  }
  if (to_.recorder != nullptr) to_.recorder->record(change);
  if (to_.log != nullptr) to_.log->note(change);
  if (to_.hooks.on_change) to_.hooks.on_change(change);
  settings_.tell(change);
  if (change.name.view() == run::LapPlanner::kChange)
    say("races by a new lap, planned with " + std::string(change.value.view()) + " of the configured grip");
}

void RunPublisher::say(std::string_view line) const {
  if (to_.hooks.say) to_.hooks.say(line);
}

void RunPublisher::record_limit() {
  if (to_.recorder == nullptr || to_.limit == nullptr) return;
  if (auto news = to_.limit->news()) to_.recorder->record(std::move(news));
}

void RunPublisher::compare(telemetry::RunSummary& summary, const std::atomic<bool>& wants_stop) {
  if (to_.limit->is_awaited(summary) && !wants_stop)
    say("the limit is still being computed; Ctrl-C does without");
  to_.limit->compare(summary, wants_stop);
  record_limit();
}

bool RunPublisher::end(const telemetry::RunSummary& summary) {
  if (std::exchange(has_reported_end_, true)) return false;
  if (summary.completed)
    viewer_.set_end("finished", "");
  else if (summary.laps_wanted == 0 || summary.end_reason == "stopped")
    viewer_.set_end("stopped", "stopped by its operator");
  else
    viewer_.set_end("failed", summary.end_reason);
  return true;
}

}  // namespace chicane::live
