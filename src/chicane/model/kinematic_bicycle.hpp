// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/base/dual.hpp"
#include "chicane/base/math.hpp"
#include "chicane/model/vehicle.hpp"

namespace chicane::model {

/// A car that never slips: position, yaw and speed, one length. No tyres, no delay, no yaw lag.
///
/// Equations (docs/model.md, eq. 1; udacity/CarND-MPC-Project), forward Euler over dt:
///
///     x⁺ = x + v cos ψ dt        ψ⁺ = ψ + sign · v δ dt / L_f
///     y⁺ = y + v sin ψ dt        v⁺ = v + a dt
///
/// sign = +1 with steering positive to the left (ours), −1 with the original simulator's steering, positive
/// to the right. Valid at low speed and small δ (it uses δ for tan δ); the shipped L_f of 2.67 m is the
/// wheelbase seen through that. Template over the scalar: Dual gives Jacobians. No allocation.
struct KinematicBicycle {
  double length = 2.67;        ///< L_f [m], > 0
  double steering_sign = 1.0;  ///< +1 or −1

  template <class T>
  struct StateOf {
    T x{};    ///< in W [m]
    T y{};    ///< in W [m]
    T psi{};  ///< [rad]
    T v{};    ///< [m/s]
  };

  /// The state dt [s] later for road-wheel angle `steer` [rad] and acceleration [m/s²] held.
  template <class T>
  [[nodiscard]] StateOf<T> step(const StateOf<T>& now, const T& steer, const T& acceleration,
                                double dt) const {
    return {.x = now.x + now.v * cos(now.psi) * dt,
            .y = now.y + now.v * sin(now.psi) * dt,
            .psi = now.psi + now.v * steer * (steering_sign * dt / length),
            .v = now.v + acceleration * dt};
  }
};

}  // namespace chicane::model
