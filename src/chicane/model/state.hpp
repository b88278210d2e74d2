// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "chicane/base/vec2.hpp"

/// State, command, pose and measurement of a car: what plants, controllers and guard exchange.

namespace chicane::model {

/// Planar motion of a car, in the axes of the whole project (ISO 8855, docs/notation.md): world W
/// right-handed with z up, body B at the centre of mass, x forward, y left. Yaw, yaw rate and steering are
/// positive counter-clockwise, that is left.
struct State {
  double x = 0.0;      ///< position of B in W [m]
  double y = 0.0;      ///< position of B in W [m]
  double psi = 0.0;    ///< yaw of B in W [rad], not wrapped
  double vx = 0.0;     ///< velocity of B along B's x axis [m/s], negative in reverse
  double vy = 0.0;     ///< velocity of B along B's y axis [m/s]
  double r = 0.0;      ///< yaw rate [rad/s]
  double steer = 0.0;  ///< road-wheel angle now [rad], left positive
};

/// Command of a controller to the car.
struct Command {
  double steer = 0.0;     ///< road-wheel angle [rad], left positive, |steer| <= VehicleParams::steer_limit
  double throttle = 0.0;  ///< one pedal in [-1, 1]: positive drives, negative brakes
  friend bool operator==(const Command&, const Command&) = default;
};

/// A position and direction in W.
struct Pose {
  double x = 0.0;    ///< [m]
  double y = 0.0;    ///< [m]
  double psi = 0.0;  ///< [rad]
};

/// Input of a controller in one cycle: exactly the content of the original simulator's telemetry, in our axes
/// and units.
struct Measurement {
  static constexpr int kMaxWaypoints = 32;

  double time = 0.0;   ///< sampling time [s], monotonic clock of the run
  double x = 0.0;      ///< position of the centre of mass in W [m]
  double y = 0.0;      ///< [m]
  double psi = 0.0;    ///< yaw [rad], wrapped or not
  double speed = 0.0;  ///< magnitude of the velocity [m/s], >= 0 also in reverse
  double steer = 0.0;  ///< road-wheel angle that acted during the cycle before [rad], left positive
  double throttle =
      0.0;  ///< pedal that acted during the cycle before, [-1, 1]; the original reports braking as 0

  /// Expected time from `time` until the command computed from this measurement acts [s]: the run time's
  /// measurement of the last answered cycles, with all that lies between (computing, artificial latency,
  /// transport, turn-around).
  double delay = 0.0;

  int waypoint_count = 0;  ///< [0, kMaxWaypoints]
  std::array<Vec2, kMaxWaypoints>
      waypoints{};  ///< position in W [m], in driving order; the first may be behind the car

  /// Whether position, yaw and speed are measured: a sensor that failed reports a NaN.
  [[nodiscard]] bool is_finite() const noexcept { return std::isfinite(x + y + psi + speed); }
};

}  // namespace chicane::model
