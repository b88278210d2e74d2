// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/base/jet.hpp"
#include "chicane/base/math.hpp"
#include "chicane/model/vehicle.hpp"

namespace chicane::sim::experiment {

/// Velocity of a car in its own axes B: what its tyres see. Also holds the rate of change of the same
/// quantities.
template <class T>
struct BodyMotion {
  T vx{};  ///< along B's x [m/s]
  T vy{};  ///< along B's y [m/s]
  T r{};   ///< yaw rate [rad/s]
};

/// The textbook single track, by which the plants are judged: one front and one rear wheel with saturating
/// tyres: longitudinal, lateral and yaw motion. No roll, no load transfer, no coupling of longitudinal to
/// lateral force.
///
/// Frames    W world, B body at the centre of mass (docs/notation.md).
/// Input     road-wheel angle δ, left positive [rad]; net longitudinal acceleration a of drive, brake and
///           drag [m/s²], from model::longitudinal_acceleration().
///
/// Equations (docs/model.md, eq. 2–6; Rajamani 2012, §2.3, with the steer helper's share h):
///
///     vx' = a − f_f sin δ + (1 − h) r vy          f_i = g_i(v) μ tanh(C_i α_i / μ)
///     vy' = f_f cos δ + f_r − (1 − h) r vx        α_f = (vx sin δ − (vy + l_f r) cos δ) / √(vx² + v₀²)
///     r'  = (m / I) (l_f f_f cos δ − l_r f_r)     α_r = (l_r r − vy) / √(vx² + v₀²)
///
///           f force over mass of an axle, g the load on it over mass [m/s²].
///
/// Valid     at any speed, standstill and reverse included: as v → 0 the car tends to the kinematic bicycle
///           of wheelbase l_f + l_r with a time constant of about v₀ / (C g). Smooth everywhere. Slips up to
///           the tyre's peak; beyond, forces saturate and never fall.
/// Costs     one sin, cos and sqrt, two tanh; no allocation; const and safe to share. Template over the
///           scalar: call it with FullJet<N> for Jacobians.
struct SingleTrack {
  static constexpr double kSlipSpeed = 3.0;  ///< v₀ [m/s]: lateral stiffness is that of at least this speed

  model::VehicleParams params;

  /// Normal acceleration that presses the car on the road at speed vx [m/s²] (load over mass).
  template <class T>
  [[nodiscard]] T load(const T& vx) const {
    return params.load_constant + params.load_per_speed * vx;
  }

  /// Lateral forces of the front and rear axle over mass [m/s²], left positive, in the axle's own axes.
  template <class T>
  struct AxleForces {
    T front{};
    T rear{};
  };
  template <class T>
  [[nodiscard]] AxleForces<T> axle_forces(const BodyMotion<T>& motion, const T& steer) const {
    const model::VehicleParams& p = params;
    const T reciprocal = 1.0 / sqrt(motion.vx * motion.vx + kSlipSpeed * kSlipSpeed);
    const T slip_front =
        (motion.vx * sin(steer) - (motion.vy + p.front_axle * motion.r) * cos(steer)) * reciprocal;
    const T slip_rear = (p.rear_axle * motion.r - motion.vy) * reciprocal;
    const T pressed = load(motion.vx) * (p.friction / p.wheelbase());
    return {.front = pressed * p.rear_axle * tanh(slip_front * (p.cornering_front / p.friction)),
            .rear = pressed * p.front_axle * tanh(slip_rear * (p.cornering_rear / p.friction))};
  }

  /// d(vx, vy, r)/dt for road-wheel angle `steer` [rad] and net longitudinal acceleration [m/s²].
  template <class T>
  [[nodiscard]] BodyMotion<T> derivative(const BodyMotion<T>& motion, const T& steer,
                                         const T& acceleration) const {
    const model::VehicleParams& p = params;
    const AxleForces<T> force = axle_forces(motion, steer);
    const T turning = (1.0 - p.steer_helper) * motion.r;
    const T front_across = force.front * cos(steer);
    return {.vx = acceleration - force.front * sin(steer) + turning * motion.vy,
            .vy = front_across + force.rear - turning * motion.vx,
            .r = (p.front_axle * front_across - p.rear_axle * force.rear) * (p.mass / p.yaw_inertia)};
  }

  /// d(x, y, ψ, vx, vy, r, δ)/dt in W, in the order of model::State. `steer_rate` [rad/s].
  template <class T>
  struct StateOf {
    T x{}, y{}, psi{};
    BodyMotion<T> motion{};
    T steer{};
  };
  template <class T>
  [[nodiscard]] StateOf<T> derivative(const StateOf<T>& now, const T& steer_rate,
                                      const T& acceleration) const {
    const T c = cos(now.psi);
    const T s = sin(now.psi);
    return {.x = now.motion.vx * c - now.motion.vy * s,
            .y = now.motion.vx * s + now.motion.vy * c,
            .psi = now.motion.r,
            .motion = derivative(now.motion, now.steer, acceleration),
            .steer = steer_rate};
  }
};

/// One classical Runge–Kutta step of the body motion, inputs held; stable for dt up to 0.04 s at any speed
/// for the shipped cars.
template <class T>
[[nodiscard]] BodyMotion<T> advance(const SingleTrack& model, const BodyMotion<T>& now, const T& steer,
                                    const T& acceleration, double dt) {
  const auto moved = [&now](const BodyMotion<T>& rate, double time) {
    return BodyMotion<T>{now.vx + time * rate.vx, now.vy + time * rate.vy, now.r + time * rate.r};
  };
  const BodyMotion<T> k1 = model.derivative(now, steer, acceleration);
  const BodyMotion<T> k2 = model.derivative(moved(k1, 0.5 * dt), steer, acceleration);
  const BodyMotion<T> k3 = model.derivative(moved(k2, 0.5 * dt), steer, acceleration);
  const BodyMotion<T> k4 = model.derivative(moved(k3, dt), steer, acceleration);
  const auto mean = [](const T& a, const T& b, const T& c, const T& d) {
    return (a + 2.0 * b + 2.0 * c + d) / 6.0;
  };
  return moved(
      {mean(k1.vx, k2.vx, k3.vx, k4.vx), mean(k1.vy, k2.vy, k3.vy, k4.vy), mean(k1.r, k2.r, k3.r, k4.r)}, dt);
}

}  // namespace chicane::sim::experiment
