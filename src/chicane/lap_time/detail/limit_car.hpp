// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/base/inlining.hpp"
#include "chicane/model/vehicle.hpp"

namespace chicane::lap_time {

/// The car of the limit (docs/limit.md, eq. Q1–Q6): it follows its path, its axles give any force within
/// their grip at once, turning the body takes force, too. Coefficients of a VehicleParams; the functions of a
/// speed take numbers and jets (base/jet.hpp).
struct LimitCar {
  explicit LimitCar(const model::VehicleParams& vehicle = {}) noexcept;

  double front_axle, rear_axle;     ///< from the centre of mass [m]
  double half_width;                ///< to the outer edge of a contact patch [m]
  double stay;                      ///< 1 − h: share of the centripetal acceleration that tyres give
  double front_turn, rear_turn;     ///< what a change of curvature adds to the demand, I/(m b), I/(m a) [m]
  double grip_0, grip_v, grip_vv;   ///< tyre force over mass: grip_0 + (grip_v + grip_vv · v) · v
  double brake_front, drive_front;  ///< share of the brake and drive force at the front
  double front_part, rear_part;     ///< the car's load over that of an axle
  double front_roll, rear_roll;     ///< what an inner wheel loses of its load for each m/s² [s²/m]
  double sensitivity;               ///< share of the friction that an axle loses when its load doubles
  double coupling;                  ///< 1: driving, braking and cornering share the friction ellipse
  double front_shift, rear_shift;   ///< change of an axle's share of the load by acceleration [s²/m]
  double drive, power, brake;       ///< [m/s²], [W/kg], [m/s²]
  double drag_0, drag_v, drag_vv;   ///< [m/s²], [1/s], [1/m]
  double slip_drag;                 ///< deceleration per (v² κ)² · load [s⁰], eq. 5
  double slip_heading;              ///< rear slip angle per v² κ · load [rad], eq. 6
  double load_0, load_v, load_vv;   ///< load over mass, in the same way [m/s²], [1/s], [1/m]
  double curvature_limit;           ///< at full lock [1/m]
  double curvature_rate;            ///< fastest change of the path's curvature, from the steering [1/(m s)]

  /// Largest tyre force over mass at speed v [m/s²].
  template <class V>
  [[nodiscard]] CHICANE_INLINE inline auto grip(const V& v) const noexcept {
    return grip_0 + (grip_v + grip_vv * v) * v;
  }
  template <class V>
  [[nodiscard]] CHICANE_INLINE inline auto load(const V& v) const noexcept {
    return load_0 + (load_v + load_vv * v) * v;
  }
  /// Deceleration by drag at v > 0 [m/s²].
  template <class V>
  [[nodiscard]] CHICANE_INLINE inline auto drag(const V& v) const noexcept {
    return drag_0 + (drag_v + drag_vv * v) * v;
  }
};

}  // namespace chicane::lap_time
