// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include "chicane/base/math.hpp"
#include "chicane/controller/cubic_problem.hpp"

namespace chicane::controller {

/// CubicProblem as it is written down, cte among the states and derivatives dense: what the structured form
/// must agree with. State x, y, ψ, v, cte, eψ, δ⁻, a⁻.
struct DenseCubicProblem {
  static constexpr int kNx = 8;
  static constexpr int kNu = 2;
  static constexpr int kNr = 8;
  static constexpr int kNe = 3;
  static constexpr int kNc = 0;
  static constexpr bool kRealTime = true;
  enum StateIndex : std::size_t { kX, kY, kPsi, kV, kCte, kEpsi, kLastSteer, kLastThrottle };
  enum InputIndex : std::size_t { kSteer, kThrottle };
  template <class T>
  using States = std::array<T, kNx>;
  template <class T>
  using Inputs = std::array<T, kNu>;

  explicit DenseCubicProblem(const CubicProblem& structured) noexcept
      : dt{structured.dt},
        turn_per_metre{structured.turn_per_metre},
        steer_limit{structured.steer_limit},
        speed_reference{structured.speed_reference},
        error_sign{structured.error_sign},
        is_integrated{structured.heading_reach == 0.0},
        is_lateral_recursive{structured.is_lateral_recursive},
        acts_late{structured.acts_late},
        root{structured.root},
        line{structured.line} {}

  [[nodiscard]] static States<double> with_lateral_error(const CubicProblem::State& x, double cte) {
    return {x[0], x[1], x[2], x[3], cte, x[4], x[5], x[6]};
  }

  /// Equations 1 to 6: forward Euler, with the described recursions of both errors.
  template <class T>
  [[nodiscard]] States<T> dynamics(int, const States<T>& x, const Inputs<T>& u) const {
    const T steer = acts_late ? x[kLastSteer] : u[kSteer];
    const T throttle = acts_late ? x[kLastThrottle] : u[kThrottle];
    const T turn = x[kV] * steer * (turn_per_metre * dt);
    return {
        x[kX] + x[kV] * cos(x[kPsi]) * dt,
        x[kY] + x[kV] * sin(x[kPsi]) * dt,
        x[kPsi] + turn,
        x[kV] + throttle * dt,
        (is_lateral_recursive ? x[kCte] : line.at(x[kX]) - x[kY]) + x[kV] * sin(x[kEpsi]) * (error_sign * dt),
        (is_integrated ? x[kEpsi] : x[kPsi] - atan(line.slope(x[kX]))) + turn,
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

  double dt;
  double turn_per_metre;
  double steer_limit;
  double speed_reference;
  double error_sign;
  bool is_integrated;         ///< the heading error, from step to step
  bool is_lateral_recursive;  ///< the lateral error, from step to step
  bool acts_late;
  std::array<double, kNr> root;
  Cubic line;
};

}  // namespace chicane::controller
