// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/base/dual.hpp"
#include "chicane/base/math.hpp"
#include "chicane/model/vehicle.hpp"

namespace chicane::controller {

/// The part of a car's motion that does not depend on where it is.
template <class T>
struct BodyMotion {
  T vx{};            ///< [m/s]
  T vy{};            ///< [m/s]
  T r{};             ///< yaw rate [rad/s]
  T steer{};         ///< road-wheel angle [rad]
  T acceleration{};  ///< net longitudinal acceleration, drag included, cornering resistance not [m/s²]
};

/// The car a tracking controller believes in: a single track with saturating tyres, steering and drive lag,
/// and the share h by which some cars turn their velocity along with the body (docs/tracking.md, eq. 1–9).
///
///     v_y' = k_f α_f + k_r α_r − (1 − h) r v_x          α_f = δ − (v_y + a r)/v_x
///     r'   = (m / I)(a k_f α_f − b k_r α_r)             α_r =   − (v_y − b r)/v_x
///     v_x' = a_x + (1 − h) r v_y − k_f α_f δ
///
/// k are secant stiffnesses per mass, F/(m α), of a saturating tyre. One step is linearly implicit in (v_y,
/// r): tyres that are stiff at low speed cannot make it unstable, and v_x → 0 tends to the kinematic bicycle,
/// so one model serves every speed from standstill on.
///
/// T is double or a Dual. No allocation, no failure for finite input, any dt > 0. Error O(dt²) per step.
class PredictionModel {
 public:
  explicit PredictionModel(const model::VehicleParams& vehicle) noexcept : vehicle_{vehicle} {}
  void set_vehicle(const model::VehicleParams& vehicle) noexcept { vehicle_ = vehicle; }

  /// Motion after dt [s] with the given road-wheel angle and net acceleration asked for all along.
  template <class T>
  [[nodiscard]] BodyMotion<T> advance(const BodyMotion<T>& from, const T& steer_asked,
                                      const T& acceleration_asked, double dt) const noexcept {
    const model::VehicleParams& p = vehicle_;
    BodyMotion<T> to;
    const T steer = lag(from.steer, steer_asked, p.steer_lag, dt, to.steer);
    const T acceleration = lag(from.acceleration, acceleration_asked, p.drive_lag, dt, to.acceleration);

    const Tires<T> tires = tire_state(from, steer);
    const T& kf = tires.stiffness_front;
    const T& kr = tires.stiffness_rear;
    const T inverse_v = 1.0 / tires.speed;
    const double a = p.front_axle;
    const double b = p.rear_axle;
    const double mass_over_inertia = p.mass / p.yaw_inertia;

    // (1 − dt A)(v_y, r)⁺ = (v_y, r) + dt B δ
    const T sum = (kf + kr) * inverse_v;
    const T moment = (a * kf - b * kr) * inverse_v;
    const T damping = (a * a * kf + b * b * kr) * inverse_v;
    const T a11 = 1.0 + dt * sum;
    const T a12 = dt * (moment + (1.0 - p.steer_helper) * from.vx);
    const T a21 = (dt * mass_over_inertia) * moment;
    const T a22 = 1.0 + (dt * mass_over_inertia) * damping;
    const T b1 = from.vy + dt * kf * steer;
    const T b2 = from.r + (dt * mass_over_inertia * a) * kf * steer;
    const T det = a11 * a22 - a12 * a21;
    // A car about to spin has no implicit step for large dt: let it grow fivefold, not without bound.
    const T inverse_det = 1.0 / (value_of(det) > kLeastDeterminant ? det : T(kLeastDeterminant));
    to.vy = (b1 * a22 - a12 * b2) * inverse_det;
    to.r = (a11 * b2 - a21 * b1) * inverse_det;

    const T slip_front = steer - (to.vy + a * to.r) * inverse_v;
    to.vx = from.vx + dt * (acceleration + (1.0 - p.steer_helper) * to.r * to.vy - kf * slip_front * steer);
    return to;
  }

  /// Normalised lateral tyre use, front and rear: cornering · slip / friction. 1 is where the linear tyre
  /// would reach its peak; larger means sliding.
  template <class T>
  [[nodiscard]] std::array<T, 2> tire_use(const BodyMotion<T>& motion) const noexcept {
    const Tires<T> tires = tire_state(motion, motion.steer);
    return {tires.use_front, tires.use_rear};
  }

  /// Normal acceleration carried by the tyres at speed v [m/s²].
  [[nodiscard]] double load(double v) const noexcept {
    return vehicle_.load_constant + vehicle_.load_per_speed * v;
  }
  [[nodiscard]] const model::VehicleParams& vehicle() const noexcept { return vehicle_; }

 private:
  static constexpr double kGravity = 9.81;  ///< [m/s²]
  static constexpr double kLeastDeterminant = 0.2;
  static constexpr double kSpeedFloor =
      1.0;  ///< [m/s] slip angles are computed with at least about this speed

  template <class T>
  struct Tires {
    T speed, use_front, use_rear, stiffness_front, stiffness_rear;
  };

  /// First-order lag over dt: returns the mean over the step, `end` is the value at its end.
  template <class T>
  static T lag(const T& now, const T& asked, double time_constant, double dt, T& end) noexcept {
    if (time_constant <= 1e-4) {
      end = asked;
      return asked;
    }
    const double decay = exp(-dt / time_constant);
    end = asked + (now - asked) * decay;
    return asked + (now - asked) * ((1.0 - decay) * time_constant / dt);
  }

  template <class T>
  [[nodiscard]] Tires<T> tire_state(const BodyMotion<T>& m, const T& steer) const noexcept {
    const model::VehicleParams& p = vehicle_;
    const double per_wheelbase = 1.0 / p.wheelbase();
    Tires<T> t;
    t.speed = sqrt(m.vx * m.vx + kSpeedFloor * kSpeedFloor);
    const T load_now = p.load_constant + p.load_per_speed * t.speed;
    const T transfer = (p.height / kGravity) * m.acceleration;
    const T share_front = 1.0 - (1.0 / p.rear_axle) * transfer;  // of its load at rest
    const T share_rear = 1.0 + (1.0 / p.front_axle) * transfer;
    const T along = m.acceleration / (p.friction * load_now);
    const T peak = p.friction * sqrt(1.0 - p.friction_coupling * limited_square(along));
    t.use_front = p.cornering_front / (peak * share_front) * (steer - (m.vy + p.front_axle * m.r) / t.speed);
    t.use_rear = -p.cornering_rear / (peak * share_rear) * ((m.vy - p.rear_axle * m.r) / t.speed);
    // Load moves the peak, not the slope: cornering stiffness grows far less than in proportion to load.
    t.stiffness_front =
        (p.cornering_front * p.rear_axle * per_wheelbase) * load_now * saturation(t.use_front);
    t.stiffness_rear = (p.cornering_rear * p.front_axle * per_wheelbase) * load_now * saturation(t.use_rear);
    return t;
  }

  /// x², never above 0.8: even a locked car keeps some sideways force.
  template <class T>
  static T limited_square(const T& x) noexcept {
    const T square = x * x;
    return value_of(square) < 0.8 ? square : T(0.8);
  }

  /// Secant of the tyre curve over its initial slope: (1 + z⁴)^(−1/4); force tends to the peak, never falls.
  template <class T>
  static T saturation(const T& z) noexcept {
    const T z2 = z * z;
    return 1.0 / sqrt(sqrt(1.0 + z2 * z2));
  }

  model::VehicleParams vehicle_;
};

}  // namespace chicane::controller
