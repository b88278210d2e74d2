// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "chicane/base/math.hpp"
#include "chicane/controller/prediction.hpp"

namespace chicane::controller {

/// The optimal control problem of the default controller (docs/tracking.md, eq. 15–24): the prediction model
/// in coordinates along a reference line, squares of what should be small, one-sided squares of what must not
/// be exceeded.
///
/// State x = (s, d, e, v_x, v_y, r, δ, a): arc length from the start [m], offset to the left [m], heading
/// error [rad], body velocity [m/s], yaw rate [rad/s], road-wheel angle [rad], net acceleration [m/s²]. Input
/// u = (δ, a) as asked.
struct TrackingProblem {
  static constexpr int kNx = 8;
  static constexpr int kNu = 2;
  static constexpr int kNr = 11;
  static constexpr int kNe = 4;
  static constexpr int kNc = 0;
  static constexpr int kCapacity = 100;

  enum StateIndex { kS, kD, kE, kVx, kVy, kR, kSteer, kAcceleration };

  /// What the road asks at one stage, linear in arc length around `s`.
  struct Stage {
    double s = 0.0;                 ///< where it was taken [m from the start]
    double curvature = 0.0;         ///< [1/m]
    double curvature_slope = 0.0;   ///< [1/m²]
    double speed = 0.0;             ///< wanted [m/s]
    double speed_slope = 0.0;       ///< [1/s]
    double left = 0.0;              ///< room for the centre of mass to the left of the line [m]
    double right = 0.0;             ///< to the right [m]
    double acceleration_min = 0.0;  ///< [m/s²]
    double acceleration_max = 0.0;
  };

  /// Square roots of the prices.
  struct RootWeights {
    double lateral, heading, speed, steer_rate, jerk, edge, slip, excess_steer_rate, friction;
  };

  const PredictionModel* model = nullptr;
  double dt = 0.05;        ///< length of every stage but the first [s]
  double first_dt = 0.05;  ///< of the first: its command is held until the next one comes [s]; >= dt
  int horizon = 0;
  RootWeights weight{};
  std::array<Stage, kCapacity + 1> stages{};

  template <class T>
  [[nodiscard]] static BodyMotion<T> body(const std::array<T, kNx>& x) noexcept {
    return {x[kVx], x[kVy], x[kR], x[kSteer], x[kAcceleration]};
  }

  template <class T>
  [[nodiscard]] T curvature(int k, const T& s) const noexcept {
    const Stage& stage = stages[static_cast<std::size_t>(k)];
    return stage.curvature + stage.curvature_slope * (s - stage.s);
  }

  /// Length of stage k, and the time from the start to its beginning [s].
  [[nodiscard]] double length(int k) const noexcept { return k == 0 ? first_dt : dt; }
  [[nodiscard]] double time(int k) const noexcept { return k == 0 ? 0.0 : first_dt + (k - 1) * dt; }

  template <class T>
  [[nodiscard]] std::array<T, kNx> dynamics(int k, const std::array<T, kNx>& x,
                                            const std::array<T, kNu>& u) const noexcept {
    // A long first stage is integrated in parts, none much longer than dt.
    const int parts = k == 0 ? static_cast<int>(first_dt / dt + 0.75) : 1;
    std::array<T, kNx> to = move(k, x, u, length(k) / parts);
    for (int part = 1; part < parts; ++part) to = move(k, to, u, length(k) / parts);
    return to;
  }

  template <class T>
  [[nodiscard]] std::array<T, kNr> residual(int k, const std::array<T, kNx>& x,
                                            const std::array<T, kNu>& u) const noexcept {
    const Stage& stage = stages[static_cast<std::size_t>(k)];
    const T rate = (u[0] - x[kSteer]) * (1.0 / length(k));
    const std::array<T, 2> use = model->tire_use(body(x));
    const model::VehicleParams& car = model->vehicle();
    // Share of the friction ellipse, for tyres that have one: asked longitudinal over load, and lateral use.
    const T load = car.load_constant + car.load_per_speed * x[kVx];
    const T along = (car.friction_coupling / car.friction) * u[1] / load;
    const T ellipse = along * along + 0.5 * (use[0] * use[0] + use[1] * use[1]);
    return {weight.lateral * x[kD],
            weight.heading * x[kE],
            weight.speed * (x[kVx] - (stage.speed + stage.speed_slope * (x[kS] - stage.s))),
            weight.steer_rate * rate,
            (weight.jerk / length(k)) * (u[1] - x[kAcceleration]),
            weight.edge * excess(x[kD], stage.left),
            weight.edge * excess(-x[kD], stage.right),
            weight.slip * excess(abs(use[0]), kUsefulTireUse),
            weight.slip * excess(abs(use[1]), kUsefulTireUse),
            weight.excess_steer_rate * excess(abs(rate), car.steer_rate_limit),
            car.friction_coupling > 0.0 ? weight.friction * excess(ellipse, 1.0) : T(0.0)};
  }

  template <class T>
  [[nodiscard]] std::array<T, kNe> terminal_residual(const std::array<T, kNx>& x) const noexcept {
    const Stage& stage = stages[static_cast<std::size_t>(horizon)];
    constexpr double kEndFactor =
        3.0;  // the end stands for what follows: the square root of about ten stages
    return {kEndFactor * weight.lateral * x[kD], kEndFactor * weight.heading * x[kE],
            kEndFactor * weight.speed * (x[kVx] - (stage.speed + stage.speed_slope * (x[kS] - stage.s))),
            kEndFactor * weight.heading * 0.3 * (x[kR] - stage.curvature * x[kVx])};
  }

  template <class T>
  [[nodiscard]] std::array<T, kNc> constraint(int, const std::array<T, kNx>&,
                                              const std::array<T, kNu>&) const noexcept {
    return {};
  }

  [[nodiscard]] std::array<double, kNu> input_lower(int k) const noexcept {
    return {-model->vehicle().steer_limit, stages[static_cast<std::size_t>(k)].acceleration_min};
  }
  [[nodiscard]] std::array<double, kNu> input_upper(int k) const noexcept {
    return {model->vehicle().steer_limit, stages[static_cast<std::size_t>(k)].acceleration_max};
  }

 private:
  /// Motion over h [s] in coordinates along the line (eq. 15).
  template <class T>
  [[nodiscard]] std::array<T, kNx> move(int k, const std::array<T, kNx>& x, const std::array<T, kNu>& u,
                                        double h) const noexcept {
    const BodyMotion<T> to = model->advance(body(x), u[0], u[1], h);
    // Means over the interval carry the car along the line: second order in h.
    const T vx = 0.5 * (x[kVx] + to.vx);
    const T vy = 0.5 * (x[kVy] + to.vy);
    const T yaw = (0.5 * h) * (x[kR] + to.r);
    const T kappa = curvature(k, x[kS] + (0.5 * h) * x[kVx]);
    const T scale = 1.0 / (1.0 - kappa * x[kD]);
    const T half = x[kE] + 0.5 * yaw - (0.5 * h) * vx * kappa;
    const T c = cos(half);
    const T sn = sin(half);
    const T ds = h * (vx * c - vy * sn) * scale;
    return {x[kS] + ds,
            x[kD] + h * (vx * sn + vy * c),
            x[kE] + yaw - kappa * ds,
            to.vx,
            to.vy,
            to.r,
            to.steer,
            to.acceleration};
  }

  static constexpr double kUsefulTireUse = 1.0;  ///< slip beyond this gives hardly more force

  /// max(0, value − limit)
  template <class T>
  static T excess(const T& value, double limit) noexcept {
    return value_of(value) > limit ? value - limit : T(0.0);
  }
};

}  // namespace chicane::controller
