// SPDX-License-Identifier: MIT
// A controller of ten lines in the whole loop: simulated car, latency, a fault, the guard, metrics and
// report.
#include <algorithm>
#include <cstdio>
#include <memory>

#include "chicane/base/math.hpp"
#include "chicane/protocol/json_report.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/run/closed_loop.hpp"

using namespace chicane;

// [controller]
/// Steers at the third waypoint of the measurement and holds 10 m/s.
class ChaseThirdWaypoint final : public controller::Controller {
 public:
  const controller::StepResult& step(const model::Measurement& now, Deadline) noexcept override {
    // Without an answer the guard falls back on the last commands, and brakes.
    result_.answer = now.waypoint_count > 2 ? controller::Answer::kDrive : controller::Answer::kNone;
    const Vec2 ahead = now.waypoints[2] - Vec2(now.x, now.y);
    const double to_the_left = chicane::cos(now.psi) * ahead.y() - chicane::sin(now.psi) * ahead.x();
    const double curvature = 2.0 * to_the_left / std::max(1.0, ahead.squared_norm());  // of the circle there
    result_.command.steer = std::clamp(2.87 * curvature, -0.4, 0.4);
    result_.command.throttle = std::clamp(0.2 * (10.0 - now.speed) + 0.2, 0.0, 1.0);
    return result_;
  }
  void reset() noexcept override {}
  [[nodiscard]] std::string_view name() const noexcept override { return "chase-third-waypoint"; }

 private:
  controller::StepResult result_;
};
// [/controller]

// [loop]
int main() {
  auto scenario = protocol::compose({.scenario_file = "first-lap", .settings = {{"laps", "1"}}});
  if (!scenario) return std::puts(scenario.error().message.c_str()), 2;
  scenario->controller = scenario->preset = "chase-third-waypoint";
  scenario->faults = {sim::default_event(*sim::fault_named("link_lost"), 20.0)};  // 1 s
  const auto make = [](const scenario::Scenario&) -> Result<std::unique_ptr<controller::Controller>> {
    return std::make_unique<ChaseThirdWaypoint>();
  };
  const auto loop = run::ClosedLoop::create(*scenario, make);
  if (!loop) return std::puts(loop.error().message.c_str()), 2;
  const telemetry::RunSummary run = run::run_closed_loop(**loop);
  std::fputs(protocol::to_table(run).c_str(), stdout);
  return telemetry::completed_on_road(run) && run.fallbacks > 0 ? 0 : 1;
}
// [/loop]
