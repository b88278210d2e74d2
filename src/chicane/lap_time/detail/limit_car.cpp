// SPDX-License-Identifier: MIT
#include "chicane/lap_time/detail/limit_car.hpp"

#include <algorithm>

#include "chicane/base/math.hpp"

namespace chicane::lap_time {
namespace {

constexpr double kGravity = 9.81;        // [m/s²]
constexpr double kMostPower = 1e4;       // [W/kg]; stands for none
constexpr double kMostSteerRate = 10.0;  // [rad/s]; stands for at once

/// What an inner wheel loses of its load at rest for each m/s² of lateral acceleration.
double unloading(const model::VehicleParams& p, double other_axle, double share) {
  return 2.0 * p.height * share / p.track_width / (p.load_constant * other_axle / p.wheelbase());
}

}  // namespace

LimitCar::LimitCar(const model::VehicleParams& p) noexcept
    : front_axle{p.front_axle},
      rear_axle{p.rear_axle},
      half_width{0.5 * (p.track_width + p.tire_width)},
      stay{1.0 - p.steer_helper},
      front_turn{p.yaw_inertia / (p.mass * p.rear_axle)},
      rear_turn{p.yaw_inertia / (p.mass * p.front_axle)},
      grip_0{p.cornering_friction() * p.load_constant},
      grip_v{p.cornering_friction() * p.load_per_speed},
      grip_vv{p.cornering_friction() * p.load_quadratic},
      brake_front{p.brake_share_front},
      drive_front{p.drive_share_front},
      front_part{p.wheelbase() / p.rear_axle},
      rear_part{p.wheelbase() / p.front_axle},
      front_roll{unloading(p, p.rear_axle, p.roll_share_front)},
      rear_roll{unloading(p, p.front_axle, 1.0 - p.roll_share_front)},
      sensitivity{p.load_sensitivity},
      coupling{p.friction_coupling},
      front_shift{p.height / (kGravity * p.rear_axle)},
      rear_shift{p.height / (kGravity * p.front_axle)},
      drive{p.drive_acceleration},
      power{std::min(p.drive_power_per_mass, kMostPower)},
      brake{p.brake_acceleration},
      drag_0{p.drag_constant},
      drag_v{p.drag_linear},
      drag_vv{p.drag_quadratic},
      slip_drag{stay * stay * (p.rear_axle / p.cornering_front + p.front_axle / p.cornering_rear) /
                p.wheelbase()},
      slip_heading{stay / p.cornering_rear},
      load_0{p.load_constant},
      load_v{p.load_per_speed},
      load_vv{p.load_quadratic},
      curvature_limit{tan(p.steer_limit) / p.wheelbase()},
      curvature_rate{std::min(p.steer_rate_limit, kMostSteerRate) / p.wheelbase()} {}

}  // namespace chicane::lap_time
