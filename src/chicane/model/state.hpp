// SPDX-License-Identifier: MIT
#pragma once

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

/// What a controller asks of the car.
struct Command {
  double steer = 0.0;     ///< road-wheel angle [rad], left positive, |steer| <= VehicleParams::steer_limit
  double throttle = 0.0;  ///< one pedal in [-1, 1]: positive drives, negative brakes
};

/// A position and direction in W.
struct Pose {
  double x = 0.0;    ///< [m]
  double y = 0.0;    ///< [m]
  double psi = 0.0;  ///< [rad]
};

}  // namespace chicane::model
