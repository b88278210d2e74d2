// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include "chicane/base/inlining.hpp"
#include "chicane/base/math.hpp"
#include "chicane/model/vehicle.hpp"

namespace chicane::model {

/// The part of a car's motion that does not depend on where it is.
template <class T>
struct BodyMotion {
  T vx{};            ///< [m/s]
  T vy{};            ///< [m/s]
  T r{};             ///< yaw rate [rad/s]
  T steer{};         ///< road-wheel angle [rad]
  T acceleration{};  ///< net longitudinal acceleration, drag included, cornering resistance not [m/s²]
};

/// The car model of a tracking controller: a single track with saturating tyres, steering and drive lag,
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
/// T is double, or holds derivatives, several stages at once, or both (base/jet.hpp). No allocation, no
/// failure for finite input, any dt > 0. Error O(dt²) per step.
class PredictionModel {
 public:
  explicit PredictionModel(const model::VehicleParams& vehicle) noexcept : vehicle_{vehicle} {}
  void set_vehicle(const model::VehicleParams& vehicle) noexcept { vehicle_ = vehicle; }

  /// What a first-order lag leaves of the difference between now and asked.
  struct Lag {
    double end = 0.0;   ///< at the end of a step
    double mean = 0.0;  ///< in its mean
  };
  /// Those of steering and drive over dt [s].
  struct Lags {
    Lag steer;
    Lag drive;
  };
  [[nodiscard]] Lags lags(double dt) const noexcept {
    return {lag(vehicle_.steer_lag, dt), lag(vehicle_.drive_lag, dt)};
  }

  /// v_x, v_y and r after dt [s] with the given mean road-wheel angle and net acceleration. `dt` is a double,
  /// or one for each lane of T.
  template <class T, class D>
  [[nodiscard]] CHICANE_INLINE inline BodyMotion<T> advance(const BodyMotion<T>& from, const T& steer,
                                                            const T& acceleration,
                                                            const D& dt) const noexcept {
    const model::VehicleParams& p = vehicle_;
    const Tires<T> tires = tire_state(from, steer);
    const T& kf = tires.stiffness_front;
    const T& kr = tires.stiffness_rear;
    const T& inverse_v = tires.inverse_speed;
    const double a = p.front_axle;
    const double b = p.rear_axle;
    const D turn = dt * (p.mass / p.yaw_inertia);

    // (1 − dt A)(v_y, r)⁺ = (v_y, r) + dt B δ
    const T sum = (kf + kr) * inverse_v;
    const T moment = (a * kf - b * kr) * inverse_v;
    const T damping = (a * a * kf + b * b * kr) * inverse_v;
    const T a11 = 1.0 + dt * sum;
    const T a12 = dt * (moment + (1.0 - p.steer_helper) * from.vx);
    const T a21 = turn * moment;
    const T a22 = 1.0 + turn * damping;
    const T force = kf * steer;
    const T b1 = from.vy + dt * force;
    const T b2 = from.r + (turn * a) * force;
    const T det = a11 * a22 - a12 * a21;
    // A car about to spin has no implicit step for large dt: let it grow fivefold, not without bound.
    const T inverse_det = 1.0 / T(select(det > kLeastDeterminant, det, kLeastDeterminant));
    BodyMotion<T> to;
    to.vy = (b1 * a22 - a12 * b2) * inverse_det;
    to.r = (a11 * b2 - a21 * b1) * inverse_det;

    const T slip_front = steer - (to.vy + a * to.r) * inverse_v;
    to.vx = from.vx + dt * (acceleration + (1.0 - p.steer_helper) * to.r * to.vy - force * slip_front);
    return to;
  }

  /// The whole motion after dt [s] with what is asked for all along.
  [[nodiscard]] BodyMotion<double> advance(const BodyMotion<double>& from, double steer_asked,
                                           double acceleration_asked, double dt,
                                           const Lags& lags) const noexcept {
    const double steer = from.steer - steer_asked;
    const double acceleration = from.acceleration - acceleration_asked;
    BodyMotion<double> to = advance(from, steer_asked + steer * lags.steer.mean,
                                    acceleration_asked + acceleration * lags.drive.mean, dt);
    to.steer = steer_asked + steer * lags.steer.end;
    to.acceleration = acceleration_asked + acceleration * lags.drive.end;
    return to;
  }

  /// What the braking force of the steered front wheels adds over dt [s]: it points along the wheels, not
  /// along the car. Left out of advance(), where it matters little.
  void add_front_force(BodyMotion<double>& to, double dt) const noexcept {
    const double sideways = dt * front_force(to);
    to.vy += sideways;
    to.r += vehicle_.mass / vehicle_.yaw_inertia * vehicle_.front_axle * sideways;
  }

  /// Normalised lateral tyre use, front and rear: cornering · slip / friction. 1 is where the linear tyre
  /// would reach its peak; larger means sliding.
  template <class T>
  [[nodiscard]] CHICANE_INLINE inline std::array<T, 2> tire_use(const BodyMotion<T>& motion) const noexcept {
    const Tires<T> tires = tire_state(motion, motion.steer);
    return {tires.use_front, tires.use_rear};
  }

  /// Static stability at speed v [m/s] and deceleration `a` [m/s²]: k_f k_r L² over v² (a k_f − b k_r), where
  /// load transfer has changed the stiffnesses. Below 1 the car turns away from its path by itself; infinite
  /// where it understeers.
  [[nodiscard]] double stability(double v, double a) const noexcept {
    const model::VehicleParams& p = vehicle_;
    const double transfer = p.height / kGravity * a * kSlopeFollowsLoad;
    const double share = load(v) / p.wheelbase();
    const double front = p.rear_axle * share * p.cornering_front * (1.0 + transfer / p.rear_axle);
    const double rear = p.front_axle * share * p.cornering_rear * (1.0 - transfer / p.front_axle);
    const double moment = (1.0 - p.steer_helper) * v * v * (p.front_axle * front - p.rear_axle * rear);
    if (!(moment > 0.0)) return std::numeric_limits<double>::infinity();
    return front * rear * p.wheelbase() * p.wheelbase() / moment;
  }

  /// The road-wheel angle at which the yaw rate begins to change by `yaw_acceleration` [rad/s²], lag apart;
  /// no more slip than the front tyres' peak [rad].
  [[nodiscard]] double steer_for(const BodyMotion<double>& m, double yaw_acceleration) const noexcept {
    const model::VehicleParams& p = vehicle_;
    const Tires<double> tires = tire_state(m, m.steer);
    const double rear = tires.stiffness_rear * (p.rear_axle * m.r - m.vy) * tires.inverse_speed;
    const double wanted =
        (p.yaw_inertia / p.mass * yaw_acceleration + p.rear_axle * rear) / p.front_axle - front_force(m);
    const double most = p.friction / p.cornering_front;
    const double slip = wanted / tires.stiffness_front;
    return (slip < -most  ? -most
            : slip > most ? most
                          : slip) +
           (m.vy + p.front_axle * m.r) * tires.inverse_speed;
  }

  /// Normal acceleration carried by the tyres at speed v [m/s²].
  [[nodiscard]] double load(double v) const noexcept {
    return vehicle_.load_constant + vehicle_.load_per_speed * v;
  }
  [[nodiscard]] const model::VehicleParams& vehicle() const noexcept { return vehicle_; }

 private:
  /// Sideways, per mass [m/s²].
  [[nodiscard]] double front_force(const BodyMotion<double>& m) const noexcept {
    return vehicle_.brake_share_front * (m.acceleration < 0.0 ? m.acceleration : 0.0) * m.steer;
  }
  static constexpr double kGravity = 9.81;  ///< [m/s²]
  static constexpr double kLeastDeterminant = 0.2;
  static constexpr double kSpeedFloor =
      1.0;  ///< [m/s] slip angles are computed with at least about this speed

  template <class T>
  struct Tires {
    T inverse_speed, use_front, use_rear, stiffness_front, stiffness_rear;
  };

  static Lag lag(double time_constant, double dt) noexcept {
    if (time_constant <= 1e-4) return {};
    const double decay = exp(-dt / time_constant);
    return {decay, (1.0 - decay) * time_constant / dt};
  }

  template <class T>
  [[nodiscard]] CHICANE_INLINE inline Tires<T> tire_state(const BodyMotion<T>& m,
                                                          const T& steer) const noexcept {
    const model::VehicleParams& p = vehicle_;
    const double per_wheelbase = 1.0 / p.wheelbase();
    const T speed = sqrt(m.vx * m.vx + kSpeedFloor * kSpeedFloor);
    const T load_now = p.load_constant + p.load_per_speed * speed;
    const T transfer = (p.height / kGravity) * m.acceleration;
    const T share_front = 1.0 - (1.0 / p.rear_axle) * transfer;  // of its load at rest
    const T share_rear = 1.0 + (1.0 / p.front_axle) * transfer;
    const T along = m.acceleration / (p.friction * load_now);
    const T square = along * along;
    // Even a locked car keeps some sideways force.
    const T taken = select(square < kMostOfEllipse, square, kMostOfEllipse);
    const T peak = p.friction * sqrt(1.0 - p.friction_coupling * taken);
    Tires<T> t;
    t.inverse_speed = 1.0 / speed;
    const T slip_front = steer - (m.vy + p.front_axle * m.r) * t.inverse_speed;
    const T slip_rear = (p.rear_axle * m.r - m.vy) * t.inverse_speed;
    // Load moves the peak in proportion, the slope by less. Without that a braking car seems stable that is
    // not.
    const T cornering_front = p.cornering_front * (1.0 - (kSlopeFollowsLoad / p.rear_axle) * transfer);
    const T cornering_rear = p.cornering_rear * (1.0 + (kSlopeFollowsLoad / p.front_axle) * transfer);
    t.use_front = cornering_front * slip_front / (peak * share_front);
    t.use_rear = cornering_rear * slip_rear / (peak * share_rear);
    t.stiffness_front = (p.rear_axle * per_wheelbase) * load_now * cornering_front * saturation(t.use_front);
    t.stiffness_rear = (p.front_axle * per_wheelbase) * load_now * cornering_rear * saturation(t.use_rear);
    return t;
  }

  /// Secant of the tyre curve over its initial slope: (1 + z⁴)^(−1/4); force tends to the peak, never falls.
  template <class T>
  CHICANE_INLINE static inline T saturation(const T& z) noexcept {
    const T z2 = z * z;
    return 1.0 / sqrt(sqrt(1.0 + z2 * z2));
  }

  static constexpr double kMostOfEllipse = 0.8;
  static constexpr double kSlopeFollowsLoad = 0.7;  ///< change of cornering stiffness over that of load
  model::VehicleParams vehicle_;
};

}  // namespace chicane::model
