// SPDX-License-Identifier: MIT
// A controller that the library does not know, in all that the library has: latency, a fault, the guard,
// metrics, a recording, and its replay by this program.
#include <algorithm>
#include <chicane/base/math.hpp>
#include <chicane/protocol/library.hpp>
#include <chicane/recording/recorder.hpp>
#include <chicane/recording/replay.hpp>
#include <chicane/run/closed_loop.hpp>
#include <cstdio>
#include <memory>

using namespace chicane;

namespace {

/// Pure pursuit of the fourth waypoint at 12 m/s. Asks for twice the steering lock now and then.
class Chaser final : public controller::Controller {
 public:
  const controller::StepResult& step(const model::Measurement& now, Deadline) noexcept override {
    result_.answer = now.waypoint_count > 3 ? controller::Answer::kDrive : controller::Answer::kNone;
    const Vec2 ahead = now.waypoints[3] - Vec2(now.x, now.y);
    const double left = chicane::cos(now.psi) * ahead.y() - chicane::sin(now.psi) * ahead.x();
    result_.command.steer = 5.7 * left / std::max(1.0, ahead.squared_norm());
    result_.command.throttle = std::clamp(0.2 * (12.0 - now.speed) + 0.2, -0.1, 1.0);
    if (++steps_ == 500) result_.command.steer = 2.0;
    return result_;
  }
  void reset() noexcept override { steps_ = 0; }
  [[nodiscard]] std::string_view name() const noexcept override { return "chaser"; }

 private:
  controller::StepResult result_;
  int steps_ = 0;
};

Result<std::unique_ptr<controller::Controller>> make_chaser(const scenario::Scenario&) {
  return std::make_unique<Chaser>();
}

int say(const Error& error) {
  std::puts(error.message.c_str());
  return 2;
}

}  // namespace

int main(int, char** arguments) {
  auto scenario = protocol::compose({.scenario_file = {}, .settings = {{"laps", "1"}, {"latency_ms", "80"}}});
  if (!scenario) return say(scenario.error());
  scenario->faults = {sim::default_event(*sim::fault_named("nan_measurement"), 15.0)};
  const auto loop = run::ClosedLoop::create(*scenario, make_chaser);
  if (!loop) return say(loop.error());
  protocol::Run description;
  protocol::describe((*loop)->controller(), description);
  auto recorder = recording::Recorder::create(
      {.path = arguments[1], .run = description, .scenario = *scenario, .may_wait = true});
  if (!recorder) return say(recorder.error());
  const telemetry::RunSummary run = run::run_closed_loop(
      **loop, {.on_frame = [&](const telemetry::Frame& frame) { (*recorder)->record(frame); },
               .on_lap = [&](const telemetry::CompletedLap& lap) { (*recorder)->record(lap); }});
  if (const auto done = (*recorder)->finish(); !done) return say(done.error());
  const auto again = recording::verify_recording(arguments[1], make_chaser);
  if (!again) return say(again.error());
  std::printf(
      "%d lap, %d times off the road, %d fallbacks, %d commands changed by the gate, %d of %d steps "
      "replayed\n",
      run.laps_completed, run.off_track_events, static_cast<int>(run.fallbacks),
      static_cast<int>(run.gate_interventions), static_cast<int>(again->identical),
      static_cast<int>(again->steps));
  const bool has_all =
      run.completed && run.latency == 0.08 && run.fallbacks > 0;  // the silence, and a wild command
  return has_all && again->is_verified() ? 0 : 1;
}
