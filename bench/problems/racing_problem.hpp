// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <tuple>

#include "chicane/base/math.hpp"
#include "chicane/solver/problem.hpp"

namespace chicane::bench {

/// A racing problem in the solver's structured form: a single track with saturating tyres in coordinates
/// along a road, steered and driven by rates, with a differential moment as third input; soft edges of the
/// track and soft limits of what each axle can carry.
///
/// State: s [m], n [m] to the left, heading error [rad], v_x, v_y [m/s], r [rad/s], δ [rad], a [m/s²], and
/// the moment before [rad/s²]. Input: rate of δ [rad/s], rate of a [m/s³], moment [rad/s²].
struct RacingProblem {
  static constexpr int kNx = 9;
  static constexpr int kNu = 3;
  static constexpr int kNr = 7;
  static constexpr int kNe = 3;
  static constexpr int kNc = 4;
  static constexpr bool kRealTime = true;
  static constexpr std::size_t kCapacity = 60;
  static constexpr double kStep = 0.05;
  static constexpr double kFront = 1.2, kRear = 1.4;        ///< axles from the centre of mass [m]
  static constexpr double kStiffness = 10.0, kGrip = 10.0;  ///< of the tyre curve, and its peak [m/s²]
  static constexpr double kInertia = 1.5;                   ///< yaw inertia over mass [m²]

  solver::StageData<kCapacity> curvature;  ///< of the road [1/m]
  double speed = 30.0;                     ///< wanted [m/s]
  double half_width = 4.0;                 ///< of the track, for the centre of mass [m]

  template <class K, class X, class U>
  auto dynamics(K k, const X& x, const U& u) const {
    const auto& [s, n, e, vx, vy, r, delta, a, last_moment] = x;
    const auto& [delta_rate, a_rate, moment] = u;
    const auto kappa = curvature.at(k);
    const auto front = front_force(x);
    const auto rear = rear_force(x);
    const auto ds = (vx * cos(e) - vy * sin(e)) / (1.0 - n * kappa);
    return std::make_tuple(s + kStep * ds, n + kStep * (vx * sin(e) + vy * cos(e)),
                           e + kStep * (r - kappa * ds), vx + kStep * (a + r * vy - front * delta),
                           vy + kStep * (front + rear - r * vx),
                           r + kStep * ((kFront * front - kRear * rear) * (1.0 / kInertia) + moment),
                           delta + kStep * delta_rate, a + kStep * a_rate, moment);
  }
  template <class K, class X, class U>
  auto residual(K, const X& x, const U& u) const {
    const auto& [s, n, e, vx, vy, r, delta, a, last_moment] = x;
    const auto& [delta_rate, a_rate, moment] = u;
    return std::make_tuple(0.3 * (vx - speed), 0.1 * n, 0.3 * e, 1.0 * delta_rate, 0.02 * a_rate,
                           0.3 * moment, 0.5 * (moment - last_moment));
  }
  template <class X>
  auto terminal_residual(const X& x) const {
    const auto& [s, n, e, vx, vy, r, delta, a, last_moment] = x;
    return std::make_tuple(1.0 * (vx - speed), 0.5 * n, 2.0 * e);
  }
  /// Edges [m], and the share of its grip that an axle uses beyond all of it.
  template <class K, class X, class U>
  auto constraint(K, const X& x, const U&) const {
    const auto& [s, n, e, vx, vy, r, delta, a, last_moment] = x;
    const auto along = a * (1.0 / kGrip);
    const auto front = front_force(x) * (2.0 / kGrip);
    const auto rear = rear_force(x) * (2.0 / kGrip);
    return std::make_tuple(n - half_width, -half_width - n, front * front + along * along - 1.0,
                           rear * rear + along * along - 1.0);
  }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int c) const {
    return c < 2 ? solver::SoftPenalty{.linear = 100.0, .quadratic = 100.0}
                 : solver::SoftPenalty{.linear = 20.0, .quadratic = 20.0};
  }
  [[nodiscard]] static std::string_view constraint_name(int c) {
    constexpr std::array<std::string_view, 4> names{"left edge", "right edge", "front grip", "rear grip"};
    return names[static_cast<std::size_t>(c)];
  }
  [[nodiscard]] static std::string_view constraint_unit(int c) { return c < 2 ? "m" : ""; }
  [[nodiscard]] std::array<double, kNu> input_lower(int) const { return {-1.0, -40.0, -2.0}; }
  [[nodiscard]] std::array<double, kNu> input_upper(int) const { return {1.0, 40.0, 2.0}; }

 private:
  template <class X>
  static auto front_force(const X& x) {
    const auto& [s, n, e, vx, vy, r, delta, a, last_moment] = x;
    return 0.5 * kGrip * sin(1.4 * atan(kStiffness * (delta - (vy + kFront * r) / vx)));
  }
  template <class X>
  static auto rear_force(const X& x) {
    const auto& [s, n, e, vx, vy, r, delta, a, last_moment] = x;
    return 0.5 * kGrip * sin(1.4 * atan(-kStiffness * ((vy - kRear * r) / vx)));
  }
};

/// A bend of 60 m after a straight, entered at 25 m/s.
inline RacingProblem sample_racing_problem(double bend) {
  RacingProblem problem;
  for (std::size_t k = 0; k < RacingProblem::kCapacity; ++k) problem.curvature[k] = k < 15 ? 0.0 : bend;
  return problem;
}
inline constexpr std::array<double, RacingProblem::kNx> kRacingStart{0.0, 0.5, 0.0, 25.0, 0.0,
                                                                     0.0, 0.0, 0.0, 0.0};

}  // namespace chicane::bench
