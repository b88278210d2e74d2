// SPDX-License-Identifier: MIT
#include "chicane/controller/described_model.hpp"

#include <algorithm>
#include <cmath>

#include "chicane/base/math.hpp"

namespace chicane::controller {
namespace {

/// No answer is half a second late: beyond it a measurement of the loop time says more about the clock than
/// about the loop.
constexpr double kMaxLatency = 0.5;

}  // namespace

Motion roll_position(const Motion& from, double latency) noexcept {
  Motion to = from;
  to.pose.x += from.speed * cos(from.pose.psi) * latency;
  to.pose.y += from.speed * sin(from.pose.psi) * latency;
  return to;
}

Motion roll_kinematic(const Motion& from, const model::Command& acting, double latency,
                      double kinematic_length) noexcept {
  Motion to = roll_position(from, latency);
  to.pose.psi += from.speed * acting.steer / kinematic_length * latency;
  to.speed += acting.throttle * latency;
  return to;
}

Motion roll_accelerating(const Motion& from, const model::Command& acting, double latency,
                         double kinematic_length, bool has_term) noexcept {
  const double curvature = tan(acting.steer) / kinematic_length;
  Motion to = roll_position(from, latency);
  const double term = has_term ? 0.5 * acting.throttle * curvature * latency * latency : 0.0;
  to.pose.psi += from.speed * curvature * latency + term;
  to.speed += acting.throttle * latency;
  return to;
}

Motion RollForward::predict(const model::Measurement& now) noexcept {
  const bool is_rolled = handling_ != LatencyHandling::kNone && handling_ != LatencyHandling::kInsideModel;
  const double unit = is_rolled ? speed_unit_ : 1.0;
  Motion rolled = roll(now, {{now.x, now.y, now.psi}, now.speed * unit});
  rolled.speed /= unit;
  return rolled;
}

Motion RollForward::roll(const model::Measurement& now, const Motion& seen) noexcept {
  const model::Command acting{now.steer, now.throttle};
  switch (handling_) {
    case LatencyHandling::kNone:
    case LatencyHandling::kInsideModel:
      return seen;
    case LatencyHandling::kPositionOnly:
      return roll_position(seen, latency_);
    case LatencyHandling::kRollForward:
      return roll_kinematic(seen, acting, latency_, kinematic_length_);
    case LatencyHandling::kMeasured:
      if (std::isfinite(now.delay)) latency_ = 0.5 * (latency_ + std::clamp(now.delay, 0.0, kMaxLatency));
      return roll_accelerating(seen, acting, latency_, kinematic_length_, has_term_);
  }
  return seen;
}

double RollForward::compensated() const noexcept {
  const bool is_rolled = handling_ != LatencyHandling::kNone && handling_ != LatencyHandling::kInsideModel;
  return is_rolled ? latency_ : 0.0;
}

}  // namespace chicane::controller
