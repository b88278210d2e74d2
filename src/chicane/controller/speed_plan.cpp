// SPDX-License-Identifier: MIT
#include "chicane/controller/speed_plan.hpp"

#include <algorithm>
#include <cmath>

#include "chicane/base/math.hpp"

namespace chicane::controller {
namespace {

constexpr double kSpacing = 1.5;      // [m] wanted between samples
constexpr double kSlopeReach = 3.0;   // [m] each way: shorter changes of curvature than a car are not felt
constexpr double kLowestSpeed = 2.0;  // [m/s] the plan never asks to stop

/// Largest v with v² demand <= share · friction · (load_0 + load_v v).
double speed_for(double demand, const model::VehicleParams& p, double share) {
  const double g0 = share * p.friction * p.load_constant;
  const double g1 = share * p.friction * p.load_per_speed;
  const double d = std::max(demand, 1e-6);
  return (g1 + std::sqrt(g1 * g1 + 4.0 * d * g0)) / (2.0 * d);
}

/// Tyre force demanded per v² by curvature and its slope, at the axle that needs more (eq. 11) [1/m].
double demand_of(double curvature, double slope, const model::VehicleParams& p) {
  const double steady = (1.0 - p.steer_helper) * curvature;
  const double front = std::fabs(steady + p.yaw_inertia / (p.mass * p.rear_axle) * slope);
  const double rear = std::fabs(steady - p.yaw_inertia / (p.mass * p.front_axle) * slope);
  return std::max(front, rear);
}

/// Share of the longitudinal force left beside the lateral use of the friction ellipse (1 for uncoupled
/// tyres).
double longitudinal_share(double v, double demand, const model::VehicleParams& p, double grip) {
  const double use = v * v * demand / (grip * p.friction * (p.load_constant + p.load_per_speed * v));
  return std::sqrt(std::max(0.0, 1.0 - p.friction_coupling * std::min(1.0, use * use)));
}

/// Lowers `speed` to `limit` and remembers why.
void limit_to(double limit, SpeedLimiter reason, double& speed, SpeedLimiter& limiter) {
  if (!(limit < speed)) return;
  speed = limit;
  limiter = reason;
}

}  // namespace

SpeedPlan::SpeedPlan() {
  speed_.assign(static_cast<std::size_t>(kCapacity) * 2, 0.0);
  limiter_.assign(static_cast<std::size_t>(kCapacity), SpeedLimiter::kNone);
}

void SpeedPlan::rebuild(const path::Path& path, const model::VehicleParams& vehicle,
                        const SpeedPlanOptions& options) noexcept {
  count_ = 0;
  if (path.is_empty()) return;
  is_closed_ = path.is_closed();
  const int intervals = std::clamp(static_cast<int>(std::ceil(path.length() / kSpacing)), 2, kCapacity - 1);
  spacing_ = path.length() / intervals;
  count_ = is_closed_ ? intervals : intervals + 1;
  double* const speed = speed_.data();
  double* const demand = speed_.data() + kCapacity;
  SpeedLimiter* const limiter = limiter_.data();

  for (int i = 0; i < count_; ++i) {
    const double s = i * spacing_;
    const double slope =
        (path.at(s + kSlopeReach).curvature - path.at(s - kSlopeReach).curvature) / (2.0 * kSlopeReach);
    demand[i] = demand_of(path.at(s).curvature, slope, vehicle);
    speed[i] = options.speed_limit;
    limiter[i] = SpeedLimiter::kAsked;
    limit_to(speed_for(demand[i], vehicle, options.grip_share), SpeedLimiter::kCurvature, speed[i],
             limiter[i]);
    speed[i] = std::max(speed[i], kLowestSpeed);
  }
  if (!is_closed_) {
    const double end =
        speed_for((1.0 - vehicle.steer_helper) * options.end_curvature, vehicle, options.grip_share);
    limit_to(std::max(end, kLowestSpeed), SpeedLimiter::kSight, speed[count_ - 1], limiter[count_ - 1]);
  }

  // Twice round a closed path, so that the seam agrees.
  const int steps = is_closed_ ? 2 * count_ : count_ - 1;
  for (int i = 0; i < steps; ++i) {
    const int from = i % count_;
    const int to = (i + 1) % count_;
    const double v = speed[from];
    const double share = longitudinal_share(v, demand[from], vehicle, options.grip_share);
    const double drag = longitudinal_acceleration(vehicle, 0.0, v);
    const double drive = longitudinal_acceleration(vehicle, 1.0, v) - drag;
    const double a = options.drive_share * share * drive + drag;
    limit_to(std::sqrt(std::max(kLowestSpeed * kLowestSpeed, v * v + 2.0 * a * spacing_)),
             SpeedLimiter::kPower, speed[to], limiter[to]);
  }
  for (int i = steps; i > 0; --i) {
    const int from = i % count_;
    const int to = (i - 1) % count_;
    const double v = speed[from];
    const double share = longitudinal_share(v, demand[from], vehicle, options.grip_share);
    const double drag = longitudinal_acceleration(vehicle, 0.0, v);
    const double brake = drag - longitudinal_acceleration(vehicle, -vehicle.brake_throttle_limit, v);
    const double a = options.brake_share * share * brake - drag;
    // Braking for the end of sight is for want of sight.
    const bool is_blind = limiter[from] == SpeedLimiter::kSight;
    limit_to(std::sqrt(v * v + 2.0 * a * spacing_), is_blind ? SpeedLimiter::kSight : SpeedLimiter::kBraking,
             speed[to], limiter[to]);
  }
}

SpeedPlan::Sample SpeedPlan::at(double s) const noexcept {
  if (count_ < 2) return {};
  const double position = s / spacing_;
  const double floor = std::floor(position);
  const double share = position - floor;
  auto index = static_cast<long>(floor);
  long next = index + 1;
  if (is_closed_) {
    index = ((index % count_) + count_) % count_;
    next = (index + 1) % count_;
  } else {
    index = std::clamp<long>(index, 0, count_ - 1);
    next = std::clamp<long>(next, 0, count_ - 1);
  }
  const double v0 = speed_[static_cast<std::size_t>(index)];
  const double v1 = speed_[static_cast<std::size_t>(next)];
  return {v0 + share * (v1 - v0), (v1 - v0) / spacing_, limiter_[static_cast<std::size_t>(index)]};
}

}  // namespace chicane::controller
