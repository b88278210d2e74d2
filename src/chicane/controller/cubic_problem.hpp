// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <tuple>

#include "chicane/base/compiler.hpp"
#include "chicane/base/math.hpp"
#include "chicane/base/vec2.hpp"
#include "chicane/controller/cubic_mpc.hpp"
#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/solver/problem.hpp"

namespace chicane::controller {

/// The line ahead in the car's frame (x forward, y left): y = f(x) = c0 + c1 x + c2 x² + c3 x³ [m]. `Real`: a
/// number, or a pack of several lines'.
template <class Real>
struct CubicOver {
  std::array<Real, 4> c{};

  template <class T>
  [[nodiscard]] auto at(const T& x) const {
    return c[0] + x * (c[1] + x * (c[2] + x * c[3]));
  }
  /// f'(x) = dy/dx, the tangent of the line's heading.
  template <class T>
  [[nodiscard]] auto slope(const T& x) const {
    return c[1] + x * (2.0 * c[2] + x * (3.0 * c[3]));
  }
};
using Cubic = CubicOver<double>;

/// Points in a car's frame; fixed memory.
struct LocalPoints {
  int count = 0;
  std::array<Vec2, model::Measurement::kMaxWaypoints> points{};  ///< [m]

  [[nodiscard]] std::span<const Vec2> view() const noexcept {
    return {points.data(), static_cast<std::size_t>(count)};
  }
};

/// The measured waypoints seen from `car`, by a rotation: p = R(−ψ) (w − o). Skips points that are not
/// finite.
[[nodiscard]] LocalPoints to_car_frame(const model::Measurement& now, const model::Pose& car) noexcept;

/// The same by radius and angle: r = |w − o|, θ = atan2(w − o) − ψ, p = r (cos θ, sin θ). Equal up to
/// rounding.
[[nodiscard]] LocalPoints to_car_frame_polar(const model::Measurement& now, const model::Pose& car) noexcept;

/// Least-squares polynomial of `order` (1 to 3) through points by Householder QR. Higher powers that the
/// points do not determine (fewer than four different x) get coefficient 0. False, and `fit` unchanged, for
/// fewer than two points, or less than 1 mm of extent along x. Pre: finite points, at most LocalPoints'
/// capacity.
[[nodiscard]] bool fit_cubic(std::span<const Vec2> points, Cubic& fit, int order = 3) noexcept;

/// The model of the five write-ups (docs/the_five_systems.md, equations 1 to 6): a kinematic bicycle by
/// forward Euler beside a line y = f(x), in the car's frame. State x, y [m], ψ [rad], v [m/s], eψ [rad], and
/// the inputs of the stage before; input δ [rad], a [m/s²]. The type of the states is the solver's: numbers,
/// jets, or packs of either. A Line has at(x) [m] and slope(x).
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

/// x and y alone move on (docs/the_five_systems.md, equation 14).
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
  /// `speed_unit`: speed that the formula treats as 1 m/s; `has_term`: equation 16 includes its last term.
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
  /// Latency that the last predict() compensated [s]; 0 without roll-forward.
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

/// The optimal control problem of the five write-ups (docs/the_five_systems.md, equations 1 to 13), in the
/// car's frame and the solver's structured form (solver/problem.hpp):
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
  double speed_reference;        ///< reference speed in the model's unit
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
    const double cosine = 1.0 / hypot(1.0, slope);  // cosine of eψ_0 = −arctan f′(0)
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
  /// Input that drives a stage: its own, or with the latency inside the model the previous stage's (equation
  /// 13).
  template <class Last, class Own>
  [[nodiscard]] auto acting(const Last& last, const Own& own) const noexcept {
    const double late = acts_late ? 1.0 : 0.0;
    return own * (1.0 - late) + last * late;
  }
  static double weight_root(double weight) noexcept { return sqrt(2.0 * weight); }

  double lateral_by_x_ = 0.0, lateral_by_y_ = -1.0;  ///< terms of DescribedModel
};

}  // namespace chicane::controller
