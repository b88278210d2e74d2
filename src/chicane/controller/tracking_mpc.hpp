// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "chicane/base/result.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/model/vehicle.hpp"

namespace chicane::controller {

/// The default controller: arc-length reference from remembered waypoints, single-track model with the car's
/// yaw lag, commands in flight replayed through it, speed planned for curvature and sight.
struct TrackingMpcOptions {
  int horizon_steps = 40;     ///< N; [5, 100]
  double step_length = 0.05;  ///< dt [s]; [0.01, 0.2]
  double speed_limit = 60.0;  ///< never planned above [m/s]; [1, 100]
  double grip_share = 0.8;    ///< of the believed tyre force used by the speed plan; (0, 1]
  double brake_share = 0.6;   ///< of the believed braking used by the speed plan; (0, 1]
  double assumed_half_width =
      3.0;  ///< road each side of the waypoint line the centre of mass may use [m]; [0.2, 20]
  double smoothing_width = 1.0;  ///< the reference line may leave the waypoint line by this much [m]; [0, 10]
  double weight_lateral = 1.0;   ///< on the lateral error² [1/m²]
  double weight_heading = 5.0;   ///< on the heading error² [1/rad²]
  double weight_speed = 0.5;     ///< on (v − v_ref)² [s²/m²]
  double weight_steer_rate = 10.0;  ///< on (steering rate)² [s²/rad²]
  double weight_jerk = 0.02;        ///< on (change of acceleration per second)² [s⁶/m²]
  double weight_edge = 200.0;       ///< price of leaving assumed_half_width, per m² [1/m²]
  double weight_slip = 100.0;       ///< price of slip beyond the useful, normalised²
  bool compensate_delay = true;     ///< replay commands in flight; off only to show what happens
  bool remember_waypoints = true;   ///< close the waypoints seen into a map
};

[[nodiscard]] Result<std::unique_ptr<Controller>> make_tracking_mpc(const TrackingMpcOptions& options,
                                                                    const model::VehicleParams& vehicle);

}  // namespace chicane::controller
