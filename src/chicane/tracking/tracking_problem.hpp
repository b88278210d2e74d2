// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>

#include "chicane/base/compiler.hpp"
#include "chicane/base/jet.hpp"
#include "chicane/base/math.hpp"
#include "chicane/model/actuator.hpp"
#include "chicane/model/prediction.hpp"
#include "chicane/solver/problem.hpp"
#include "chicane/tracking/state_estimator.hpp"

namespace chicane::tracking {

/// The optimal control problem of the default controller (docs/controller.md, eq. 15–20), in the solver's
/// structured form (solver/problem.hpp): the prediction model in coordinates along a reference line, a sum of
/// squares of errors, and one-sided squares of exceeded limits.
///
/// State x = (s, d, e, v_x, v_y, r, δ, a): arc length from the start [m], offset to the left [m], heading
/// error [rad], body velocity [m/s], yaw rate [rad/s], road-wheel angle [rad], net acceleration [m/s²]. Input
/// u = (δ, a): commanded road-wheel angle [rad] and acceleration [m/s²].
struct TrackingProblem {
  static constexpr int kNx = 8;               ///< states
  static constexpr int kNu = 2;               ///< inputs
  static constexpr int kNr = 11;              ///< residuals of a stage
  static constexpr int kNe = 4;               ///< residuals of the end
  static constexpr int kNc = 0;               ///< constraints of a stage
  static constexpr int kCapacity = 100;       ///< longest horizon [stages]
  static constexpr bool kRealTime = true;     ///< few iterations, no filter method (solver/problem.hpp)
  static constexpr bool kGaussNewton = true;  ///< a step has no time for exact Hessians

  enum StateIndex { kS, kD, kE, kVx, kVy, kR, kSteer, kAcceleration };

  using State = std::array<double, kNx>;
  using Input = std::array<double, kNu>;
  using Data = solver::StageData<kCapacity + 1>;

  /// Reference, limits and disturbance at the stages 0..horizon. Curvature and speed are linear in arc length
  /// around `s`.
  struct Road {
    Data s;                 ///< arc length at which the road was sampled [m from the start]
    Data curvature;         ///< curvature of the line, left positive [1/m]
    Data curvature_slope;   ///< change of the curvature along the line [1/m²]
    Data speed;             ///< wanted speed [m/s]
    Data speed_slope;       ///< change of the wanted speed along the line [1/s]
    Data sideslip;          ///< planned angle from the body's heading to the line's [rad]
    Data left;              ///< room of the nose to the left of the line [m]
    Data right;             ///< room of the nose to the right of the line [m]
    Data tail_left;         ///< room of the tail to the left of the line [m]
    Data tail_right;        ///< room of the tail to the right of the line [m]
    Data acceleration_min;  ///< least commanded acceleration [m/s²]
    Data acceleration_max;  ///< largest commanded acceleration [m/s²]
    Data slide_front;       ///< slip of the front tyres beyond the peak without cost, over the peak's slip
    Data slide_rear;        ///< slip of the rear tyres beyond the peak without cost, over the peak's slip
    Data steadiness;        ///< factor of the root weight on the steering rate, ≥ 1
    Data pushed_vy;         ///< change of v_y over the stage by a disturbance [m/s]
    Data pushed_r;          ///< change of the yaw rate over the stage by a disturbance [rad/s]
  };

  /// Square roots of the weights of the residuals.
  struct RootWeights {
    double lateral, heading, speed, steer_rate, jerk, edge, slip, excess_steer_rate, friction;
  };

  /// Length of a stage, and values derived from it.
  struct Step {
    double length = 0.05;               ///< duration [s]
    model::PredictionModel::Lags lags;  ///< lags of steering and drive over the stage
    /// Share of the difference between commanded and present wheel angle that the wheel turns in the stage.
    double steer_share = 1.0;

    [[nodiscard]] static Step of(const model::PredictionModel& model, double length) noexcept {
      const model::PredictionModel::Lags lags = model.lags(length);
      return {length, lags, 1.0 - lags.steer.end};
    }
    /// Mean rate of the wheel over the stage for a unit difference between command and wheel [1/s].
    [[nodiscard]] double steer_speed() const noexcept { return steer_share / length; }
  };

  const model::PredictionModel* model = nullptr;
  int horizon = 0;  ///< stages, at most kCapacity
  Step first;       ///< step of stage 0: its command is held until the next one arrives
  Step others;      ///< step of all other stages
  RootWeights weight{};
  double nose = 0.0;  ///< distance from the centre of mass forward to the point kept inside the edges [m]
  double tail = 0.0;  ///< distance from the centre of mass back to the point kept inside the edges [m]
  Road road;
  /// Motion of the model over a long first stage in several steps less that in one step, at the first guess
  /// of the input (correct_first()). Zero for a short stage.
  State first_correction{};

  /// Time from the start to stage k [s].
  [[nodiscard]] double time(int k) const noexcept {
    return k == 0 ? 0.0 : first.length + (k - 1) * others.length;
  }
  [[nodiscard]] const Step& step(int k) const noexcept { return k == 0 ? first : others; }

  /// Sets the effect of a disturbance that fades from the start on. Pre: horizon and lengths of stages are
  /// set.
  void push(Disturbance now) noexcept {
    for (int k = 0; k < horizon; ++k) {
      const double length = step(k).length;
      road.pushed_vy[static_cast<std::size_t>(k)] = length * now.lateral;
      road.pushed_r[static_cast<std::size_t>(k)] = length * now.yaw;
      now.fade(length);
    }
  }

  /// State at stage k + 1 for state x and input u at stage k.
  template <class K, class X, class U>
  [[nodiscard]] auto dynamics(K k, const X& x, const U& u) const noexcept {
    const auto is_first = solver::stage_number(k) < 0.5;
    const auto [s, d, e, vx, vy, r, steer, a] = move(k, x, u);
    const State& more = first_correction;
    return std::make_tuple(s + select(is_first, more[kS], 0.0), d + select(is_first, more[kD], 0.0),
                           e + select(is_first, more[kE], 0.0), vx + select(is_first, more[kVx], 0.0),
                           vy + (select(is_first, more[kVy], 0.0) + road.pushed_vy.at(k)),
                           r + (select(is_first, more[kR], 0.0) + road.pushed_r.at(k)), steer, a);
  }

  /// Weighted residuals of stage k (eq. 16–19), whose squares are its cost.
  template <class K, class X, class U>
  [[nodiscard]] auto residual(K k, const X& x, const U& u) const noexcept {
    const auto& [s, d, e, vx, vy, r, steer, a] = x;
    const auto& [steer_command, a_command] = u;
    const auto is_first = solver::stage_number(k) < 0.5;
    const auto per_length = select(is_first, 1.0 / first.length, 1.0 / others.length);
    const auto rate = (steer_command - steer) * select(is_first, first.steer_speed(), others.steer_speed());
    using T = Common<decltype(vx), decltype(vy), decltype(r), decltype(steer), decltype(a)>;
    const auto use = model->tire_use(model::BodyMotion<T>{T(vx), T(vy), T(r), T(steer), T(a)});
    const model::VehicleParams& car = model->vehicle();
    // Offsets of nose and tail from the line, which bends away from the car by curvature · distance² / 2.
    const auto bend = 0.5 * road.curvature.at(k);
    const auto ahead = d + nose * (e - nose * bend);
    const auto behind = d - tail * (e + tail * bend);
    const double friction = car.friction_coupling > 0.0 ? weight.friction : 0.0;
    return std::make_tuple(
        weight.lateral * d, weight.heading * (e + road.sideslip.at(k)),
        weight.speed * (vx - (road.speed.at(k) + road.speed_slope.at(k) * (s - road.s.at(k)))),
        weight.steer_rate * (road.steadiness.at(k) * rate), (weight.jerk * per_length) * (a_command - a),
        weight.edge * positive_part(max(ahead - road.left.at(k), behind - road.tail_left.at(k))),
        weight.edge *
            positive_part(max(-1.0 * ahead - road.right.at(k), -1.0 * behind - road.tail_right.at(k))),
        weight.slip * positive_part(use.front - (1.0 + road.slide_front.at(k))),
        weight.slip * positive_part(use.rear - (1.0 + road.slide_rear.at(k))),
        weight.excess_steer_rate * positive_part(abs(rate) - car.steer_rate_limit),
        friction *
            (positive_part(use.along_front - kUsefulForce) + positive_part(use.along_rear - kUsefulForce)));
  }

  /// Weighted residuals of the state at the horizon, which stand for the way beyond it (eq. 20).
  template <class X>
  [[nodiscard]] auto terminal_residual(const X& x) const noexcept {
    const auto& [s, d, e, vx, vy, r, steer, a] = x;
    constexpr double kEndFactor = 3.0;      // root of about ten stages; chosen
    constexpr double kYawRateFactor = 0.3;  // [s] weight of the yaw rate over that of the heading; chosen
    const double wanted = road.speed.at(horizon);
    return std::make_tuple(
        kEndFactor * weight.lateral * d, kEndFactor * weight.heading * (e + road.sideslip.at(horizon)),
        kEndFactor * weight.speed * (vx - (wanted + road.speed_slope.at(horizon) * (s - road.s.at(horizon)))),
        kEndFactor * weight.heading * kYawRateFactor * (r - road.curvature.at(horizon) * vx));
  }

  /// Lower bounds of the input at stage k.
  [[nodiscard]] Input input_lower(int k) const noexcept {
    return {-model->vehicle().steer_limit, road.acceleration_min.at(k)};
  }
  /// Upper bounds of the input at stage k.
  [[nodiscard]] Input input_upper(int k) const noexcept {
    return {model->vehicle().steer_limit, road.acceleration_max.at(k)};
  }
  /// Input nearest to u within the bounds of stage k.
  [[nodiscard]] Input within_bounds(int k, const Input& u) const noexcept {
    const Input low = input_lower(k);
    const Input high = input_upper(k);
    Input inside{};
    for (std::size_t q = 0; q < u.size(); ++q) inside[q] = std::clamp(u[q], low[q], high[q]);
    return inside;
  }

 private:
  template <class Row>
  static State to_state(const Row& row) noexcept {
    return std::apply([](const auto&... values) { return State{values...}; }, row);
  }

  /// Motion over stage k in one step, with the length and lags of its kind, which may differ between lanes.
  template <class K, class X, class U>
  [[nodiscard]] CHICANE_INLINE inline auto move(K k, const X& x, const U& u) const noexcept {
    const auto is_first = solver::stage_number(k) < 0.5;
    const auto either = [&](double of_first, double of_others)
                            CHICANE_INLINE { return select(is_first, of_first, of_others); };
    using D = decltype(either(0.0, 0.0));
    struct {
      struct {
        D end, mean;
      } steer, drive;
    } const lags{{either(first.lags.steer.end, others.lags.steer.end),
                  either(first.lags.steer.mean, others.lags.steer.mean)},
                 {either(first.lags.drive.end, others.lags.drive.end),
                  either(first.lags.drive.mean, others.lags.drive.mean)}};
    return move_by(either(first.length, others.length), lags, k, x, u);
  }

  /// Motion over h [s] in coordinates along the line (eq. 15).
  template <class D, class Lags, class K, class X, class U>
  [[nodiscard]] CHICANE_INLINE inline auto move_by(const D& h, const Lags& lags, K k, const X& x,
                                                   const U& u) const noexcept {
    const auto& [s, d, e, vx, vy, r, steer, a] = x;
    const auto& [steer_command, a_command] = u;
    const auto late_steer = steer - steer_command;  // what the wheel lacks at first
    const auto late_a = a - a_command;
    using T = Common<decltype(vx), decltype(vy), decltype(r), decltype(steer), decltype(a),
                     decltype(steer_command), decltype(a_command)>;
    const model::BodyMotion<T> from{T(vx), T(vy), T(r), T(steer), T(a)};
    const model::BodyMotion<T> to = model->advance(from, T(steer_command + late_steer * lags.steer.mean),
                                                   T(a_command + late_a * lags.drive.mean), h);
    // Means over the interval carry the car along the line: second order in h.
    const auto mean_vx = 0.5 * (vx + to.vx);
    const auto mean_vy = 0.5 * (vy + to.vy);
    const D half_h = 0.5 * h;
    const auto yaw = half_h * (r + to.r);
    const auto kappa = road.curvature.at(k) + road.curvature_slope.at(k) * (s + half_h * vx - road.s.at(k));
    const auto half = e + 0.5 * yaw - half_h * mean_vx * kappa;
    const auto c = cos(half);
    const auto sn = sin(half);
    const auto ds = h * (mean_vx * c - mean_vy * sn) / (1.0 - kappa * d);
    return std::make_tuple(s + ds, d + h * (mean_vx * sn + mean_vy * c), e + yaw - kappa * ds, to.vx, to.vy,
                           to.r, steer_command + late_steer * lags.steer.end,
                           a_command + late_a * lags.drive.end);
  }

  /// Share of the longitudinal force that costs nothing: the rest keeps the car on its course; chosen.
  static constexpr double kUsefulForce = 0.93;

 public:
  /// Sets first_correction for a first stage from x that is longer than others, at the first guess u of its
  /// input.
  void correct_first(const State& x, const Input& u) noexcept {
    const int parts = static_cast<int>(first.length / others.length + 0.75);
    if (parts < 2) return;
    const State exact = move_in_parts(0, x, u, parts);
    const State rough = move_in_parts(0, x, u, 1);
    for (std::size_t i = 0; i < exact.size(); ++i) first_correction[i] = exact[i] - rough[i];
  }
  /// State after stage k in `parts` equal steps, without first_correction and disturbance.
  [[nodiscard]] State move_in_parts(int k, const State& x, const Input& u, int parts) const noexcept {
    const double h = step(k).length / parts;
    const model::PredictionModel::Lags lags = model->lags(h);
    State to = x;
    for (int i = 0; i < parts; ++i) to = to_state(move_by(h, lags, k, to, u));
    return to;
  }
};

}  // namespace chicane::tracking
