// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "chicane/model/vehicle.hpp"

namespace chicane::model {

/// How much the lateral forces of the axles grow with their slip angles, over the car's mass [m/s² per rad].
struct AxleSlopes {
  double front;
  double rear;
};

/// One over the static stability at speed v [m/s]: (1 − h) v² (a k_f − b k_r) over k_f k_r L². Above 1 the
/// car turns away from its path by itself; negative where it understeers, infinite where the rear axle
/// slides, −1 where only the front one does.
[[nodiscard]] inline double static_instability(const VehicleParams& car, double v,
                                               const AxleSlopes& k) noexcept {
  if (!(k.rear > 0.0)) return std::numeric_limits<double>::infinity();
  if (!(k.front > 0.0)) return -1.0;
  return (1.0 - car.steer_helper) * v * v * (car.front_axle * k.front - car.rear_axle * k.rear) /
         (k.front * k.rear * car.wheelbase() * car.wheelbase());
}

/// The right-most real part of the poles of yaw and sideslip [1/s] at speed v > 0 [m/s]; slopes of any sign.
[[nodiscard]] inline double yaw_pole(const VehicleParams& car, double v, const AxleSlopes& k) noexcept {
  const double a = car.front_axle, b = car.rear_axle, wheelbase = car.wheelbase();
  const double turn = car.mass / car.yaw_inertia;
  const double damping = 0.5 * (k.front + k.rear + turn * (a * a * k.front + b * b * k.rear)) / v;
  const double spring = turn * (k.front * k.rear * wheelbase * wheelbase / (v * v) -
                                (1.0 - car.steer_helper) * (a * k.front - b * k.rear));
  return std::sqrt(std::max(damping * damping - spring, 0.0)) - damping;
}

}  // namespace chicane::model
