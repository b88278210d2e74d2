// SPDX-License-Identifier: MIT
// Options and entry of the default controller, `tracking-mpc` (docs/controller.md).
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

/// Options of the default controller: arc-length reference from remembered waypoints, single-track model with
/// the car's yaw lag, commands in flight replayed through the model, speed planned for curvature and sight.
struct TrackingMpcOptions {
  /// Limit of `iterations`; chosen: a new guess converges in so many.
  static constexpr int kMostIterations = 12;
  int horizon_steps = 40;           ///< N
  double step_length = 0.05;        ///< dt [s]
  double speed_limit = 60.0;        ///< highest planned speed [m/s]
  double grip_share = 0.8;          ///< share of the modelled tyre force used by the speed plan
  double brake_share = 0.6;         ///< share of the modelled braking used by the speed plan
  double assumed_half_width = 3.0;  ///< road on each side of the waypoint line for the centre of mass [m]
  double smoothing_width = 1.0;     ///< largest distance of reference line and waypoint line [m]
  double weight_lateral = 1.0;      ///< weight of lateral error² [1/m²]
  double weight_heading = 5.0;      ///< weight of heading error² [1/rad²]
  double weight_speed = 0.5;        ///< weight of (v − v_ref)² [s²/m²]
  double weight_progress = 0.0;     ///< weight of −v on a planned lap, if weight_speed > 0 [s/m]
  double weight_steer_rate = 10.0;  ///< weight of (steering rate)² [s²/rad²]
  double weight_jerk = 0.02;        ///< weight of (change of acceleration per second)² [s⁶/m²]
  double weight_edge = 200.0;       ///< weight of (leaving assumed_half_width)² [1/m²]
  double weight_slip = 100.0;       ///< weight of (slip beyond the peak of the force, normalised)²
  bool compensate_delay = true;     ///< replays commands in flight; false to show what happens
  bool racing_line = false;         ///< races by the minimum-time line of track or learned road
  double edge_margin = 0.2;         ///< least gap from tyres to edges on a planned lap [m]
  double slip_share = 1.0;          ///< largest axle slip of a planned lap over the slip of peak force
  bool slide = false;               ///< allows slip beyond the peak if it is stable (model::SlidingBound)
  double plan_budget = 90.0;        ///< limit of the work of a planned lap (lap_time::PlanProgress) [s]
  int iterations = 3;               ///< least iterations of the solver in a step
  bool learn_grip = false;          ///< races with the grip that the tyres have shown (docs/racing.md)
  bool remember_waypoints = true;   ///< closes the seen waypoints into a map

  /// Addition to the planned speed for weight_progress [m/s]: less while the plan brakes. `acceleration`:
  /// planned one [m/s²] (docs/controller.md, eq. 18a).
  [[nodiscard]] double haste(double acceleration) const noexcept {
    constexpr double kBraking = 3.0;  // [m/s²] planned braking from which on the addition is 0; chosen
    if (!(weight_speed > 0.0)) return 0.0;
    return weight_progress / (2.0 * weight_speed) * std::clamp(1.0 + acceleration / kBraking, 0.0, 1.0);
  }
  /// Grip of the first planned lap over the configured grip.
  [[nodiscard]] double first_grip() const noexcept { return learns() ? kUnprovenGrip : 1.0; }
  /// Whether the controller learns the grip.
  [[nodiscard]] bool learns() const noexcept { return racing_line && learn_grip; }
  /// Grip before the tyres have shown any; chosen, docs/racing.md.
  static constexpr double kUnprovenGrip = 0.6;
  /// Options of the road that is made of waypoints.
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

/// Entry of the controller (controller_list.hpp).
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
