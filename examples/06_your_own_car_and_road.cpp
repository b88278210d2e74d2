// SPDX-License-Identifier: MIT
// A simulated car and a reader of road files that the library does not know, driven by one of its
// controllers.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "chicane/base/math.hpp"
#include "chicane/protocol/json_report.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/run/closed_loop.hpp"
#include "chicane/sim/plant.hpp"

using namespace chicane;

// [car]
/// A cart on tyres that never slip: it rolls where its front wheels point.
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
    state_.vx = std::max(0.0, state_.vx + kStep * 4.0 * command.throttle);
    state_.x += kStep * state_.vx * chicane::cos(state_.psi);
    state_.y += kStep * state_.vx * chicane::sin(state_.psi);
    state_.psi += kStep * state_.vx / kWheelbase * chicane::tan(command.steer);
    output_.speed = state_.vx;
  }
  [[nodiscard]] const model::State& state() const noexcept override { return state_; }
  [[nodiscard]] const sim::PlantOutput& output() const noexcept override { return output_; }
  [[nodiscard]] std::array<Vec2, 4> contact_points() const noexcept override {
    return {Vec2{1.25, 0.7}, Vec2{1.25, -0.7}, Vec2{-1.25, 0.7}, Vec2{-1.25, -0.7}};
  }

 private:
  static constexpr double kStep = 0.01;      // [s]
  static constexpr double kWheelbase = 2.5;  // [m]
  model::State state_;
  sim::PlantOutput output_;
};
// [/car]

// [road]
/// Reads a road of straights and bends, a line each: its length [m] and by how much it turns to the left
/// [degrees]. It is 5 m wide to both sides.
Result<road::Track> read_pieces(const std::string& text, const std::string& file) {
  constexpr double kSpacing = 5.0;
  std::vector<road::TrackPoint> points;
  std::istringstream lines(text);
  Vec2 here{0.0, 0.0};
  double heading = 0.0;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream words(line);
    double length = 0.0, turn = 0.0;
    if (!(words >> length >> turn) || length < kSpacing || length > 1000.0 || std::fabs(turn) > 360.0)
      return fail(ErrorCode::kParse, file + ":" + std::to_string(number) + ": got " + line +
                                         ", expected a length in [5, 1000] m and a turn in [-360, 360] deg");
    const int steps = static_cast<int>(length / kSpacing);
    for (int i = 0; i < steps; ++i) {
      points.push_back({here, 5.0, 5.0});
      heading += turn * kPi / 180.0 / steps / 2.0;  // a chord points where the middle of its arc does
      here += length / steps * Vec2{chicane::cos(heading), chicane::sin(heading)};
      heading += turn * kPi / 180.0 / steps / 2.0;
    }
  }
  return road::Track::create(file, points, true);
}
// [/road]

// [parts]
int main() {
  auto scenario = protocol::compose({.scenario_file = {}, .settings = {{"preset", "pid"}, {"laps", "1"}}});
  if (!scenario) return std::puts(scenario.error().message.c_str()), 2;
  scenario->car = scenario->plant = "cart";  // names in the report
  scenario->track = "ring.pieces";
  run::Factories parts;
  parts.plant = [](const scenario::Scenario&) -> Result<std::unique_ptr<sim::Plant>> {
    return std::make_unique<Cart>();
  };
  parts.track = [](const scenario::Scenario& wanted) {
    return read_pieces("200 0\n188.5 180\n200 0\n188.5 180\n", wanted.track);  // a file's text serves as well
  };
  const auto loop = run::ClosedLoop::create(*scenario, parts);
  if (!loop) return std::puts(loop.error().message.c_str()), 2;
  const telemetry::RunSummary run = run::run_closed_loop(**loop);
  std::fputs(protocol::to_table(run).c_str(), stdout);
  const auto refused = read_pieces("200 0\n188.5 half\n", "ring.pieces");
  return telemetry::completed_on_road(run) && !refused ? 0 : 1;
}
// [/parts]
