// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "chicane/base/option.hpp"
#include "chicane/base/result.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/model/vehicle.hpp"

namespace chicane::controller {

/// Treatment of the time between measurement and actuation.
enum class LatencyHandling {
  kNone,          ///< no compensation
  kRollForward,   ///< whole kinematic state rolled forward by `latency`
  kMeasured,      ///< the same by the measured loop time, averaged with the value before
  kPositionOnly,  ///< only x and y rolled forward by `latency`
  kInsideModel,   ///< each stage driven by the inputs of the stage before (dt = the delay)
};

/// The nonlinear MPC of the five write-ups: kinematic bicycle, cubic in the car's frame, weighted squares.
/// Weights multiply squares of SI quantities (v in mph where the model has it so); throttle stands for
/// acceleration.
struct CubicMpcOptions {
  int horizon_steps = 10;         ///< N; time grows linearly
  double step_length = 0.1;       ///< dt [s]
  double speed_reference = 17.9;  ///< [m/s]
  LatencyHandling latency_handling = LatencyHandling::kRollForward;
  double latency = 0.1;          ///< compensated when not measured [s]
  bool polar_waypoints = false;  ///< waypoints to the car's frame by radius and angle instead of a rotation
  bool steering_right_positive = false;  ///< model written with the simulator's sign: ψ⁺ = ψ − v δ dt / L_f
  /// The model takes telemetry's miles per hour for metres per second: it sees 2.24 times as far, and steers
  /// that much less. The delay is still rolled forward in m/s.
  bool speed_in_mph = false;
  /// Whether the roll-forward reads speeds in mph, too: it then predicts 2.24 times the distance, as with a
  /// longer latency.
  bool roll_forward_in_mph = false;
  /// Write-up of `measured-latency`: equation 5 with cte = y − f(x) (docs/the_five_systems.md).
  bool lateral_error_to_left = false;
  /// The same write-up: equation 6 as eψ⁺ = eψ + v δ dt / L_f. The bend ahead is seen by cte alone.
  bool heading_error_integrated = false;
  /// The same write-up: equation 5 as cte⁺ = cte + v sin eψ dt, the distance from the line's tangent at the
  /// beginning. Needs heading_error_integrated.
  bool lateral_error_integrated = false;
  int line_order = 3;  ///< order of the polynomial through the waypoints, 1 to 3
  /// Equation 16 with its term a tan δ τ² / (2 L_f).
  bool latency_acceleration_term = true;
  double weight_lateral = 200.0;        ///< weight of cte² [1/m²]
  double weight_heading = 200.0;        ///< weight of eψ² [1/rad²]
  double weight_speed = 0.1;            ///< weight of (v − v_ref)² [s²/m²]
  double weight_steer = 1.0;            ///< weight of δ² [1/rad²]
  double weight_throttle = 1.0;         ///< weight of a²
  double weight_steer_change = 10.0;    ///< weight of (δ_{k+1} − δ_k)² [1/rad²]
  double weight_throttle_change = 1.0;  ///< weight of (a_{k+1} − a_k)²
  double weight_speed_steer = 0.0;      ///< weight of (v δ)² [s²/(m² rad²)]
};

/// Builds it. Pre of use: waypoints in every measurement (it keeps no map). kInvalidArgument names an option
/// out of range.
[[nodiscard]] Result<std::unique_ptr<Controller>> make_cubic_mpc(const CubicMpcOptions& options,
                                                                 const model::VehicleParams& vehicle);

struct CubicMpcEntry {
  using Options = CubicMpcOptions;
  static constexpr std::string_view kName = "cubic-mpc";
  static constexpr std::string_view kMeaning =
      "the one the write-ups describe: kinematic bicycle, cubic in the car's frame";
  static constexpr std::string_view kSpeedOption = "speed_reference";
  [[nodiscard]] static std::span<const Option> options() noexcept;
  static constexpr auto kMake = &make_cubic_mpc;
  [[nodiscard]] static std::vector<OptionContradiction> contradictions(const CubicMpcOptions& options);
};

}  // namespace chicane::controller
