// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/base/angle.hpp"
#include "chicane/lap_time/detail/plant_model.hpp"
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
  double steer_price = 1e-5, pedal_price = 1e-5;

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
    const T cs = cos(z[kSteer]);
    const T sn = sin(z[kSteer]);
    const double wheelbase = car.wheelbase();
    const double along_share = 0.5 * car.mass * car.height / wheelbase;
    const double across_share = car.mass * car.height / (2.0 * car.half_track());
    const T drive = (0.5 * car.drive_force) * smooth_positive(z[kPedal], kPedalCorner);
    const T brake = (0.5 * car.brake_force) * smooth_positive(T(-z[kPedal]), kPedalCorner);
    const T spin = (car.wheel_inertia / (car.wheel_radius * car.wheel_radius)) * (z[kShiftX] + r * vy);
    T fx(0.0);
    T fy(0.0);
    T moment(0.0);
    Motion<T> m;
    for (std::size_t i = 0; i < 4; ++i) {
      const bool is_front = i < 2;
      const double x = is_front ? car.front_axle : -car.rear_axle;
      const double y = i % 2 == 0 ? car.half_track() : -car.half_track();
      const double rest = 0.5 * car.mass * sim::DoubleTrackParams::kGravity *
                          (is_front ? car.rear_axle : car.front_axle) / wheelbase;
      const double roll = is_front ? car.roll_share_front : 1.0 - car.roll_share_front;
      const T load = smooth_positive(T(rest + (is_front ? -along_share : along_share) * z[kShiftX] +
                                       (i % 2 == 0 ? -roll : roll) * across_share * z[kShiftY]),
                                     kLoadCorner);
      const T vx_here = vx - y * r;
      const T vy_here = vy + x * r;
      const T along = is_front ? T(cs * vx_here + sn * vy_here) : vx_here;
      const T across = is_front ? T(cs * vy_here - sn * vx_here) : vy_here;
      const T& slip = z[kSlip + i];
      const T side = -across / along;
      m.slip[i] = slip * slip + side * side;
      const T size = sqrt(m.slip[i] + kLeastSlip * kLeastSlip);
      const double stiffness = is_front ? car.stiffness_front : car.stiffness_rear;
      const T force = (grip_share * car.friction) * load *
                      (1.0 + car.load_sensitivity - (car.load_sensitivity / rest) * load) *
                      sin(car.shape * atan(stiffness * size)) / size;
      const T f_along = force * slip;
      const T f_across = force * side;
      const double drive_share = is_front ? car.drive_share_front : 1.0 - car.drive_share_front;
      const double brake_share = is_front ? car.brake_share_front : 1.0 - car.brake_share_front;
      m.balance[i] = (1.0 / rest) * (f_along - drive_share * drive * spin_share(slip) +
                                     brake_share * brake * lock_share(slip) + car.rolling_resistance * load +
                                     0.5 * drive_share * car.drive_friction + spin);
      const T bx = is_front ? T(cs * f_along - sn * f_across) : f_along;
      const T by = is_front ? T(sn * f_along + cs * f_across) : f_across;
      fx += bx;
      fy += by;
      moment += x * by - y * bx;
    }
    const T speed = sqrt(vx * vx + vy * vy);
    m.ax = (1.0 / car.mass) * (fx - car.drag * speed * vx);
    m.ay = (1.0 / car.mass) * (fy - car.drag * speed * vy);
    m.yaw = (1.0 / car.yaw_inertia) * moment;
    return m;
  }

  /// What anti-lock leaves of the brake: 1 falling to 0 between two slips.
  template <class T>
  [[nodiscard]] T lock_share(const T& slip) const {
    const double span = car.abs_slip_end - car.abs_slip_start;
    const T left = (1.0 / span) * (slip + car.abs_slip_end);
    return smooth_positive(left, kLockCorner) - smooth_positive(T(left - 1.0), kLockCorner);
  }

  /// And traction control of the drive.
  template <class T>
  [[nodiscard]] T spin_share(const T& slip) const {
    if (!car.has_traction_control()) return T(1.0);
    const double span = car.traction_slip_end - car.traction_slip_start;
    const T left = (1.0 / span) * (car.traction_slip_end - slip);
    return smooth_positive(left, kLockCorner) - smooth_positive(T(left - 1.0), kLockCorner);
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
    *out++ = (1.0 + steer_price * (z[kSteerRate] * z[kSteerRate]) +
              (0.01 * pedal_price) * (z[kPedalRate] * z[kPedalRate])) *
             on.slowness;
    const double w = car.half_track() + car.half_tire();
    *out++ = at.front_left[k] - margin - on.offset_of(n, car.front_axle, w, at.front_bend[k]);
    *out++ = at.front_right[k] - margin + on.offset_of(n, car.front_axle, -w, at.front_bend[k]);
    *out++ = at.rear_left[k] - margin - on.offset_of(n, -car.rear_axle, w, at.rear_bend[k]);
    *out++ = at.rear_right[k] - margin + on.offset_of(n, -car.rear_axle, -w, at.rear_bend[k]);
    const T steer_asked = (1.0 / car.steer_limit) * (steer + car.steer_lag * z[kSteerRate]);
    *out++ = 1.0 - steer_asked;
    *out++ = 1.0 + steer_asked;
    *out++ = 1.0 - (1.0 / car.steer_rate_limit) * z[kSteerRate];
    *out++ = 1.0 + (1.0 / car.steer_rate_limit) * z[kSteerRate];
    const T pedal_asked = pedal + car.drive_lag * z[kPedalRate];
    *out++ = 1.0 - pedal_asked;
    *out++ = 1.0 + pedal_asked;
    *out++ = 1.0 - (car.drive_force / car.drive_power) * (pedal * z[kVx]);
    *out++ = 0.1 * (z[kVx] - 2.5);
    *out++ = 1.0 - (1.0 / 100.0) * z[kVx];
    for (std::size_t i = 0; i < 4; ++i) {
      const double most = slip_share * peak_slip(i < 2);
      *out++ = 1.0 - (1.0 / (most * most)) * m.slip[i];
    }
  }

  [[nodiscard]] double peak_slip(bool is_front) const {
    return chicane::tan(kPi / (2.0 * car.shape)) / (is_front ? car.stiffness_front : car.stiffness_rear);
  }
  static constexpr double kNoCap = 10.0;

 private:
  static constexpr double kPedalCorner = 0.01;
  static constexpr double kLoadCorner = 50.0;  ///< [N]
  static constexpr double kLeastSlip = 1e-3;
  static constexpr double kLockCorner = 0.02;
};

}  // namespace chicane::lap_time
