// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/base/angle.hpp"
#include "chicane/lap_time/detail/plant_model.hpp"
#include "chicane/sim/udacity_car.hpp"

namespace chicane::lap_time {

/// The plant `udacity` (sim/udacity_car.hpp) in continuous time, its wheels in balance (docs/limit.md,
/// section 1). Variables: offset, heading, vx, vy, yaw rate, steering angle, tyre force along over mass;
/// changes of the last two by time.
struct UdacityModel {
  static constexpr int kVariables = 9;
  static constexpr int kStates = 7;
  static constexpr int kEquations = 0;
  static constexpr int kInequalities = 12;
  /// Of the feedback along a plan: so many of the states, then two inputs from this variable on.
  static constexpr int kDriven = 5, kInput = 5;
  static constexpr std::array<double, kVariables> scale() {
    return {2.0, 0.2, 20.0, 2.0, 1.0, 0.1, 5.0, 1.0, 50.0};
  }

  sim::UdacityCarParams car{};
  const RoadNodes* road = nullptr;
  double margin = 0.0;         ///< kept from the edges [m]
  double slip_share = kNoCap;  ///< most slip of the front tyres over that of their peak
  static constexpr double kNoCap = 10.0;
  double brake_share = 1.0;  ///< of the force at which the rear wheels lock
  double steer_weight = 1e-5, pedal_weight = 1e-5;

  /// By how much the helper is late on average as the tyres see it, over the parts of a step [s].
  static constexpr double kHelperLag = 0.375 * sim::UdacityCar::kStepLength;

  template <class T>
  struct Motion {
    T vx, vy, yaw;  ///< their changes by time
  };

  template <class T>
  [[nodiscard]] T load(const T& speed) const {  ///< of all tyres over mass [m/s²]
    const double rest = (car.mass + 4.0 * car.wheel_mass) * car.gravity;
    const double slope = (3.0 - car.load_filter_offset) / 3.0;
    const double per_mass = car.friction_scale / car.mass;
    return per_mass * (rest * (car.load_filter_offset + slope) + slope * car.downforce * speed);
  }
  [[nodiscard]] double rear_share() const { return car.front_axle / (car.front_axle + car.rear_axle); }
  /// Share of the force along that the front wheels give: all wheels have the same torque.
  [[nodiscard]] double front_pull() const {
    return (1.0 / car.front_radius) / (1.0 / car.front_radius + 1.0 / car.rear_radius);
  }

  template <class T>
  [[nodiscard]] Motion<T> motion(const T& vx, const T& vy, const T& r, const T& steer, const T& pull,
                                 const T& left_out = T(0.0)) const {
    const T cs = cos(steer);
    const T sn = sin(steer);
    const T all = load(T(sqrt(vx * vx + vy * vy)));
    const double wheelbase = car.front_axle + car.rear_axle;
    const T front_load = (0.5 * car.rear_axle / wheelbase) * all;
    const T rear_load = (0.5 * car.front_axle / wheelbase) * all;
    const T front_pull_each = (0.5 * front_pull()) * pull;
    const T rear_pull_each = (0.5 - 0.5 * front_pull()) * pull;
    T fx(0.0);
    T fy(0.0);
    T moment(0.0);
    const T vy_front = vy + car.front_axle * r;
    const T vy_rear = vy - car.rear_axle * r;
    for (const double y : {car.half_track, -car.half_track}) {
      const T vx_here = vx - y * r;
      const T along = cs * vx_here + sn * vy_front;
      const T across = cs * vy_front - sn * vx_here;
      const T side = -front_load * car.sideways(T(atan(across / (along + car.lateral_speed_offset))));
      const T x = cs * front_pull_each - sn * side;
      const T z = sn * front_pull_each + cs * side;
      const T rear_side = -rear_load * car.sideways(T(atan(vy_rear / (vx_here + car.lateral_speed_offset))));
      fx += x + rear_pull_each;
      fy += z + rear_side;
      moment += car.front_axle * z - car.rear_axle * rear_side - y * (x + rear_pull_each);
    }
    // The plant's parts of a step add half the square of what a force changes in them to the energy.
    const T gain = (0.5 * sim::UdacityCar::kStepLength / sim::UdacityCar::kParts) * (fx * fx + fy * fy) /
                   (vx * vx + vy * vy);
    const T stay = 1.0 - car.steer_helper * (1.0 - left_out);
    const T turn = (car.mass / car.yaw_inertia) * moment - car.angular_drag * r;
    // The helper follows the body by a part of a step, so the velocity lags behind a body that begins to
    // turn.
    const T behind = (kHelperLag * car.steer_helper) * turn;
    return {fx + stay * r * vy + (gain - car.linear_drag) * vx + behind * vy,
            fy - stay * r * vx + (gain - car.linear_drag) * vy - behind * vx, turn};
  }

  /// Share of the helper that is left out: all of it for one step when the body's heading passes +y, where
  /// the yaw angle of the original's engine wraps; here spread over some tenths of a radian.
  template <class T>
  [[nodiscard]] T skipped(double line, const T& heading, const T& r) const {
    constexpr double kWidth = 0.12;      // [rad]
    constexpr double kLeastRate = 0.05;  // [rad/s]
    const T x =
        (1.0 / kWidth) * (wrap_angle(line + value_of(heading) - 0.5 * kPi) - value_of(heading) + heading);
    const T bell = 1.0 / (1.0 + x * x);
    return (sim::UdacityCar::kStepLength * 2.0 / (kPi * kWidth)) * sqrt(r * r + kLeastRate * kLeastRate) *
           bell * bell;
  }

  template <class T>
  void functions(std::size_t k, const T* z, T* out) const {
    const RoadNodes& at = *road;
    const T& n = z[kOffset];
    const T& r = z[kYawRate];
    const T& pull = z[kPedal];
    const OnRoad<T> on(at.curvature[k], n, z[kHeading], z[kVx], z[kVy]);
    const T left_out = skipped(at.heading[k], z[kHeading], r);
    const Motion<T> m = motion(z[kVx], z[kVy], r, z[kSteer], pull, left_out);
    *out++ = (on.s * z[kVx] + on.c * z[kVy]) * on.slowness;
    *out++ = r * on.slowness;  // the line's own turn is in the intervals
    *out++ = m.vx * on.slowness;
    *out++ = m.vy * on.slowness;
    *out++ = m.yaw * on.slowness;
    *out++ = z[7] * on.slowness;
    *out++ = z[8] * on.slowness;
    *out++ = (1.0 + steer_weight * (z[7] * z[7]) + (1e-4 * pedal_weight) * (z[8] * z[8])) * on.slowness;
    const double w = car.half_track + car.half_tire;
    *out++ = at.front_left[k] - margin - on.offset_of(n, car.front_axle, w, at.front_bend[k]);
    *out++ = at.front_right[k] - margin + on.offset_of(n, car.front_axle, -w, at.front_bend[k]);
    *out++ = at.rear_left[k] - margin - on.offset_of(n, -car.rear_axle, w, at.rear_bend[k]);
    *out++ = at.rear_right[k] - margin + on.offset_of(n, -car.rear_axle, -w, at.rear_bend[k]);
    *out++ = (1.0 / car.steer_limit) * z[kSteer] + 1.0;
    *out++ = 1.0 - (1.0 / car.steer_limit) * z[kSteer];
    *out++ = 0.2 * (drive() - damping() * z[kVx] - pull - turning_mass() * m.vx);
    *out++ = 0.1 * pull + (0.1 * brake_share * rear_share() / (1.0 - front_pull())) * load(z[kVx]);
    const T slip = (1.0 / (slip_share * car.sideways.extremum_slip)) *
                   (atan((z[kVy] + car.front_axle * r) / (z[kVx] + car.lateral_speed_offset)) - z[kSteer]);
    *out++ = 1.0 - slip;
    *out++ = 1.0 + slip;
    *out++ = 0.1 * (z[kVx] - 2.5);
    *out++ = 0.1 * (car.speed_cap - z[kVx]);
  }

  /// Acceleration of the wheels' torques at full pedal, less what slip takes [m/s²]; what damping takes of it
  /// by speed [1/s]; mass of the turning wheels over that of the body (docs/limit.md, eq. 3).
  [[nodiscard]] double drive() const {
    constexpr double kSlipLoss = 0.0055;  // measured: 5.43 m/s² at rest, by mean speeds
    const double per_radius = 1.0 / car.front_radius + 1.0 / car.rear_radius;
    return (1.0 - kSlipLoss) * 0.5 * car.drive_torque * per_radius / car.mass;
  }
  [[nodiscard]] double damping() const {
    constexpr double kRimsFaster = 1.05;
    return kRimsFaster * 2.0 * car.wheel_damping *
           (1.0 / (car.front_radius * car.front_radius) + 1.0 / (car.rear_radius * car.rear_radius)) /
           car.mass;
  }
  [[nodiscard]] double turning_mass() const { return 2.0 * car.wheel_mass / car.mass; }
  /// The pedal that gives a tyre force over mass while vx changes by `change`.
  [[nodiscard]] double pedal_for(double pull, double vx, double change) const {
    const double torque = pull + damping() * vx + turning_mass() * change;
    return torque >= 0.0 ? torque / drive() : torque / (4.0 * car.brake_torque / car.drive_torque * drive());
  }
};

}  // namespace chicane::lap_time
