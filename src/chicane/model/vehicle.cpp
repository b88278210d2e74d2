// SPDX-License-Identifier: MIT
#include "chicane/model/vehicle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace chicane::model {

namespace {

enum class Sign { kPositive, kNotNegative };

struct Field {
  const char* name;
  double value;
  Sign sign;
  bool may_be_infinite = false;
};

Result<void> check(const Field& field) {
  const bool is_number = !std::isnan(field.value) && (field.may_be_infinite || std::isfinite(field.value));
  const bool is_in_range = field.sign == Sign::kPositive ? field.value > 0.0 : field.value >= 0.0;
  if (is_number && is_in_range) return {};
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), "vehicle.%s: got %g, expected %s%s", field.name, field.value,
                field.may_be_infinite ? "" : "a finite number ",
                field.sign == Sign::kPositive ? "> 0" : ">= 0");
  return fail(ErrorCode::kInvalidArgument, text.data());
}

/// Deceleration by drag [m/s²]; has the sign of v.
double drag(const VehicleParams& p, double v) noexcept {
  const double direction = v > 0.0 ? 1.0 : (v < 0.0 ? -1.0 : 0.0);
  return direction * p.drag_constant + p.drag_linear * v + p.drag_quadratic * v * std::fabs(v);
}

/// Largest acceleration by the engine [m/s²].
double drive_limit(const VehicleParams& p, double v) noexcept {
  const double by_power = v > 0.0 ? p.drive_power_per_mass / v : std::numeric_limits<double>::infinity();
  return std::min(p.drive_acceleration, by_power);
}

}  // namespace

Result<void> validate(const VehicleParams& p) {
  const std::array fields{
      Field{"front_axle", p.front_axle, Sign::kPositive},
      Field{"rear_axle", p.rear_axle, Sign::kPositive},
      Field{"track_width", p.track_width, Sign::kPositive},
      Field{"tire_width", p.tire_width, Sign::kNotNegative},
      Field{"length", p.length, Sign::kPositive},
      Field{"width", p.width, Sign::kPositive},
      Field{"kinematic_length", p.kinematic_length, Sign::kPositive},
      Field{"mass", p.mass, Sign::kPositive},
      Field{"yaw_inertia", p.yaw_inertia, Sign::kPositive},
      Field{"height", p.height, Sign::kNotNegative},
      Field{"steer_limit", p.steer_limit, Sign::kPositive},
      Field{"steer_rate_limit", p.steer_rate_limit, Sign::kPositive, true},
      Field{"steer_lag", p.steer_lag, Sign::kNotNegative},
      Field{"cornering_front", p.cornering_front, Sign::kPositive},
      Field{"cornering_rear", p.cornering_rear, Sign::kPositive},
      Field{"friction", p.friction, Sign::kPositive},
      Field{"friction_coupling", p.friction_coupling, Sign::kNotNegative},
      Field{"load_constant", p.load_constant, Sign::kPositive},
      Field{"load_per_speed", p.load_per_speed, Sign::kNotNegative},
      Field{"steer_helper", p.steer_helper, Sign::kNotNegative},
      Field{"drive_acceleration", p.drive_acceleration, Sign::kPositive},
      Field{"drive_power_per_mass", p.drive_power_per_mass, Sign::kPositive, true},
      Field{"drag_constant", p.drag_constant, Sign::kNotNegative},
      Field{"drag_linear", p.drag_linear, Sign::kNotNegative},
      Field{"drag_quadratic", p.drag_quadratic, Sign::kNotNegative},
      Field{"brake_acceleration", p.brake_acceleration, Sign::kPositive},
      Field{"brake_throttle_limit", p.brake_throttle_limit, Sign::kPositive},
      Field{"drive_lag", p.drive_lag, Sign::kNotNegative},
  };
  for (const Field& field : fields) {
    if (Result<void> result = check(field); !result) return result;
  }
  if (p.steer_limit >= 1.5)
    return fail(ErrorCode::kInvalidArgument, "vehicle.steer_limit: expected < 1.5 rad");
  if (p.steer_helper >= 1.0) return fail(ErrorCode::kInvalidArgument, "vehicle.steer_helper: expected < 1");
  if (p.brake_throttle_limit > 1.0) {
    return fail(ErrorCode::kInvalidArgument, "vehicle.brake_throttle_limit: expected <= 1");
  }
  if (p.friction_coupling > 1.0) {
    return fail(ErrorCode::kInvalidArgument, "vehicle.friction_coupling: expected <= 1");
  }
  return {};
}

double longitudinal_acceleration(const VehicleParams& p, double throttle, double v) noexcept {
  const double pedal = std::clamp(throttle, -1.0, 1.0);
  const double force =
      pedal >= 0.0 ? std::min(p.drive_acceleration * pedal, drive_limit(p, v)) : p.brake_acceleration * pedal;
  return force - drag(p, v);
}

double throttle_for(const VehicleParams& p, double acceleration, double v) noexcept {
  const double force = acceleration + drag(p, v);
  if (std::isnan(force)) return 0.0;
  if (force < 0.0) return std::max(force / p.brake_acceleration, -p.brake_throttle_limit);
  return std::min(force / p.drive_acceleration, 1.0);
}

VehicleParams udacity_params() { return {}; }

VehicleParams road_car_params() {
  VehicleParams p;
  p.name = "road-car";
  p.front_axle = 1.25;
  p.rear_axle = 1.45;
  p.track_width = 1.60;
  p.tire_width = 0.205;
  p.length = 4.30;
  p.width = 1.80;
  p.kinematic_length = 2.70;
  p.mass = 1300.0;
  p.yaw_inertia = 2000.0;
  p.height = 0.5;
  p.steer_rate_limit = 1.5707963267948966;
  p.steer_lag = 0.05;
  p.cornering_front = 16.0;
  p.cornering_rear = 18.0;
  p.friction = 1.07;
  p.friction_coupling = 1.0;
  p.load_constant = 9.81;
  p.load_per_speed = 0.0;
  p.steer_helper = 0.0;
  p.drive_acceleration = 5.35;
  p.drive_power_per_mass = 148.0;
  p.drag_constant = 0.123;
  p.drag_linear = 0.0;
  p.drag_quadratic = 2.9e-4;
  p.brake_acceleration = 9.14;
  p.brake_throttle_limit = 1.0;
  p.drive_lag = 0.1;
  return p;
}

}  // namespace chicane::model
