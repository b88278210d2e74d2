// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include "chicane/base/angle.hpp"
#include "chicane/base/math.hpp"
#include "chicane/controller/cubic_mpc.hpp"
#include "chicane/controller/local_fit.hpp"
#include "chicane/model/vehicle.hpp"

namespace chicane::controller {

/// The optimal control problem of the five write-ups (docs/problem.md, equations 1 to 13), in the car's
/// frame:
///
///     state  x, y [m], ψ [rad], v [m/s, or mph with speed_in_mph], cte [m], eψ [rad], and the inputs of the
///     stage before, δ⁻ [rad], a⁻ input  δ [rad], |δ| <= steer_limit, in the model's own sign; a in [-1, 1],
///     throttle taken for acceleration [m/s²]
///
/// A solver::OcpProblem: residuals carry √(2 weight), so that the solver's ½‖r‖² is the described weighted
/// sum of squares.
struct CubicProblem {
  static constexpr int kNx = 8;
  static constexpr int kNu = 2;
  static constexpr int kNr = 8;
  static constexpr int kNe = 3;
  static constexpr int kNc = 0;
  enum StateIndex : std::size_t { kX, kY, kPsi, kV, kCte, kEpsi, kLastSteer, kLastThrottle };
  enum InputIndex : std::size_t { kSteer, kThrottle };
  template <class T>
  using States = std::array<T, kNx>;
  template <class T>
  using Inputs = std::array<T, kNu>;

  CubicProblem(const CubicMpcOptions& options, const model::VehicleParams& vehicle) noexcept
      : dt{options.step_length},
        turn_per_metre{(options.steering_right_positive ? -1.0 : 1.0) / vehicle.kinematic_length},
        steer_limit{vehicle.steer_limit},
        speed_unit{options.speed_in_mph ? mps_to_mph(1.0) : 1.0},
        speed_reference{options.speed_reference * speed_unit},
        acts_late{options.latency_handling == LatencyHandling::kInsideModel},
        root{weight_root(options.weight_lateral),         weight_root(options.weight_heading),
             weight_root(options.weight_speed),           weight_root(options.weight_steer),
             weight_root(options.weight_throttle),        weight_root(options.weight_steer_change),
             weight_root(options.weight_throttle_change), weight_root(options.weight_speed_steer)} {}

  /// Equations 1 to 6: forward Euler, with the described recursions of both errors.
  template <class T>
  [[nodiscard]] States<T> dynamics(int, const States<T>& x, const Inputs<T>& u) const {
    const T steer = acts_late ? x[kLastSteer] : u[kSteer];
    const T throttle = acts_late ? x[kLastThrottle] : u[kThrottle];
    const T turn = x[kV] * steer * (turn_per_metre * dt);
    return {x[kX] + x[kV] * cos(x[kPsi]) * dt,
            x[kY] + x[kV] * sin(x[kPsi]) * dt,
            x[kPsi] + turn,
            x[kV] + throttle * dt,
            line.at(x[kX]) - x[kY] + x[kV] * sin(x[kEpsi]) * dt,
            x[kPsi] - atan(line.slope(x[kX])) + turn,
            u[kSteer],
            u[kThrottle]};
  }

  /// Equation 7, one stage. The first stage has no change to pay for, as described.
  template <class T>
  [[nodiscard]] std::array<T, kNr> residual(int k, const States<T>& x, const Inputs<T>& u) const {
    const double is_change = k > 0 ? 1.0 : 0.0;
    return {x[kCte] * root[0],
            x[kEpsi] * root[1],
            (x[kV] - speed_reference) * root[2],
            u[kSteer] * root[3],
            u[kThrottle] * root[4],
            (u[kSteer] - x[kLastSteer]) * (is_change * root[5]),
            (u[kThrottle] - x[kLastThrottle]) * (is_change * root[6]),
            x[kV] * u[kSteer] * root[7]};
  }

  template <class T>
  [[nodiscard]] std::array<T, kNe> terminal_residual(const States<T>& x) const {
    return {x[kCte] * root[0], x[kEpsi] * root[1], (x[kV] - speed_reference) * root[2]};
  }

  [[nodiscard]] Inputs<double> input_lower(int) const { return {-steer_limit, -1.0}; }
  [[nodiscard]] Inputs<double> input_upper(int) const { return {steer_limit, 1.0}; }

  double dt;              ///< [s]
  double turn_per_metre;  ///< ±1 / L_f: + for steering positive left, − for the simulator's own sign [1/m]
  double steer_limit;     ///< [rad]
  double speed_unit;      ///< the model's v for 1 m/s
  double speed_reference;        ///< as the model's v
  bool acts_late;                ///< the inputs of a stage act in the next one
  std::array<double, kNr> root;  ///< √(2 weight) of: cte, eψ, v, δ, a, Δδ, Δa, v δ
  Cubic line;                    ///< reference, renewed in every step

 private:
  static double weight_root(double weight) noexcept { return sqrt(2.0 * weight); }
};

}  // namespace chicane::controller
