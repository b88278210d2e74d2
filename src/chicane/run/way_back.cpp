// SPDX-License-Identifier: MIT
// Runs that start beside the road or out of control: random starts, and the drive of one of them.
#include "chicane/run/way_back.hpp"

#include <algorithm>
#include <cmath>

#include "chicane/base/math.hpp"
#include "chicane/base/random.hpp"
#include "chicane/run/closed_loop.hpp"

namespace chicane::run {
namespace {

constexpr double kStandingSpeed = 0.3;  // [m/s] speed below which the car stands; chosen

/// Motion of the centre of mass. Random values are drawn in this order.
struct Motion {
  double yaw_rate = 0.0;  ///< [rad/s]
  double slip = 0.0;      ///< direction of the velocity off the car's heading, left positive [rad]
  double speed = 0.0;     ///< [m/s]
};

/// Random number with magnitude in [low, high] and either sign.
double either_sign(Random& chance, double low, double high) {
  const double value = chance.uniform(low, high);
  return chance.uniform() < 0.5 ? -value : value;
}

/// Random motion of one kind.
Motion random_motion(StartKind kind, Random& chance) {
  switch (kind) {
    case StartKind::kStanding:
      break;
    case StartKind::kRolling:
      return {.speed = chance.uniform(2.0, 25.0)};
    case StartKind::kSliding:
      return {chance.uniform(-1.0, 1.0), chance.uniform(-kPi / 3.0, kPi / 3.0), chance.uniform(5.0, 25.0)};
    case StartKind::kBackwards:
      return {.speed = -chance.uniform(1.0, 8.0)};
    case StartKind::kSpun:
      return {chance.uniform(-3.0, 3.0), either_sign(chance, kPi / 2.0, kPi), chance.uniform(5.0, 20.0)};
  }
  return {};
}

}  // namespace

std::vector<StartPose> start_poses(const road::Track& track, int count, std::uint64_t seed) {
  Random chance(seed);
  std::vector<StartPose> starts;
  starts.reserve(static_cast<std::size_t>(std::max(count, 0)));
  for (int i = 0; i < count; ++i) {
    const auto kind = static_cast<StartKind>(static_cast<std::size_t>(i) % kStartKindNames.size());
    const double s = chance.uniform(0.0, track.length());
    const road::PathPoint at = track.centre().at(s);
    const double d = chance.uniform(-track.right_width(s) - kFarthest, track.left_width(s) + kFarthest);
    StartPose start{.kind = kind};
    start.state.x = at.position.x() - d * sin(at.heading);
    start.state.y = at.position.y() + d * cos(at.heading);
    start.state.psi = at.heading + chance.uniform(-kPi, kPi);
    const Motion motion = random_motion(kind, chance);
    start.state.vx = motion.speed * cos(motion.slip);
    start.state.vy = motion.speed * sin(motion.slip);
    start.state.r = motion.yaw_rate;
    starts.push_back(start);
  }
  return starts;
}

Result<WayBackOutcome> drive_back(const scenario::Scenario& scenario, const StartPose& start, Roads& roads,
                                  const Factories& make) {
  auto created = ClosedLoop::create(endless(scenario), roads, make);
  if (!created) return fail(created.error());
  ClosedLoop& loop = **created;
  loop.restart_at(start.state);
  WayBackOutcome outcome{.start = start};
  constexpr double kNotYet = WayBackOutcome::kNever;
  double along_since = kNotYet;  // time since which the car drives along the road [s]
  const auto end = [&] {
    return outcome.lapping < kNotYet ? outcome.lapping + kWatched : WayBackOutcome::kInTime;
  };
  while (loop.time() < end()) {
    const bool is_new = loop.advance();
    const telemetry::Frame& frame = loop.frame();
    const sim::WorldState& car = loop.world();
    const double edge = car.edge_distance;
    if (outcome.back < kNotYet) outcome.least_edge = std::min(outcome.least_edge, edge);
    if (!is_new) continue;
    const double speed = hypot(frame.truth.vx, frame.truth.vy);
    const double slip = speed > kStandingSpeed ? atan2(frame.truth.vy, frame.truth.vx) : 0.0;
    const double course = wrap_angle(car.heading_error + slip);
    const bool is_along = edge >= 0.0 && std::fabs(course) < kAlong && std::fabs(car.heading_error) < kAlong;
    if (!is_along) along_since = kNotYet;
    if (is_along && along_since == kNotYet) along_since = loop.time();
    if (outcome.back == kNotYet) {
      outcome.farthest = std::max(outcome.farthest, -edge);
      if (loop.time() - along_since > kBack || (is_along && speed < kStandingSpeed))
        outcome.back = loop.time();
    }
    if (outcome.back < kNotYet && outcome.lapping == kNotYet && is_along && speed > kLapping)
      outcome.lapping = loop.time();
  }
  return outcome;
}

}  // namespace chicane::run
