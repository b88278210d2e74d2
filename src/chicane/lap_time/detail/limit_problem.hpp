// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <tuple>

#include "chicane/base/inlining.hpp"
#include "chicane/base/jet.hpp"
#include "chicane/base/math.hpp"
#include "chicane/lap_time/detail/limit_car.hpp"
#include "chicane/solver/problem.hpp"
#include "chicane/solver/stage_data.hpp"

namespace chicane::lap_time {

/// The minimum-time problem along a road (docs/limit.md, eq. Q7–Q14), in the solver's structured form. Stage
/// k is a piece of the reference line of length `step`; how long it takes is a function of the state.
///
/// State x = (n, χ, v, κ, a): offset to the left [m], course against the line [rad], speed [m/s], curvature
/// of the path [1/m], drive or brake force over mass [m/s²]. Input u: the changes of κ and a along the path,
/// in units of kCurvatureSlope and kForceSlope, beside a feedback to the line `centre` (eq. 18): corner after
/// corner amplifies an error of a line driven blindly, and with it every rounding of the solver's adjoint.
struct LimitProblem {
  static constexpr int kNx = 5;
  static constexpr int kNu = 2;
  static constexpr int kNr = 9;
  static constexpr int kNe = 1;
  static constexpr int kNc = 18;
  static constexpr int kCapacity = 8192;
  static constexpr bool kRealTime = true;

  enum StateIndex { kN, kCourse, kSpeed, kCurvature, kForce };

  using State = std::array<double, kNx>;
  using Input = std::array<double, kNu>;
  using Data = solver::StageData<kCapacity + 1>;

  static constexpr double kCurvatureSlope = 0.02;  ///< [1/m²]
  static constexpr double kForceSlope = 1.0;       ///< [1/s²]

  /// The road at a stage: how far to the left and right of the line the middle of an axle may be [m].
  struct Road {
    Data curvature;  ///< in the middle of the stage [1/m]
    Data front_left, front_right, rear_left, rear_right;
  };
  /// Square roots of the prices for leaving a solution before (eq. 17).
  struct Nearness {
    double n = 0.0, course = 0.0, speed = 0.0, curvature = 0.0, force = 0.0, bend = 0.0;
  };

  LimitCar car;
  int horizon = 0;
  double step = 2.0;                   ///< length of a stage along the line [m]
  double root_curvature_price = 0.01;  ///< of a change of curvature [√s]
  double root_force_price = 0.005;     ///< of a change of force [√s]
  double constraint_price = 0.05;      ///< [s] for each unit of violation and stage
  Road road;
  Nearness near;
  struct Centre {
    Data n, course, speed, curvature, force, bend;
  } centre;
  struct Feedback {
    double n = 0.2, course = 2.5, curvature = 12.5, speed = 0.25, force = 0.25;
  } feedback;

  /// Changes of κ and a over stage k, feedback included.
  template <class K, class X, class U>
  [[nodiscard]] CHICANE_INLINE inline auto changes(K k, const X& x, const U& u) const noexcept {
    const auto& [n, course, v, kappa, force] = x;
    const auto& [bend, push] = u;
    return std::make_pair(
        bend - feedback.n * (n - centre.n.at(k)) - feedback.course * (course - centre.course.at(k)) -
            feedback.curvature * (kappa - centre.curvature.at(k)),
        push - feedback.speed * (v - centre.speed.at(k)) - feedback.force * (force - centre.force.at(k)));
  }
  /// Path over stage k: its length [m], and course and offset in its middle.
  template <class K, class X>
  [[nodiscard]] CHICANE_INLINE inline auto path(K k, const X& x) const noexcept {
    const auto& [n, course, v, kappa, force] = x;
    const auto middle = course + (0.5 * step) * (kappa - road.curvature.at(k));
    const auto offset = n + (0.5 * step) * sin(course);
    const auto length = step * (1.0 - road.curvature.at(k) * offset) / cos(middle);
    return std::make_pair(length, middle);
  }
  /// Time over a stage whose path has this length [s].
  template <class X, class L>
  [[nodiscard]] CHICANE_INLINE inline auto duration(const X& x, const L& length) const noexcept {
    const auto& [n, course, v, kappa, force] = x;
    return length / (v + length * ((0.5 * (force - car.drag(v))) / v));
  }
  [[nodiscard]] double time(int k, const State& x) const noexcept { return duration(x, path(k, x).first); }

  template <class K, class X, class U>
  [[nodiscard]] CHICANE_INLINE inline auto dynamics(K k, const X& x, const U& u) const noexcept {
    const auto& [n, course, v, kappa, force] = x;
    const auto [bend, push] = changes(k, x, u);
    const auto [length, middle] = path(k, x);
    const auto d_kappa = (kCurvatureSlope * bend) * length;
    const auto d_force = (kForceSlope * push) * length;
    const auto v2 = v * v;
    const auto lateral = v2 * kappa;
    const auto net = force - car.drag(v) - car.slip_drag * (lateral * lateral) / car.load(v);
    const auto square = v2 + (2.0 * length) * (net + 0.5 * d_force);
    return std::make_tuple(n + length * sin(middle),
                           course + length * (kappa + 0.5 * d_kappa) - step * road.curvature.at(k),
                           sqrt(max(square, kLeastSquare)), kappa + d_kappa, force + d_force);
  }

  template <class K, class X, class U>
  [[nodiscard]] CHICANE_INLINE inline auto residual(K k, const X& x, const U& u) const noexcept {
    const auto& [n, course, v, kappa, force] = x;
    const auto [bend, push] = changes(k, x, u);
    return std::make_tuple(
        sqrt(2.0 * duration(x, path(k, x).first)), root_curvature_price * bend, root_force_price * push,
        near.n * (n - centre.n.at(k)), near.course * (course - centre.course.at(k)),
        near.speed * (v - centre.speed.at(k)), near.curvature * (kappa - centre.curvature.at(k)),
        near.force * (force - centre.force.at(k)), near.bend * (bend - centre.bend.at(k)));
  }

  template <class X>
  [[nodiscard]] auto terminal_residual(const X& x) const noexcept {
    return std::make_tuple(1e-3 * std::get<kCourse>(x));
  }

  template <class K, class X, class U>
  [[nodiscard]] CHICANE_INLINE inline auto constraint(K k, const X& x, const U& u) const noexcept {
    const auto& [n, course, v, kappa, force] = x;
    const auto bend = changes(k, x, u).first;
    const auto v2 = v * v;
    const auto lean = course + kappa * (car.slip_heading * v2 / car.load(v) - car.rear_axle);
    const auto nose = n + car.front_axle * lean;
    const auto tail = n - car.rear_axle * lean;
    const auto per_grip = 1.0 / car.grip(v);
    const auto along = force * per_grip;
    const auto share = select(force < 0.0, car.brake_front, car.drive_front);
    const auto side = select(force < 0.0, 0.0, 1.0) * abs(v2 * kappa);
    const auto in_front =
        (car.front_part * share) * along /
        (((1.0 - car.front_shift * force) * (1.0 + (car.sensitivity * car.front_shift) * force)) *
         (1.0 - car.front_roll * side));
    const auto in_rear =
        (car.rear_part * (1.0 - share)) * along /
        (((1.0 + car.rear_shift * force) * (1.0 - (car.sensitivity * car.rear_shift) * force)) *
         (1.0 - car.rear_roll * side));
    const auto taken = car.coupling * (in_front * in_front);
    const auto taken_rear = car.coupling * (in_rear * in_rear);
    const auto reach = v2 * per_grip;
    const auto front =
        reach * (car.stay * kappa + (car.front_turn * kCurvatureSlope) * bend) /
        ((1.0 - car.front_shift * force) * (1.0 + (car.sensitivity * car.front_shift) * force));
    const auto rear = reach * (car.stay * kappa - (car.rear_turn * kCurvatureSlope) * bend) /
                      ((1.0 + car.rear_shift * force) * (1.0 - (car.sensitivity * car.rear_shift) * force));
    const auto steer = (kCurvatureSlope / car.curvature_rate) * (bend * v);
    const double per_lock = 1.0 / car.curvature_limit;
    return std::make_tuple(nose - road.front_left.at(k), road.front_right.at(k) - nose,
                           tail - road.rear_left.at(k), road.rear_right.at(k) - tail,
                           (1.0 / car.drive) * force - 1.0, (1.0 / car.power) * (force * v) - 1.0,
                           (-1.0 / car.brake) * force - 1.0, -1.0 * along - 1.0, front * front + taken - 1.0,
                           rear * rear + taken_rear - 1.0, front - 1.0, -1.0 * front - 1.0, rear - 1.0,
                           -1.0 * rear - 1.0, steer - 1.0, -1.0 * steer - 1.0,
                           (per_lock * per_lock) * (kappa * kappa) - 1.0, 1.0 - (1.0 / kLowestSpeed) * v);
  }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const noexcept {
    return {.linear = constraint_price, .quadratic = 10.0};
  }

  [[nodiscard]] Input input_lower(int) const noexcept { return {-kMostBend, -kMostPush}; }
  [[nodiscard]] Input input_upper(int) const noexcept { return {kMostBend, kMostPush}; }

 private:
  static constexpr double kLowestSpeed = 2.0;  ///< [m/s]
  static constexpr double kLeastSquare = 1.0;  ///< of a speed [m²/s²]
  static constexpr double kMostBend = 8.0;     ///< [kCurvatureSlope]
  static constexpr double kMostPush = 20.0;    ///< [kForceSlope]
};

}  // namespace chicane::lap_time
