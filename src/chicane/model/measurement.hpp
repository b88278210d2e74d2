// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "chicane/base/vec2.hpp"
#include "chicane/model/state.hpp"

namespace chicane::model {

/// Input of a controller in one cycle: exactly what the original simulator's telemetry holds, in our axes
/// and units.
struct Measurement {
  static constexpr int kMaxWaypoints = 32;

  double time = 0.0;   ///< when it was sampled [s], monotonic clock of the run
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
      waypoints{};  ///< in W [m], in driving order; the first may lie behind the car
};

}  // namespace chicane::model
