// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <string_view>

#include "chicane/base/option.hpp"
#include "chicane/base/result.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/road/road.hpp"

namespace chicane::controller {

/// The default controller: arc-length reference from remembered waypoints, single-track model with the car's
/// yaw lag, commands in flight replayed through it, speed planned for curvature and sight.
struct TrackingMpcOptions {
  static constexpr int kMostIterations = 12;
  int horizon_steps = 40;           ///< N
  double step_length = 0.05;        ///< dt [s]
  double speed_limit = 60.0;        ///< never planned above [m/s]
  double grip_share = 0.8;          ///< share of the modelled tyre force used by the speed plan
  double brake_share = 0.6;         ///< share of the modelled braking used by the speed plan
  double assumed_half_width = 3.0;  ///< road each side of the waypoint line the centre of mass may use [m]
  double smoothing_width = 1.0;     ///< the reference line may leave the waypoint line by this much [m]
  double weight_lateral = 1.0;      ///< weight of lateral error² [1/m²]
  double weight_heading = 5.0;      ///< weight of heading error² [1/rad²]
  double weight_speed = 0.5;        ///< weight of (v − v_ref)² [s²/m²]
  double weight_progress = 0.0;     ///< weight of −v on a planned lap, if weight_speed > 0 [s/m]
  double weight_steer_rate = 10.0;  ///< weight of (steering rate)² [s²/rad²]
  double weight_jerk = 0.02;        ///< weight of (change of acceleration per second)² [s⁶/m²]
  double weight_edge = 200.0;       ///< weight of (leaving assumed_half_width)² [1/m²]
  double weight_slip = 100.0;       ///< weight of (slip beyond the useful, normalised)²
  bool compensate_delay = true;     ///< replay commands in flight; off only to show what happens
  bool racing_line = false;         ///< race by the minimum-time line of track or learned road
  double edge_margin = 0.2;         ///< gap that tyres keep to the edges on a planned lap [m]
  double slip_share = 1.0;          ///< largest axle slip in the plan to race by, over the slip of peak force
  bool slide = false;               ///< allows slip beyond the peak where it is stable (model::SlidingBound)
  double plan_budget = 90.0;        ///< work that a plan to race by may take (lap_time::PlanProgress) [s]
  int iterations = 3;               ///< minimum iterations of the solver in a step
  bool learn_grip = false;          ///< race with the grip that the tyres have shown (docs/racing.md)
  bool remember_waypoints = true;   ///< close the waypoints seen into a map

  /// Speed demand above the planned speed where that changes by `acceleration` [m/s²], for weight_progress
  /// (docs/controller.md, eq. 18a) [m/s].
  [[nodiscard]] double haste(double acceleration) const noexcept {
    constexpr double kBraking = 3.0;  // [m/s²] from which on there is none
    if (!(weight_speed > 0.0)) return 0.0;
    return weight_progress / (2.0 * weight_speed) * std::clamp(1.0 + acceleration / kBraking, 0.0, 1.0);
  }
  /// Grip that the first lap is planned with, over the vehicle parameters' grip.
  [[nodiscard]] double first_grip() const noexcept { return learns() ? kUnprovenGrip : 1.0; }
  [[nodiscard]] bool learns() const noexcept { return racing_line && learn_grip; }
  static constexpr double kUnprovenGrip = 0.6;  ///< grip of the first lap, over the configured grip
  /// Options for turning waypoints into the road.
  [[nodiscard]] road::RoadOptions road() const noexcept {
    return {.half_width = assumed_half_width,
            .smoothing_width = smoothing_width,
            .remember_waypoints = remember_waypoints,
            .speed = {.speed_limit = speed_limit, .grip_share = grip_share, .brake_share = brake_share}};
  }
};

/// Makes the controller. kInvalidArgument names an option outside the range in its row.
[[nodiscard]] Result<std::unique_ptr<Controller>> make_tracking_mpc(const TrackingMpcOptions& options,
                                                                    const model::VehicleParams& vehicle);

struct TrackingMpcEntry {
  using Options = TrackingMpcOptions;
  static constexpr std::string_view kName = "tracking-mpc";
  static constexpr std::string_view kMeaning =
      "ours: arc-length reference, yaw lag, commands in flight, planned speed";
  static constexpr std::string_view kSpeedOption = "speed_limit";  // option that bounds the planned speed
  [[nodiscard]] static std::span<const Option> options() noexcept;
  static constexpr auto kMake = &make_tracking_mpc;
};

}  // namespace chicane::controller
