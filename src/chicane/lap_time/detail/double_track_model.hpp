// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/lap_time/detail/plant_model.hpp"
#include "chicane/model/wheel_forces.hpp"
#include "chicane/sim/double_track.hpp"

namespace chicane::lap_time {

/// The plants `double-track` and `road-car` (sim/double_track.hpp) with tyres that have settled to their
/// slip, its wheels in balance (docs/limit.md, section 1). Variables: offset, heading, vx, vy, yaw rate,
/// steering angle, pedal after its lag, the lagged accelerations that shift load; changes of steering and
/// pedal by time; the forward slip of each wheel, which the balance of its torques decides.
struct DoubleTrackModel {
  static constexpr int kVariables = 15;
  static constexpr int kStates = 9;
  static constexpr int kEquations = 4;
  static constexpr int kInequalities = 17;
  static constexpr int kShiftX = 7, kShiftY = 8, kSteerRate = 9, kPedalRate = 10, kSlip = 11;
  /// Of the feedback along a plan: so many of the states, then two inputs from this variable on.
  static constexpr int kDriven = 9, kInput = 9;
  static constexpr std::array<double, kVariables> scale() {
    return {2.0, 0.2, 20.0, 2.0, 1.0, 0.1, 1.0, 10.0, 10.0, 1.0, 10.0, 0.1, 0.1, 0.1, 0.1};
  }

  sim::DoubleTrackParams car{};
  const RoadNodes* road = nullptr;
  double margin = 0.0;  ///< kept from the edges [m]
  double grip_share = 1.0;
  double slip_share = kNoCap;  ///< most combined slip over that of the peak force
  double steer_weight = 1e-5, pedal_weight = 1e-5;

  template <class T>
  struct Motion {
    T ax, ay, yaw;             ///< acceleration in the body's axes, and of the yaw
    std::array<T, 4> balance;  ///< of the wheels' torques over rest load and radius
    std::array<T, 4> slip;     ///< combined, squared
  };

  template <class T>
  [[nodiscard]] Motion<T> motion(const T* z) const {
    const T& vx = z[kVx];
    const T& vy = z[kVy];
    const T& r = z[kYawRate];
    const T cosine = cos(z[kSteer]);
    const T sine = sin(z[kSteer]);
    const T square = vx * vx + vy * vy;
    // Without downforce: plans that count on it leave the road when they are driven.
    const auto shift = car.load_shift(z[kShiftX], z[kShiftY], T(0.0));
    const T drive = (0.5 * car.drive_force) * Corners::positive(z[kPedal], kPedalCorner);
    const T brake = (0.5 * car.brake_force) * Corners::positive(T(-z[kPedal]), kPedalCorner);
    const T spin = (car.wheel_inertia / (car.wheel_radius * car.wheel_radius)) * (z[kShiftX] + r * vy);
    const T air = -car.drag * sqrt(square);
    Motion<T> m;
    const auto force_of = [&](std::size_t i, const model::Axle& axle, const model::Planar<T>& v) {
      const double rest = car.static_load(i < 2);
      const T load = Corners::positive(car.wheel_load(i, rest, shift), kLoadCorner);
      const model::Planar<T> rolling = i < 2 ? model::in_turned_axes(v, cosine, sine) : v;
      const T& slip = z[kSlip + i];
      const T side = -rolling.y / rolling.x;
      m.slip[i] = slip * slip + side * side;
      const T size = sqrt(m.slip[i] + kLeastSlip * kLeastSlip);
      const T force = grip_share * (load * car.grip(load, rest)) * car.tire(i < 2)(size) / size;
      const model::Planar<T> tire{force * slip, force * side};
      m.balance[i] =
          (1.0 / rest) * (tire.x - axle.drive_share * driven(drive, slip) +
                          axle.brake_share * brake *
                              model::torque_share<Corners>(T(-slip), car.abs_slip_start, car.abs_slip_end) +
                          car.rolling_resistance * load + 0.5 * axle.drive_share * car.drive_friction + spin);
      return tire;
    };
    const auto sum = model::wheel_forces<T>(car.axles(), {vx, vy}, r, cosine, sine,
                                            {air * vx, air * vy, T(0.0)}, force_of);
    m.ax = (1.0 / car.mass) * sum.x;
    m.ay = (1.0 / car.mass) * sum.y;
    m.yaw = (1.0 / car.yaw_inertia) * sum.moment;
    return m;
  }

  /// What traction control leaves of the drive.
  template <class T>
  [[nodiscard]] T driven(const T& drive, const T& slip) const {
    if (!car.has_traction_control()) return drive;
    return drive * model::torque_share<Corners>(slip, car.traction_slip_start, car.traction_slip_end);
  }

  template <class T>
  void functions(std::size_t k, const T* z, T* out) const {
    const RoadNodes& at = *road;
    const T& n = z[kOffset];
    const T& r = z[kYawRate];
    const T& steer = z[kSteer];
    const T& pedal = z[kPedal];
    const OnRoad<T> on(at.curvature[k], n, z[kHeading], z[kVx], z[kVy]);
    const Motion<T> m = motion(z);
    *out++ = (on.s * z[kVx] + on.c * z[kVy]) * on.slowness;
    *out++ = r * on.slowness;  // the line's own turn is in the intervals
    *out++ = (m.ax + r * z[kVy]) * on.slowness;
    *out++ = (m.ay - r * z[kVx]) * on.slowness;
    *out++ = m.yaw * on.slowness;
    *out++ = z[kSteerRate] * on.slowness;
    *out++ = z[kPedalRate] * on.slowness;
    *out++ = (1.0 / car.load_lag) * (m.ax - z[kShiftX]) * on.slowness;
    *out++ = (1.0 / car.load_lag) * (m.ay - z[kShiftY]) * on.slowness;
    for (const T& b : m.balance) *out++ = b;
    *out++ = (1.0 + steer_weight * (z[kSteerRate] * z[kSteerRate]) +
              (0.01 * pedal_weight) * (z[kPedalRate] * z[kPedalRate])) *
             on.slowness;
    const double w = car.half_track() + car.half_tire();
    *out++ = at.front_left[k] - margin - on.offset_of(n, car.front_axle, w, at.front_bend[k]);
    *out++ = at.front_right[k] - margin + on.offset_of(n, car.front_axle, -w, at.front_bend[k]);
    *out++ = at.rear_left[k] - margin - on.offset_of(n, -car.rear_axle, w, at.rear_bend[k]);
    *out++ = at.rear_right[k] - margin + on.offset_of(n, -car.rear_axle, -w, at.rear_bend[k]);
    const T steer_command = (1.0 / car.steer_limit) * (steer + car.steer_lag * z[kSteerRate]);
    *out++ = 1.0 - steer_command;
    *out++ = 1.0 + steer_command;
    *out++ = 1.0 - (1.0 / car.steer_rate_limit) * z[kSteerRate];
    *out++ = 1.0 + (1.0 / car.steer_rate_limit) * z[kSteerRate];
    const T pedal_command = pedal + car.drive_lag * z[kPedalRate];
    *out++ = 1.0 - pedal_command;
    *out++ = 1.0 + pedal_command;
    *out++ = 1.0 - (car.drive_force / car.drive_power) * (pedal * z[kVx]);
    *out++ = 0.1 * (z[kVx] - 2.5);
    *out++ = 1.0 - (1.0 / 100.0) * z[kVx];
    for (std::size_t i = 0; i < 4; ++i) {
      const double most = slip_share * car.tire(i < 2).peak_slip();
      *out++ = 1.0 - (1.0 / (most * most)) * m.slip[i];
    }
  }

  static constexpr double kNoCap = 10.0;

 private:
  using Corners = model::Rounded;
  static constexpr double kPedalCorner = 0.01;
  static constexpr double kLoadCorner = 50.0;  ///< [N]
  static constexpr double kLeastSlip = 1e-3;
};

}  // namespace chicane::lap_time
