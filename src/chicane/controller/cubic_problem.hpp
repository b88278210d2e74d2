// SPDX-License-Identifier: MIT
// The model and the optimal control problem of the five write-ups (docs/the_five_systems.md), the fit of
// their line, and their roll-forward over the latency.
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

/// Line ahead in the car's frame (x forward, y left): y = f(x) = c0 + c1 x + c2 x² + c3 x³ [m]. `Real`: a
/// number, or a pack of numbers for several lines.
template <class Real>
struct CubicOver {
  std::array<Real, 4> c{};  ///< c0 … c3

  /// f(x) [m].
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
  int count = 0;                                                 ///< number of points
  std::array<Vec2, model::Measurement::kMaxWaypoints> points{};  ///< [m]

  [[nodiscard]] std::span<const Vec2> view() const noexcept {
    return {points.data(), static_cast<std::size_t>(count)};
  }
};

/// Measured waypoints in the frame of `car` by a rotation: p = R(−ψ) (w − o). Skips points that are not
/// finite.
[[nodiscard]] LocalPoints to_car_frame(const model::Measurement& now, const model::Pose& car) noexcept;

/// Measured waypoints in the frame of `car` by radius and angle: r = |w − o|, θ = atan2(w − o) − ψ,
/// p = r (cos θ, sin θ). Equal to to_car_frame() up to rounding.
[[nodiscard]] LocalPoints to_car_frame_polar(const model::Measurement& now, const model::Pose& car) noexcept;

/// Fits a polynomial of `order` (1 to 3) to points by least squares with Householder QR. Powers that the
/// points do not determine (fewer than four different x) get the coefficient 0. False, and `fit` unchanged,
/// for fewer than two points, or points within 1 mm along x. Pre: finite points, at most as many as
/// LocalPoints holds.
[[nodiscard]] bool fit_cubic(std::span<const Vec2> points, Cubic& fit, int order = 3) noexcept;

/// The model of the five write-ups (docs/the_five_systems.md, equations 1 to 6): a kinematic bicycle by
/// forward Euler beside a line y = f(x), in the car's frame. State x, y [m], ψ [rad], v [m/s], eψ [rad], and
/// the inputs of the stage before; input δ [rad], a [m/s²]. States are tuples of what the solver works with:
/// numbers, jets, or packs of either. A Line has at(x) [m] and slope(x).
///
/// The write-up of `measured-latency` has both errors in recursive form, cte⁺ = cte + v sin eψ dt and eψ⁺ =
/// eψ + v δ dt / L_f. Since ψ_0 = 0, eψ_k = eψ_0 + ψ_k, and by equations 1 and 2 the sum is exact: cte_k =
/// cte_0 + cos eψ_0 y_k + sin eψ_0 x_k, the distance from the line's tangent at the car. So the recursion
/// needs no state of its own.
template <class Line>
struct DescribedModel {
  const Line& line;        ///< reference
  double dt;               ///< length of a step [s]
  double turn_per_length;  ///< ± dt / L_f: + for steering positive left [s/m]
  /// Sign of the last term of equation 5: 1 for cte = f(x) − y; −1 for y − f(x), as in the write-up of
  /// `measured-latency`.
  double error_sign = 1.0;
  /// Place of the desired yaw in equation 6, over x: 1 for the line's yaw beside the car; 0 for its yaw at x
  /// = 0, so that eψ⁺ = eψ ± v δ dt / L_f from eψ = ψ − arctan f′(0) on, as in the write-up of
  /// `measured-latency`.
  double heading_reach = 1.0;
  /// Coefficients of equation 5: cte = f(lateral_reach x) + lateral_by_x x + lateral_by_y y. 1, 0 and −1 give
  /// f(x) − y. 0 and the slopes of the tangent give the recursive form of the write-up of `measured-latency`.
  double lateral_reach = 1.0;
  double lateral_by_x = 0.0, lateral_by_y = -1.0;

  /// State after one step. `acting`: steering and acceleration that move the car in this step, `input` or
  /// that of the stage before.
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

  /// Equation 5: cte of the next stage [m].
  template <class X>
  [[nodiscard]] CHICANE_INLINE auto next_lateral_error(const X& state) const noexcept {
    const auto& [x, y, psi, v, epsi, last_steer, last_acceleration] = state;
    return line.at(x * lateral_reach) + lateral_by_y * y + lateral_by_x * x +
           v * sin(epsi) * (error_sign * dt);
  }
};

/// Pose and speed of the car.
struct Motion {
  model::Pose pose;    ///< in W
  double speed = 0.0;  ///< along the yaw [m/s]
};

/// Roll-forward of the measured motion over the latency, by LatencyHandling (equations 14 to 16). Keeps a
/// mean of the measured latency, in [0, 0.5] s.
class RollForward {
 public:
  /// `speed_unit`: number that stands for 1 m/s in the equations; `has_term`: equation 16 includes its last
  /// term.
  RollForward(LatencyHandling handling, double latency, double kinematic_length, double speed_unit = 1.0,
              bool has_term = true) noexcept
      : handling_{handling},
        first_latency_{latency},
        latency_{latency},
        kinematic_length_{kinematic_length},
        speed_unit_{speed_unit},
        has_term_{has_term} {}

  /// Motion at the time when the command acts. Pre: finite pose, speed and commands.
  [[nodiscard]] Motion predict(const model::Measurement& now) noexcept;
  /// Latency that the last predict() compensated [s]; 0 without roll-forward.
  [[nodiscard]] double compensated() const noexcept;
  /// Forgets the measured latency.
  void reset() noexcept { latency_ = first_latency_; }
  /// Changes the settings. The measured latency stays unless handling or latency change.
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
  /// Motion after the latency, with speeds in speed_unit_; `seen`: measured motion.
  Motion roll(const model::Measurement& now, const Motion& seen) noexcept;
  /// Whether the measured motion is rolled forward at all.
  [[nodiscard]] bool is_rolled() const noexcept {
    return handling_ != LatencyHandling::kNone && handling_ != LatencyHandling::kInsideModel;
  }

  LatencyHandling handling_;
  double first_latency_;     ///< configured latency [s]
  double latency_;           ///< compensated latency [s]
  double kinematic_length_;  ///< L_f [m]
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
/// cte is no state: equation 5 gives cte of a stage from the stage before, whose residuals contain it.
/// Residuals have the factor √(2 weight), so that the solver's ½‖r‖² is the weighted sum of squares of
/// equation 7.
struct CubicProblem {
  static constexpr int kNx = 7;            ///< states
  static constexpr int kNu = 2;            ///< inputs
  static constexpr int kNr = 8;            ///< residuals of a stage
  static constexpr int kNe = 3;            ///< residuals of the end
  static constexpr int kNc = 0;            ///< hard constraints
  static constexpr int kCapacity = 200;    ///< longest horizon; chosen
  static constexpr bool kRealTime = true;  ///< kind of the solver: no allocation
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

  /// Equations 1 to 4 and 6: next state by forward Euler.
  template <class K, class X, class U>
  [[nodiscard]] auto dynamics(K, const X& state, const U& input) const noexcept {
    const auto& [x, y, psi, v, epsi, last_steer, last_throttle] = state;
    const auto& [steer, throttle] = input;
    return model().next(state, std::make_tuple(acting(last_steer, steer), acting(last_throttle, throttle)),
                        input);
  }

  /// Equation 7: residuals of one stage, with cte of the next one. The first stage has no change of the
  /// inputs, as in the write-ups.
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

  /// Equation 7: residuals of the end, and cte of the first stage, which is given.
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

  double dt;              ///< length of a step [s]
  double turn_per_metre;  ///< ±1 / L_f: + for steering positive left, − for the simulator's own sign [1/m]
  double steer_limit;     ///< [rad]
  double speed_unit;      ///< speed of the model for 1 m/s
  double speed_reference;            ///< reference speed in the model's unit
  double error_sign;                 ///< same as in DescribedModel
  double heading_reach;              ///< same as in DescribedModel
  bool is_lateral_recursive;         ///< cte⁺ = cte + v sin eψ dt; pre: heading_reach is 0
  bool acts_late;                    ///< inputs of a stage act in the next stage
  std::array<double, kNr> root;      ///< √(2 weight) of: cte, eψ, v, δ, a, Δδ, Δa, v δ
  Cubic line;                        ///< reference line of this control step
  double first_lateral_error = 0.0;  ///< cte at the start of the horizon [m]

  /// Sets the line, cte at the car, and for the recursive form the line's tangent at the car.
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
  /// Model of the write-ups with the parameters of this problem.
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
  /// Input that acts in a stage: its own, or with acts_late that of the stage before (equation 13).
  template <class Last, class Own>
  [[nodiscard]] auto acting(const Last& last, const Own& own) const noexcept {
    const double late = acts_late ? 1.0 : 0.0;
    return own * (1.0 - late) + last * late;
  }
  /// Factor of a residual with this weight.
  static double weight_root(double weight) noexcept { return sqrt(2.0 * weight); }

  double lateral_by_x_ = 0.0, lateral_by_y_ = -1.0;  ///< same as in DescribedModel
};

}  // namespace chicane::controller
