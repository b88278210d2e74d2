// SPDX-License-Identifier: MIT
// A simulated car and a road that the library does not know, driven by one of its controllers, recorded, and
// replayed by this program.
#include <chicane/base/math.hpp>
#include <chicane/protocol/library.hpp>
#include <chicane/recording/recorder.hpp>
#include <chicane/recording/replay.hpp>
#include <chicane/road/track.hpp>
#include <chicane/run/closed_loop.hpp>
#include <chicane/sim/plant.hpp>
#include <cstdio>
#include <memory>
#include <vector>

using namespace chicane;

namespace {

/// A cart that rolls where its front wheels point.
class Cart final : public sim::Plant {
 public:
  [[nodiscard]] double step_length() const noexcept override { return kStep; }
  void reset(const model::Pose& pose, double speed) noexcept override {
    state_ = {.x = pose.x, .y = pose.y, .psi = pose.psi, .vx = speed};
    output_.speed = speed;
  }
  void set_motion(const Vec2& velocity, double) noexcept override {
    state_.vx = output_.speed = velocity.x();
  }
  void deviate(const sim::PlantDeviation&) noexcept override {}
  void advance(const model::Command& command) noexcept override {
    state_.steer = command.steer;
    state_.vx += kStep * 4.0 * command.throttle;
    state_.x += kStep * state_.vx * chicane::cos(state_.psi);
    state_.y += kStep * state_.vx * chicane::sin(state_.psi);
    state_.psi += kStep * state_.vx / 2.5 * chicane::tan(command.steer);
    output_.speed = state_.vx;
  }
  [[nodiscard]] const model::State& state() const noexcept override { return state_; }
  [[nodiscard]] const sim::PlantOutput& output() const noexcept override { return output_; }
  [[nodiscard]] std::array<Vec2, 4> contact_points() const noexcept override {
    return {Vec2{1.25, 0.7}, Vec2{1.25, -0.7}, Vec2{-1.25, 0.7}, Vec2{-1.25, -0.7}};
  }

 private:
  static constexpr double kStep = 0.01;  // [s]
  model::State state_;
  sim::PlantOutput output_;
};

/// A circle of 80 m, 5 m to each side.
Result<road::Track> make_ring(const scenario::Scenario&) {
  std::vector<road::TrackPoint> points;
  for (int i = 0; i < 50; ++i) {
    const double angle = i * 2.0 * 3.14159265358979 / 50;
    points.push_back({Vec2(80.0 * chicane::cos(angle), 80.0 * chicane::sin(angle)), 5.0, 5.0});
  }
  return road::Track::create("ring", points, true);
}

int say(const Error& error) {
  std::puts(error.message.c_str());
  return 2;
}

}  // namespace

int main(int, char** arguments) {
  const auto scenario =
      protocol::compose({.scenario_file = {}, .settings = {{"preset", "pid"}, {"laps", "1"}}});
  if (!scenario) return say(scenario.error());
  run::Factories parts;
  parts.plant = [](const scenario::Scenario&) -> Result<std::unique_ptr<sim::Plant>> {
    return std::make_unique<Cart>();
  };
  parts.track = make_ring;
  const auto loop = run::ClosedLoop::create(*scenario, parts);
  if (!loop) return say(loop.error());
  protocol::Run description;
  protocol::describe((*loop)->controller(), description);
  auto recorder = recording::Recorder::create(
      {.path = arguments[1], .run = description, .scenario = *scenario, .may_wait = true});
  if (!recorder) return say(recorder.error());
  const telemetry::RunSummary run = run::run_closed_loop(
      **loop, {.on_frame = [&](const telemetry::Frame& frame) { (*recorder)->record(frame); }});
  if (const auto done = (*recorder)->finish(); !done) return say(done.error());
  const auto again = recording::verify_recording(arguments[1], parts);
  if (!again) return say(again.error());
  std::printf("%s: %d lap, slip %.1f m/s, %d of %d steps replayed\n", (*loop)->track().name().c_str(),
              run.laps_completed, (*loop)->car().vy, static_cast<int>(again->identical),
              static_cast<int>(again->steps));
  const bool is_ours = (*loop)->track().name() == "ring" && (*loop)->car().vy == 0.0;
  return is_ours && run.completed && run.off_track_events == 0 && again->is_verified() ? 0 : 1;
}
