// SPDX-License-Identifier: MIT
#include "environment.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "chicane/base/math.hpp"
#include "chicane/protocol/schema.hpp"
#include "chicane/protocol/schema_json.hpp"
#include "chicane/run/setting.hpp"

namespace chicane::python {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint64_t kOfEpisodes = 0x65706973;  // keeps the draws apart from the noise of the same seed
constexpr double kCrossing = 10.0;                 // [m] within which roads that cross are told apart
constexpr double kNear = 5.0;                  // [m] of road that are searched first, beyond what is driven
constexpr double kRounding = 1e-6;             // [m]
constexpr double kLaserAhead = 0.275 / 0.307;  // of the rear axle, in wheelbases, as of F1TENTH
constexpr double kWallSpacing = 0.5;  // between points of the walls [m], times the scale of a model car

std::size_t size_of(Observation observation, const scenario::Scenario& scenario) {
  const auto waypoints = static_cast<std::size_t>(scenario.waypoints_sent);
  switch (observation) {
    case Observation::kTrack:
      return 5 + Environment::kCurvatures;
    case Observation::kWaypoints:
      return 3 + 2 * waypoints;
    case Observation::kScan:
      return 3 + static_cast<std::size_t>(sim::RangeScannerOptions{}.beams);
    case Observation::kPose:
      break;
  }
  return 7;
}

}  // namespace

/// Answers with the command that was set.
class Environment::Agent final : public controller::Controller {
 public:
  void set(const model::Command& command) noexcept {
    const bool is_finite = std::isfinite(command.steer) && std::isfinite(command.throttle);
    result_.answer = is_finite ? controller::Answer::kDrive : controller::Answer::kNone;
    if (is_finite) result_.command = command;
  }
  const controller::StepResult& step(const model::Measurement&, Deadline) noexcept override {
    return result_;
  }
  void reset() noexcept override { result_ = {}; }
  [[nodiscard]] std::string_view name() const noexcept override { return "agent"; }

 private:
  controller::StepResult result_;
};

Environment::Environment(const scenario::Scenario& scenario, EnvironmentOptions options,
                         std::shared_ptr<run::Roads> roads)
    : scenario_{scenario},
      options_{std::move(options)},
      size_{size_of(options_.observation, scenario)},
      roads_{std::move(roads)},
      drawn_(options_.draws.size(), kUnknown) {}

Result<std::unique_ptr<Environment>> Environment::create(const scenario::Scenario& scenario,
                                                         EnvironmentOptions options,
                                                         std::shared_ptr<run::Roads> roads) {
  std::unique_ptr<Environment> made(new Environment(scenario, std::move(options), std::move(roads)));
  made->scenario_.controller = made->scenario_.preset = "agent";
  if (const Result<void> begun = made->reset(scenario.seed); !begun) return fail(begun.error());
  if (made->options_.observation == Observation::kScan) {
    auto scanner = sim::RangeScanner::create(
        made->loop_->track(), {.spacing = std::max(0.05, kWallSpacing * scenario.vehicle.scale)});
    if (!scanner) return fail(scanner.error());
    made->scanner_ = std::move(*scanner);
  }
  return made;
}

/// The scenario of one episode.
Result<scenario::Scenario> Environment::draw(Random& random) {
  scenario::Scenario scenario = scenario_;
  for (std::size_t i = 0; i < options_.draws.size(); ++i) {
    const Draw& each = options_.draws[i];
    drawn_[i] = random.uniform(each.low, each.high);
    const protocol::Parameter* row = protocol::find(each.key);
    if (row == nullptr)
      return fail(ErrorCode::kInvalidArgument, each.key + ": " + protocol::unknown_key(each.key));
    if (Result<void> set = protocol::set(scenario, *row, drawn_[i]); !set) return fail(set.error());
  }
  if (options_.faults.empty()) return scenario;
  const auto chosen =
      static_cast<std::size_t>(random.uniform() * static_cast<double>(options_.faults.size()));
  const Result<sim::FaultEvent> event = protocol::parse_fault(options_.faults[chosen]);
  if (!event) return fail(event.error());
  scenario.faults.push_back(*event);
  return scenario;
}

Result<void> Environment::reset(std::uint64_t seed) {
  Random random(seed ^ kOfEpisodes);
  Result<scenario::Scenario> scenario = draw(random);
  if (!scenario) return fail(scenario.error());
  scenario->seed = seed;
  Agent* agent = nullptr;
  const auto make = [&](const auto&) -> Result<std::unique_ptr<controller::Controller>> {
    auto made = std::make_unique<Agent>();
    agent = made.get();
    return made;
  };
  Result<std::unique_ptr<run::ClosedLoop>> loop = run::ClosedLoop::create(*scenario, *roads_, make);
  if (!loop) return fail(loop.error());
  loop_ = std::move(*loop);
  agent_ = agent;
  if (options_.starts_anywhere) place(random);
  seen_ = loop_->look();
  foot_ = {.distance = kUnknown};
  find_foot();
  progress_ = loop_->world().progress;
  off_track_events_ = 0;
  has_ended_ = false;
  steps_ = 0;
  return {};
}

/// Stands the car anywhere on the centre line.
void Environment::place(Random& random) {
  const road::Path& centre = loop_->track().centre();
  const road::PathPoint at = centre.at(random.uniform(0.0, centre.length()));
  loop_->restart_at({.x = at.position.x(), .y = at.position.y(), .psi = at.heading});
}

/// The foot of the measured place on the centre line. A place on the road near the foot before is that of no
/// other road, as roads keep apart (road::Track): the whole line is searched for others only.
void Environment::find_foot() noexcept {
  if (options_.observation != Observation::kTrack || !std::isfinite(seen_.x + seen_.y + seen_.psi)) return;
  const road::Track& track = loop_->track();
  const scenario::Scenario& scenario = loop_->scenario();
  const Vec2 at(seen_.x, seen_.y);
  if (std::isfinite(foot_.distance)) {
    const double driven = std::fabs(seen_.speed) * scenario.control_period;
    const road::Projection near =
        track.centre().project(at, foot_.s, kNear * scenario.vehicle.scale + 2.0 * driven);
    const bool is_foot = near.distance <= std::fabs(near.d) + kRounding;  // not the end of what was searched
    if (is_foot && track.edge_distance(near) >= 0.0) {
      foot_ = near;
      return;
    }
  }
  foot_ = track.centre().project_along(at, seen_.psi, kCrossing * scenario.vehicle.scale);
}

StepOutcome Environment::step(const model::Command& action) noexcept {
  if (has_ended_) return {.truncated = true};
  agent_->set(action);
  do {
    loop_->advance();
  } while (!loop_->is_control_due() && !loop_->is_over());
  seen_ = loop_->look();
  find_foot();
  ++steps_;
  const sim::WorldState& world = loop_->world();
  StepOutcome outcome{.reward = world.progress - progress_};
  progress_ = world.progress;
  const bool has_left = world.off_track_events > off_track_events_;
  off_track_events_ = world.off_track_events;
  if (has_left) outcome.reward -= options_.off_road_cost;
  const int laps = loop_->scenario().laps;
  outcome.terminated =
      (has_left && options_.ends_off_road) || (laps > 0 && world.lap >= laps) || world.is_finished;
  const bool is_late = options_.episode_limit > 0.0 && loop_->time() >= options_.episode_limit - 1e-9;
  outcome.truncated = !outcome.terminated && (is_late || loop_->is_over());
  has_ended_ = outcome.terminated || outcome.truncated;
  return outcome;
}

void Environment::observe(std::span<double> to) const noexcept {
  switch (options_.observation) {
    case Observation::kTrack:
      return observe_track(to);
    case Observation::kWaypoints:
      return observe_waypoints(to);
    case Observation::kPose:
      return observe_pose(to);
    case Observation::kScan:
      return observe_scan(to);
  }
}

void Environment::observe_track(std::span<double> to) const noexcept {
  std::fill(to.begin(), to.end(), kUnknown);
  to[0] = seen_.speed;
  to[3] = seen_.steer;
  to[4] = seen_.throttle;
  if (!std::isfinite(seen_.x + seen_.y + seen_.psi)) return;
  const road::Path& centre = loop_->track().centre();
  const double scale = loop_->scenario().vehicle.scale;
  to[1] = foot_.d;
  to[2] = wrap_angle(seen_.psi - centre.at(foot_.s).heading);
  for (int i = 0; i < kCurvatures; ++i)
    to[static_cast<std::size_t>(5 + i)] = centre.at(foot_.s + kSpacing * scale * (i + 1)).curvature;
}

void Environment::observe_waypoints(std::span<double> to) const noexcept {
  std::fill(to.begin(), to.end(), kUnknown);
  to[0] = seen_.speed;
  to[1] = seen_.steer;
  to[2] = seen_.throttle;
  const double c = chicane::cos(seen_.psi), s = chicane::sin(seen_.psi);
  const std::size_t room = (to.size() - 3) / 2;
  for (std::size_t i = 0; i < std::min(room, static_cast<std::size_t>(seen_.waypoint_count)); ++i) {
    const Vec2 d = seen_.waypoints[i] - Vec2(seen_.x, seen_.y);
    to[3 + 2 * i] = c * d.x() + s * d.y();
    to[4 + 2 * i] = c * d.y() - s * d.x();
  }
}

void Environment::observe_pose(std::span<double> to) const noexcept {
  const std::array<double, 7> numbers{seen_.time,  seen_.x,     seen_.y,       seen_.psi,
                                      seen_.speed, seen_.steer, seen_.throttle};
  std::copy(numbers.begin(), numbers.end(), to.begin());
}

/// The laser has no noise and no delay. What is further away than it reaches is at its range.
void Environment::observe_scan(std::span<double> to) const noexcept {
  constexpr std::size_t kBeams = sim::RangeScannerOptions{}.beams;
  std::array<float, kBeams> ranges{};
  const model::State& car = loop_->car();
  const model::VehicleParams& vehicle = loop_->scenario().vehicle;
  const double ahead = kLaserAhead * vehicle.wheelbase() - vehicle.rear_axle;
  scanner_->scan({car.x + ahead * chicane::cos(car.psi), car.y + ahead * chicane::sin(car.psi), car.psi},
                 ranges);
  to[0] = seen_.speed;
  to[1] = seen_.steer;
  to[2] = seen_.throttle;
  const double most = scanner_->options().range_max;
  for (std::size_t i = 0; i < kBeams; ++i) to[3 + i] = std::min(static_cast<double>(ranges[i]), most);
}

Result<void> Environment::set(const std::string& key, const std::string& text) {
  const Result<run::Setting> setting = run::read_setting({.name = key, .value = text});
  if (!setting) return fail(setting.error());
  loop_->apply(*setting);
  return {};
}

}  // namespace chicane::python
