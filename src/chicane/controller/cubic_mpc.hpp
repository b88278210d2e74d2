// SPDX-License-Identifier: MIT
// Options and entry of the controller `cubic-mpc`: the nonlinear MPC of five write-ups
// (docs/the_five_systems.md).
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
  kMeasured,      ///< state rolled forward by the measured loop time, averaged with the value before
  kPositionOnly,  ///< x and y alone rolled forward by `latency`
  kInsideModel,   ///< inputs act one stage late; the delay is step_length
};

/// Options of the nonlinear MPC of the five write-ups: kinematic bicycle, cubic in the car's frame, weighted
/// squares. Weights multiply squares of SI quantities, with speed_in_mph the squared speed in mph. The model
/// takes throttle for acceleration.
struct CubicMpcOptions {
  int horizon_steps = 10;         ///< N; the solve time grows linearly with N
  double step_length = 0.1;       ///< dt [s]
  double speed_reference = 17.9;  ///< [m/s]
  LatencyHandling latency_handling = LatencyHandling::kRollForward;
  double latency = 0.1;  ///< compensated delay if it is not measured [s]
  /// Transforms waypoints to the car's frame by radius and angle, else by a rotation.
  bool polar_waypoints = false;
  /// Model with the simulator's sign of steering: ψ⁺ = ψ − v δ dt / L_f.
  bool steering_right_positive = false;
  /// Speeds of the model are in miles per hour, taken for metres per second: the horizon is 2.24 times as
  /// long, and the steering smaller by the same factor. The roll-forward still has m/s.
  bool speed_in_mph = false;
  /// Speeds of the roll-forward are in miles per hour, taken for metres per second: it predicts 2.24 times
  /// the distance, as with a longer latency.
  bool roll_forward_in_mph = false;
  /// Equation 5 with cte = y − f(x), as in the write-up of `measured-latency`.
  bool lateral_error_to_left = false;
  /// Equation 6 as eψ⁺ = eψ + v δ dt / L_f, as in the write-up of `measured-latency`. Only cte then depends
  /// on the bend ahead.
  bool heading_error_integrated = false;
  /// Equation 5 as cte⁺ = cte + v sin eψ dt, the distance from the line's tangent at the car, as in the
  /// write-up of `measured-latency`. Needs heading_error_integrated.
  bool lateral_error_integrated = false;
  int line_order = 3;  ///< order of the polynomial fitted to the waypoints, 1 to 3
  /// Equation 16 includes its term a tan δ τ² / (2 L_f).
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

/// Makes the controller. It keeps no map: every measurement needs waypoints. kInvalidArgument names an option
/// out of range.
[[nodiscard]] Result<std::unique_ptr<Controller>> make_cubic_mpc(const CubicMpcOptions& options,
                                                                 const model::VehicleParams& vehicle);

/// Entry of the controller (controller_list.hpp).
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
