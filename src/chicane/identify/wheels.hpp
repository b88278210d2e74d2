// SPDX-License-Identifier: MIT
#pragma once

namespace chicane::identify {

/// Forward slips at which a controller of the wheels begins to take torque away, and has taken all of it.
/// Infinite where there is none.
struct SlipLimit {
  double start = 0.1, end = 0.18;
};

/// What a car's wheels do that no controller's model has, and a log near the limit shows.
struct Wheels {
  double relaxation = 0.3;  ///< way over which a tyre builds up its force across [m]
  double load_lag = 0.06;   ///< time constant of the load transfer [s]
  double rotating = 1.05;   ///< mass with the inertia of what turns, over mass
  SlipLimit brakes{};       ///< of anti-lock
  SlipLimit drive{};        ///< of traction control
};

}  // namespace chicane::identify
