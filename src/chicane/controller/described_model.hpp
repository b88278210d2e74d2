// SPDX-License-Identifier: MIT
#pragma once

#include <tuple>

#include "chicane/base/compiler.hpp"
#include "chicane/base/math.hpp"
#include "chicane/controller/cubic_mpc.hpp"
#include "chicane/model/state.hpp"

namespace chicane::controller {

/// The model of the five write-ups (docs/problem.md, equations 1 to 6): a kinematic bicycle by forward Euler
/// beside a line y = f(x), in the car's frame. State x, y [m], ψ [rad], v [m/s], eψ [rad], and the inputs of
/// the stage before; input δ [rad], a [m/s²]. The type of the states is the solver's: numbers, jets, or packs
/// of either. A Line has at(x) [m] and slope(x).
///
/// The write-up of `measured-latency` has both errors in recursive form, cte⁺ = cte + v sin eψ dt and eψ⁺ =
/// eψ + v δ dt / L_f. Since ψ_0 = 0, eψ_k = eψ_0 + ψ_k, and by equations 1 and 2 the sum is exact: cte_k =
/// cte_0 + cos eψ_0 y_k + sin eψ_0 x_k, the distance from the line's tangent at the beginning. So the
/// recursion needs no state.
template <class Line>
struct DescribedModel {
  const Line& line;
  double dt;               ///< [s]
  double turn_per_length;  ///< ± dt / L_f: + for steering positive left [s/m]
  /// Sign of the last term of equation 5. −1: write-up of `measured-latency`, whose cte is y − f(x). 1: the
  /// other four, with f(x) − y.
  double error_sign = 1.0;
  /// Equation 6: 1 where the desired yaw is the line's beside the car. 0, write-up of `measured-latency`: it
  /// is the line's at the beginning, so that from eψ = ψ − arctan f′(0) on eψ⁺ = eψ ± v δ dt / L_f.
  double heading_reach = 1.0;
  /// Equation 5: where cte is read from the line, f(x) − y, these are 1 and (0, −1). In the recursive form of
  /// `measured-latency`'s write-up it is a linear function of the position: 0, and the slopes by x and y.
  double lateral_reach = 1.0;
  double lateral_by_x = 0.0, lateral_by_y = -1.0;

  /// The state after one step, with the described recursion of the heading error. `acting`: the steering and
  /// acceleration that move the car meanwhile, `input` itself or what came before.
  template <class X, class A, class U>
  [[nodiscard]] CHICANE_INLINE auto next(const X& state, const A& acting, const U& input) const noexcept {
    const auto& [x, y, psi, v, epsi, last_steer, last_acceleration] = state;
    const auto& [acting_steer, acting_acceleration] = acting;
    const auto& [steer, acceleration] = input;
    const auto turn = v * acting_steer * turn_per_length;
    return std::make_tuple(x + v * cos(psi) * dt, y + v * sin(psi) * dt, psi + turn,
                           v + acting_acceleration * dt, psi - atan(line.slope(x * heading_reach)) + turn,
                           steer, acceleration);
  }

  /// Equation 5: cte of the stage after this one [m], as f(x) − y.
  template <class X>
  [[nodiscard]] CHICANE_INLINE auto next_lateral_error(const X& state) const noexcept {
    const auto& [x, y, psi, v, epsi, last_steer, last_acceleration] = state;
    return line.at(x * lateral_reach) + lateral_by_y * y + lateral_by_x * x +
           v * sin(epsi) * (error_sign * dt);
  }
};

/// The state of the car by the described model.
struct Motion {
  model::Pose pose;
  double speed = 0.0;  ///< along the yaw [m/s]
};

/// x and y alone move on (docs/problem.md, equation 14).
[[nodiscard]] Motion roll_position(const Motion& from, double latency) noexcept;

/// One Euler step of the kinematic model over the latency (equation 15): ψ += v δ L / L_f, v += a L, with
/// `acting` as δ and, throttle taken for acceleration in m/s², as a.
[[nodiscard]] Motion roll_kinematic(const Motion& from, const model::Command& acting, double latency,
                                    double kinematic_length) noexcept;

/// The form that goes with the measured latency (equation 16): ψ += v tan δ L / L_f + a tan δ L² / (2 L_f).
/// `has_term`: false leaves out the last one, of the acceleration.
[[nodiscard]] Motion roll_accelerating(const Motion& from, const model::Command& acting, double latency,
                                       double kinematic_length, bool has_term = true) noexcept;

/// Chooses among them, and keeps the measured latency. Latency lies in [0, 0.5] s whatever is measured.
class RollForward {
 public:
  /// `speed_unit`: what is taken for 1 m/s on the way; `has_term`: equation 16 with its last term.
  RollForward(LatencyHandling handling, double latency, double kinematic_length, double speed_unit = 1.0,
              bool has_term = true) noexcept
      : handling_{handling},
        first_latency_{latency},
        latency_{latency},
        kinematic_length_{kinematic_length},
        speed_unit_{speed_unit},
        has_term_{has_term} {}

  /// The measured motion at the time the command acts, by the described means. Pre: finite pose, speed and
  /// commands.
  [[nodiscard]] Motion predict(const model::Measurement& now) noexcept;
  /// What the last predict() compensated [s]; 0 when nothing is rolled forward.
  [[nodiscard]] double compensated() const noexcept;
  void reset() noexcept { latency_ = first_latency_; }
  /// Other settings; a measured latency stays measured.
  void configure(LatencyHandling handling, double latency, double kinematic_length, double speed_unit = 1.0,
                 bool has_term = true) noexcept {
    const bool is_other_car = handling != handling_ || latency != first_latency_;
    if (is_other_car) latency_ = latency;
    handling_ = handling;
    first_latency_ = latency;
    kinematic_length_ = kinematic_length;
    speed_unit_ = speed_unit;
    has_term_ = has_term;
  }

 private:
  Motion roll(const model::Measurement& now, const Motion& seen) noexcept;

  LatencyHandling handling_;
  double first_latency_;
  double latency_;
  double kinematic_length_;
  double speed_unit_;
  bool has_term_;
};

}  // namespace chicane::controller
