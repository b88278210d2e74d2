// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <tuple>

#include "chicane/base/math.hpp"
#include "chicane/controller/cubic_mpc.hpp"
#include "chicane/controller/described_model.hpp"
#include "chicane/controller/local_fit.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/solver/stage_data.hpp"

namespace chicane::controller {

/// The optimal control problem of the five write-ups (docs/problem.md, equations 1 to 13), in the car's
/// frame and the solver's structured form (solver/problem.hpp):
///
///     state  x, y [m], ψ [rad], v [m/s, or mph with speed_in_mph], eψ [rad], and the inputs of the stage
///            before, δ⁻ [rad], a⁻
///     input  δ [rad], |δ| <= steer_limit, in the model's own sign; a in [-1, 1], throttle taken for
///            acceleration [m/s²]
///
/// cte of a stage follows from the stage before alone (equation 5): it is an output that this one pays for,
/// not a state. Residuals carry √(2 weight), so that the solver's ½‖r‖² is the described weighted sum of
/// squares.
struct CubicProblem {
  static constexpr int kNx = 7;
  static constexpr int kNu = 2;
  static constexpr int kNr = 8;
  static constexpr int kNe = 3;
  static constexpr int kNc = 0;
  static constexpr int kCapacity = 200;
  static constexpr bool kRealTime = true;
  enum StateIndex : std::size_t { kX, kY, kPsi, kV, kEpsi, kLastSteer, kLastThrottle };

  using State = std::array<double, kNx>;
  using Input = std::array<double, kNu>;

  CubicProblem(const CubicMpcOptions& options, const model::VehicleParams& vehicle) noexcept
      : dt{options.step_length},
        turn_per_metre{(options.steering_right_positive ? -1.0 : 1.0) / vehicle.kinematic_length},
        steer_limit{vehicle.steer_limit},
        speed_unit{options.speed_in_mph ? mps_to_mph(1.0) : 1.0},
        speed_reference{options.speed_reference * speed_unit},
        error_sign{options.lateral_error_to_left ? -1.0 : 1.0},
        heading_reach{options.heading_error_integrated ? 0.0 : 1.0},
        is_lateral_recursive{options.lateral_error_integrated},
        acts_late{options.latency_handling == LatencyHandling::kInsideModel},
        root{weight_root(options.weight_lateral),         weight_root(options.weight_heading),
             weight_root(options.weight_speed),           weight_root(options.weight_steer),
             weight_root(options.weight_throttle),        weight_root(options.weight_steer_change),
             weight_root(options.weight_throttle_change), weight_root(options.weight_speed_steer)} {}

  /// Equations 1 to 4 and 6: forward Euler, with the described recursion of the heading error.
  template <class K, class X, class U>
  [[nodiscard]] auto dynamics(K, const X& state, const U& input) const noexcept {
    const auto& [x, y, psi, v, epsi, last_steer, last_throttle] = state;
    const auto& [steer, throttle] = input;
    return model().next(state, std::make_tuple(acting(last_steer, steer), acting(last_throttle, throttle)),
                        input);
  }

  /// Equation 7, one stage, with cte of the next one. The first stage has no change to pay for, as described.
  template <class K, class X, class U>
  [[nodiscard]] auto residual(K k, const X& state, const U& input) const noexcept {
    const auto& [x, y, psi, v, epsi, last_steer, last_throttle] = state;
    const auto& [steer, throttle] = input;
    const auto is_change = select(solver::stage_number(k) > 0.0, 1.0, 0.0);
    return std::make_tuple(next_lateral_error(state) * root[0], epsi * root[1],
                           (v - speed_reference) * root[2], steer * root[3], throttle * root[4],
                           is_change * root[5] * (steer - last_steer),
                           is_change * root[6] * (throttle - last_throttle), v * steer * root[7]);
  }

  /// The end, and cte of the beginning, which is given.
  template <class X>
  [[nodiscard]] auto terminal_residual(const X& state) const noexcept {
    const auto& [x, y, psi, v, epsi, last_steer, last_throttle] = state;
    return std::make_tuple(first_lateral_error * root[0], epsi * root[1], (v - speed_reference) * root[2]);
  }

  /// Equation 5: cte of the stage after this one [m].
  template <class X>
  [[nodiscard]] auto next_lateral_error(const X& state) const noexcept {
    return model().next_lateral_error(state);
  }

  [[nodiscard]] Input input_lower(int) const noexcept { return {-steer_limit, -1.0}; }
  [[nodiscard]] Input input_upper(int) const noexcept { return {steer_limit, 1.0}; }

  double dt;              ///< [s]
  double turn_per_metre;  ///< ±1 / L_f: + for steering positive left, − for the simulator's own sign [1/m]
  double steer_limit;     ///< [rad]
  double speed_unit;      ///< the model's v for 1 m/s
  double speed_reference;        ///< as the model's v
  double error_sign;             ///< DescribedModel; −1 in the write-up of `measured-latency`
  double heading_reach;          ///< DescribedModel; 0 in the write-up of `measured-latency`
  bool is_lateral_recursive;     ///< the same write-up's cte⁺ = cte + v sin eψ dt; pre: heading_reach is 0
  bool acts_late;                ///< the inputs of a stage act in the next one
  std::array<double, kNr> root;  ///< √(2 weight) of: cte, eψ, v, δ, a, Δδ, Δa, v δ
  Cubic line;                    ///< reference, renewed in every step
  double first_lateral_error = 0.0;  ///< cte where the horizon begins, renewed in every step [m]

  /// Renews the line, cte at its beginning, and, in the recursive form, the line's tangent there.
  void follow(const Cubic& seen) noexcept {
    line = seen;
    first_lateral_error = line.at(0.0);
    if (!is_lateral_recursive) return;
    const double slope = line.slope(0.0);
    const double cosine = 1.0 / hypot(1.0, slope);  // of eψ_0 = −arctan f′(0)
    lateral_by_x_ = -error_sign * slope * cosine;
    lateral_by_y_ = error_sign * cosine;
  }

 private:
  [[nodiscard]] CHICANE_INLINE DescribedModel<Cubic> model() const noexcept {
    return {.line = line,
            .dt = dt,
            .turn_per_length = turn_per_metre * dt,
            .error_sign = error_sign,
            .heading_reach = heading_reach,
            .lateral_reach = is_lateral_recursive ? 0.0 : 1.0,
            .lateral_by_x = lateral_by_x_,
            .lateral_by_y = lateral_by_y_};
  }
  /// The input that drives a stage: its own, or inside the model that of the stage before (equation 13).
  template <class Last, class Own>
  [[nodiscard]] auto acting(const Last& last, const Own& own) const noexcept {
    const double late = acts_late ? 1.0 : 0.0;
    return own * (1.0 - late) + last * late;
  }
  static double weight_root(double weight) noexcept { return sqrt(2.0 * weight); }

  double lateral_by_x_ = 0.0, lateral_by_y_ = -1.0;  ///< of DescribedModel
};

}  // namespace chicane::controller
