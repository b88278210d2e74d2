// SPDX-License-Identifier: MIT
#include "chicane/road/speed_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "chicane/base/math.hpp"

namespace chicane::road {
namespace {

constexpr double kSlopeReach = 3.0;   // [m] each way: shorter changes of curvature than a car are not felt
constexpr double kLowestSpeed = 2.0;  // [m/s] the plan never asks to stop
constexpr double kTraction = 0.85;    // of the grip: brakes are not all where the load is

/// Largest v with v² demand <= share · friction · load(v).
double speed_for(double demand, const model::VehicleParams& p, double share) {
  const double grip = share * p.cornering_friction();
  const double g0 = grip * p.load_constant;
  const double g1 = grip * p.load_per_speed;
  const double d = std::max(demand - grip * p.load_quadratic, 1e-6);
  return (g1 + std::sqrt(g1 * g1 + 4.0 * d * g0)) / (2.0 * d);
}

/// Tyre force demanded per v² by curvature and its slope, at the axle that needs more (eq. 11) [1/m].
double demand_of(double curvature, double slope, const model::VehicleParams& p) {
  const double steady = (1.0 - p.steer_helper) * curvature;
  const double front = std::fabs(steady + p.yaw_inertia / (p.mass * p.rear_axle) * slope);
  const double rear = std::fabs(steady - p.yaw_inertia / (p.mass * p.front_axle) * slope);
  return std::max(front, rear);
}

/// Share of the grip that is planned with which the tyres use sideways.
double use_of(double v, double demand, const model::VehicleParams& p, double grip) {
  return v * v * demand / (grip * p.cornering_friction() * p.load(v));
}

/// Share of the longitudinal force that the friction ellipse leaves beside it (1 for uncoupled tyres).
double longitudinal_share(double use, const model::VehicleParams& p) {
  if (p.friction_coupling == 0.0) return 1.0;
  return std::sqrt(std::max(0.0, 1.0 - p.friction_coupling * std::min(1.0, use * use)));
}

/// Longitudinal force over mass that tyres which share it between the directions give on a straight road,
/// whatever drive and brakes could: where the grip is less than the car is built for [m/s²].
double traction(double v, const model::VehicleParams& p) {
  if (p.friction_coupling == 0.0) return std::numeric_limits<double>::infinity();
  return kTraction * p.cornering_friction() * p.load(v);
}

/// Lowers the speed to `limit` and remembers why.
void limit_to(double limit, SpeedLimiter reason, ReferenceLine::Sample& sample) {
  if (limit >= sample.speed) return;
  sample.speed = limit;
  sample.limiter = reason;
}

}  // namespace

void SpeedPlan::begin(const model::VehicleParams& vehicle, const SpeedPlanOptions& options) noexcept {
  vehicle_ = vehicle;
  if (!(vehicle == stability_.vehicle())) stability_ = model::BrakingStability(vehicle);
  options_ = options;
  instalments_.restart();
}

bool SpeedPlan::advance(int& work, ReferenceLine& line) noexcept {
  const int last = static_cast<int>(line.samples().size()) - 1;
  if (instalments_.phase() == 0) {
    instalments_.loop(last + 1, 4, work, [&](int i) { limit(line, i); });
    if (instalments_.phase() == 1) finish_limits(line);
  }
  if (instalments_.phase() == 1) {
    instalments_.loop(last, 4, work, [&](int turn) { accelerate(line, turn); });
  }
  if (instalments_.phase() == 2) {
    instalments_.loop(last, 4, work, [&](int turn) { brake(line, turn); });
  }
  if (instalments_.phase() < 3) return false;
  if (line.is_closed()) {
    line.samples()[static_cast<std::size_t>(last)].speed = line.samples()[0].speed;
    line.samples()[static_cast<std::size_t>(last)].limiter = line.samples()[0].limiter;
  }
  return true;
}

void SpeedPlan::limit(ReferenceLine& line, int i) noexcept {
  const auto samples = line.samples();
  const int last = static_cast<int>(samples.size()) - 1;
  const int reach = std::max(1, static_cast<int>(std::lround(kSlopeReach / line.spacing())));
  const auto curvature = [&](int at) {
    if (line.is_closed()) at = at < 0 ? at + last : (at > last ? at - last : at);
    return samples[static_cast<std::size_t>(std::clamp(at, 0, last))].curve.curvature;
  };
  const auto index = static_cast<std::size_t>(i);
  const double slope = (curvature(i + reach) - curvature(i - reach)) / (2.0 * reach * line.spacing());
  demand_[index] = demand_of(curvature(i), slope, vehicle_);
  ReferenceLine::Sample& sample = samples[index];
  sample.speed = std::min(options_.speed_limit, vehicle_.valid_speed);
  sample.limiter = SpeedLimiter::kAsked;
  limit_to(speed_for(demand_[index], vehicle_, options_.grip_share), SpeedLimiter::kCurvature, sample);
  sample.speed = std::max(sample.speed, kLowestSpeed);
  if (i == 0 || sample.speed < samples[static_cast<std::size_t>(slowest_)].speed) slowest_ = i;
}

void SpeedPlan::finish_limits(ReferenceLine& line) noexcept {
  if (line.is_closed()) return;
  slowest_ = 0;
  const double end =
      speed_for((1.0 - vehicle_.steer_helper) * options_.end_curvature, vehicle_, options_.grip_share);
  limit_to(std::max(end, kLowestSpeed), SpeedLimiter::kSight, line.samples().back());
}

/// Once round a closed line from its slowest place, whose speed nothing lowers any more; an open one from its
/// beginning.
void SpeedPlan::accelerate(ReferenceLine& line, int turn) noexcept {
  const int laps = static_cast<int>(line.samples().size()) - 1;
  const int at = (slowest_ + turn) % laps;
  const auto from = static_cast<std::size_t>(at);
  const std::size_t to = line.is_closed() && at + 1 == laps ? 0 : from + 1;
  const double v = line.samples()[from].speed;
  const double share = longitudinal_share(use_of(v, demand_[from], vehicle_, options_.grip_share), vehicle_);
  const double drag = longitudinal_acceleration(vehicle_, 0.0, v);
  const double drive = std::min(longitudinal_acceleration(vehicle_, 1.0, v) - drag, traction(v, vehicle_));
  const double a = options_.drive_share * share * drive + drag;
  const double squared = std::max(kLowestSpeed * kLowestSpeed, v * v + 2.0 * a * line.spacing());
  limit_to(std::sqrt(squared), SpeedLimiter::kPower, line.samples()[to]);
}

/// The same the other way round; an open line from its end.
void SpeedPlan::brake(ReferenceLine& line, int turn) noexcept {
  const int laps = static_cast<int>(line.samples().size()) - 1;
  const int at = line.is_closed() ? (slowest_ + laps - turn) % laps : laps - turn;
  const auto from = static_cast<std::size_t>(at);
  const std::size_t to = at == 0 ? static_cast<std::size_t>(laps - 1) : from - 1;
  const ReferenceLine::Sample& ahead = line.samples()[from];
  const double v = ahead.speed;
  const double use = use_of(v, demand_[from], vehicle_, options_.grip_share);
  const double share = longitudinal_share(use, vehicle_);
  const double drag = longitudinal_acceleration(vehicle_, 0.0, v);
  const double force = std::min(drag - longitudinal_acceleration(vehicle_, -vehicle_.brake_throttle_limit, v),
                                traction(v, vehicle_));
  const double a =
      std::min(options_.brake_share * share * force, stability_.most_braking(v, options_.grip_share * use)) -
      drag;
  // Braking for the end of sight is for want of sight.
  const bool is_blind = ahead.limiter == SpeedLimiter::kSight;
  limit_to(std::sqrt(v * v + 2.0 * a * line.spacing()),
           is_blind ? SpeedLimiter::kSight : SpeedLimiter::kBraking, line.samples()[to]);
}

}  // namespace chicane::road
