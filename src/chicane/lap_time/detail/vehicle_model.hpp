// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "chicane/lap_time/detail/plan_model.hpp"
#include "chicane/model/braking_stability.hpp"
#include "chicane/model/helper_gap.hpp"
#include "chicane/model/prediction.hpp"
#include "chicane/model/sliding.hpp"

namespace chicane::lap_time {

/// The car as a controller models it (model/prediction.hpp) in continuous time (docs/racing.md,
/// section 1). Variables: offset, heading, vx, vy, yaw rate, steering angle, net acceleration; changes of the
/// last two by time.
struct VehicleModel {
  static constexpr int kVariables = 9;
  static constexpr int kStates = 7;
  static constexpr int kEquations = 0;
  static constexpr int kInequalities = 18;
  static constexpr std::array<double, kVariables> scale() {
    return {2.0, 0.2, 20.0, 2.0, 1.0, 0.1, 5.0, 1.0, 50.0};
  }

  model::PredictionModel model{model::VehicleParams{}};
  model::BrakingStability stability{model::VehicleParams{}};  ///< with all of the grip
  bool is_steered_slowly = false;                             ///< then the plan keeps to it
  model::SlidingBound sliding{model::VehicleParams{}};
  bool slides = false;  ///< the rear tyres slip as far as `sliding` permits
  const RoadNodes* road = nullptr;
  double margin = 0.0;         ///< kept from the edges [m]
  double slip_share = 1.0;     ///< most slip of an axle over that of its peak
  double brake_share = 1.0;    ///< of the largest useful deceleration
  double speed_limit = 100.0;  ///< [m/s]
  double steer_weight = 1e-3;  ///< of the steering's rate squared, in time [s/rad²·s]
  double jerk_weight = 1e-6;   ///< of the change of acceleration squared

  template <class T>
  [[nodiscard]] T drag(const T& v) const {
    const model::VehicleParams& car = model.vehicle();
    return car.drag_constant + car.drag_linear * v + car.drag_quadratic * (v * v);
  }

  template <class T>
  void functions(std::size_t k, const T* z, T* out) const {
    const RoadNodes& at = *road;
    const model::VehicleParams& car = model.vehicle();
    const T& n = z[kOffset];
    const T& vx = z[kVx];
    const T& steer = z[kSteer];
    const T& net = z[kPedal];
    const T& steer_rate = z[7];
    const T& jerk = z[8];
    const OnRoad<T> on(at.curvature[k], n, z[kHeading], vx, z[kVy]);
    const model::BodyMotion<T> body{vx, z[kVy], z[kYawRate], steer, net};
    auto change = model.change(body);
    if (slides && car.helper_gap > 0.0) {
      const T turn = car.steer_helper * model::helper_left_out(car, at.heading[k], z[kHeading], z[kYawRate]) *
                     z[kYawRate];
      change.vx = change.vx + turn * z[kVy];
      change.vy = change.vy - turn * vx;
    }
    *out++ = (on.s * vx + on.c * z[kVy]) * on.slowness;
    *out++ = z[kYawRate] * on.slowness;  // the line's own turn is in the intervals
    *out++ = change.vx * on.slowness;
    *out++ = change.vy * on.slowness;
    *out++ = change.r * on.slowness;
    *out++ = steer_rate * on.slowness;
    *out++ = jerk * on.slowness;
    *out++ = (1.0 + steer_weight * (steer_rate * steer_rate) + jerk_weight * (jerk * jerk)) * on.slowness;
    const double w = 0.5 * (car.track_width + car.tire_width);
    *out++ = at.front_left[k] - margin - on.offset_of(n, car.front_axle, w, at.front_bend[k]);
    *out++ = at.front_right[k] - margin + on.offset_of(n, car.front_axle, -w, at.front_bend[k]);
    *out++ = at.rear_left[k] - margin - on.offset_of(n, -car.rear_axle, w, at.rear_bend[k]);
    *out++ = at.rear_right[k] - margin + on.offset_of(n, -car.rear_axle, -w, at.rear_bend[k]);
    const T asked = (1.0 / car.steer_limit) * (steer + car.steer_lag * steer_rate);
    *out++ = 1.0 + asked;
    *out++ = 1.0 - asked;
    const double rate = std::min(car.steer_rate_limit, kMostSteerRate);
    *out++ = 1.0 + (1.0 / rate) * steer_rate;
    *out++ = 1.0 - (1.0 / rate) * steer_rate;
    const T force = net + car.drive_lag * jerk + drag(vx);
    *out++ = 0.2 * (car.drive_acceleration - force);
    *out++ = 0.2 * (std::min(car.drive_power_per_mass, kMostPower) / vx - force);
    *out++ = 0.1 * (force + brake_share * car.brake_throttle_limit * car.brake_acceleration);
    const T slip = slip_share * (1.0 - (is_steered_slowly ? kSlipPerSpeedSlow : kSlipPerSpeed) * vx);
    const T share = slides ? model::SlidingBound::share(vx) : T(0.0);
    const T front = slip + share * (slip_share * sliding.front() - slip);
    const T rear = slip + share * (slip_share * sliding.rear(vx) - slip);
    *out++ = front * front - change.square_front;
    *out++ = rear * rear - change.square_rear;
    *out++ = kMostAlong - change.along_front;
    *out++ = kMostAlong - change.along_rear;
    *out++ = stable_braking(T(net + drag(vx)), vx, z[kYawRate]);
    *out++ = 0.1 * (vx - kLeastSpeed);
    *out++ = 0.1 * (speed_limit - vx);
  }

  /// Not negative where the steering can still catch a car that brakes with this force over mass.
  template <class T>
  [[nodiscard]] T stable_braking(const T& force, const T& vx, const T& yaw_rate) const {
    if (!is_steered_slowly) return T(1.0);
    const T lateral = (1.0 - model.vehicle().steer_helper) * vx * yaw_rate;
    const T use = stability.use(T(sqrt(lateral * lateral + kLeastLateral * kLeastLateral)), vx);
    return 0.1 * (force + stability.smooth_most_braking(vx, use));
  }

  static constexpr double kLeastLateral = 0.1;    ///< [m/s²]
  static constexpr double kMostSteerRate = 10.0;  ///< [rad/s]; stands for at once
  static constexpr double kMostPower = 1e4;       ///< [W/kg]; stands for none
  static constexpr double kMostAlong = 0.95;      ///< of a tyre's force: the rest keeps the car on its course
  static constexpr double kLeastSpeed = 2.5;      ///< [m/s]
  /// Of slip_share [s/m]: the faster a car, the less its yaw motion is damped, and the further it goes before
  /// a command acts. Three quarters are left at 50 m/s.
  static constexpr double kSlipPerSpeed = 0.005;
  /// Share for cars with slow steering: with 0.005 `vw-vanagon` and `tum-1200` spin in bends of 35 to 45 m/s.
  static constexpr double kSlipPerSpeedSlow = 0.01;
};

}  // namespace chicane::lap_time
