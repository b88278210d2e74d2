// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "chicane/base/result.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/model/vehicle.hpp"

namespace chicane::controller {

/// Speed hold shared by the baselines: throttle = speed_gain · (speed_reference − v) + what drag costs.
struct SpeedHoldOptions {
  double speed_reference = 13.4;            ///< [m/s]; [0, 60]
  double speed_gain = 0.3;                  ///< throttle per m/s; [0, 10]
  double lateral_acceleration_limit = 8.0;  ///< slows for curvature by v² |κ| <= limit [m/s²]; [0.1, 100]
};

/// Steer on the cross-track error: δ = −(kp e + ki ∫e dt + kd de/dt).
struct PidOptions {
  double proportional_gain = 0.06;  ///< [rad/m]; [0, 10]
  double integral_gain = 0.0;       ///< [rad/(m s)]; [0, 10]
  double derivative_gain = 0.06;    ///< [rad s/m]; [0, 10]
  SpeedHoldOptions speed;
};

/// Steer along the circle through a point ahead on the path (Coulter 1992).
struct PurePursuitOptions {
  double lookahead_time = 0.8;  ///< [s]; [0, 5]
  double lookahead_min = 5.0;   ///< [m]; [0.5, 50]
  SpeedHoldOptions speed;
};

/// Heading error plus arctan of the front axle's cross-track error over speed (Hoffmann et al. 2007).
struct StanleyOptions {
  double gain = 1.5;             ///< [1/s]; [0, 50]
  double softening_speed = 2.0;  ///< [m/s]; [0.01, 20]
  SpeedHoldOptions speed;
};

[[nodiscard]] Result<std::unique_ptr<Controller>> make_pid(const PidOptions& options,
                                                           const model::VehicleParams& vehicle);
[[nodiscard]] Result<std::unique_ptr<Controller>> make_pure_pursuit(const PurePursuitOptions& options,
                                                                    const model::VehicleParams& vehicle);
[[nodiscard]] Result<std::unique_ptr<Controller>> make_stanley(const StanleyOptions& options,
                                                               const model::VehicleParams& vehicle);

}  // namespace chicane::controller
