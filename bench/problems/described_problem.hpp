// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <tuple>

#include "chicane/base/compiler.hpp"
#include "chicane/base/math.hpp"
#include "chicane/base/random.hpp"
#include "chicane/controller/cubic_problem.hpp"
#include "chicane/solver/problem.hpp"
#include "chicane/solver/warm_start.hpp"
#include "problems/dual.hpp"

namespace chicane::bench {

/// What both forms of the described problem are given.
struct DescribedData {
  static constexpr double kLength = 2.67;
  static constexpr double kStep = 0.1;

  std::array<double, 4> path{};  ///< cubic, constant term first
  double speed_reference = 0.0;
  double steer_limit = degrees_to_radians(25.0);
  double acceleration_limit = 1.0;

  [[nodiscard]] std::array<double, 2> input_lower(int) const { return {-steer_limit, -acceleration_limit}; }
  [[nodiscard]] std::array<double, 2> input_upper(int) const { return {steer_limit, acceleration_limit}; }

  /// w r² = ½ (√(2w) r)².
  static double weight(double w) { return sqrt(2.0 * w); }
};

/// The optimal control problem of the Udacity MPC project as it is written down: kinematic bicycle by
/// explicit Euler, cubic path in the car's frame, weights 200, 200, 0.1, 1, 1, 10, 1. State (x, y, ψ, v, cte,
/// eψ, previous δ, previous a), input (δ, a). Level 1 of the solver's interface; all solutions are judged by
/// it.
struct DescribedProblem : DescribedData {
  static constexpr int kNx = 8;
  static constexpr int kNu = 2;
  static constexpr int kNr = 7;
  static constexpr int kNe = 3;
  static constexpr int kNc = 0;
  static constexpr bool kRealTime = true;

  template <class K, class T>
  CHICANE_INLINE std::array<T, kNx> dynamics(K, const std::array<T, kNx>& s,
                                             const std::array<T, kNu>& u) const {
    const T f = path[0] + s[0] * (path[1] + s[0] * (path[2] + s[0] * path[3]));
    const T slope = path[1] + s[0] * (2.0 * path[2] + s[0] * (3.0 * path[3]));
    const T turn = s[3] * u[0] * (kStep / kLength);
    return {s[0] + s[3] * cos(s[2]) * kStep,
            s[1] + s[3] * sin(s[2]) * kStep,
            s[2] + turn,
            s[3] + u[1] * kStep,
            f - s[1] + s[3] * sin(s[5]) * kStep,
            s[2] - atan(slope) + turn,
            u[0],
            u[1]};
  }
  template <class K, class T>
  CHICANE_INLINE std::array<T, kNr> residual(K k, const std::array<T, kNx>& s,
                                             const std::array<T, kNu>& u) const {
    const auto change = select(solver::stage_number(k) > 0.0, 1.0, 0.0);
    return {weight(200.0) * s[4],
            weight(200.0) * s[5],
            weight(0.1) * (s[3] - speed_reference),
            weight(1.0) * u[0],
            weight(1.0) * u[1],
            change * weight(10.0) * (u[0] - s[6]),
            change * weight(1.0) * (u[1] - s[7])};
  }
  template <class T>
  CHICANE_INLINE std::array<T, kNe> terminal_residual(const std::array<T, kNx>& s) const {
    return {weight(200.0) * s[4], weight(200.0) * s[5], weight(0.1) * (s[3] - speed_reference)};
  }
};

/// The same problem in the solver's structured form, by the equations of controller/cubic_problem.hpp:
/// cte_{k+1} depends on stage k alone, an output, not a state. State (x, y, ψ, v, eψ, previous δ, previous
/// a), with the constant 1 as wide as one 512-bit vector. Over its numbers.
template <class Real>
struct DescribedOver {
  static constexpr int kNx = 7;
  static constexpr int kNu = 2;
  static constexpr int kNr = 7;
  static constexpr int kNe = 3;
  static constexpr int kNc = 0;
  static constexpr bool kRealTime = true;

  controller::CubicOver<Real> line{};
  Real speed_reference{};
  Real steer_limit{};
  Real acceleration_limit{};
  Real first_cte{};  ///< given with the start: a constant of the cost

  template <class K, class X, class U>
  CHICANE_INLINE auto dynamics(K, const X& s, const U& input) const {
    return model().next(s, input, input);
  }
  template <class K, class X, class U>
  CHICANE_INLINE auto residual(K k, const X& s, const U& input) const {
    const auto& [x, y, psi, v, epsi, last_steer, last_a] = s;
    const auto& [steer, a] = input;
    const auto change = select(solver::stage_number(k) > 0.0, 1.0, 0.0);
    return std::make_tuple(weight(200.0) * next_cte(s), weight(200.0) * epsi,
                           weight(0.1) * (v - speed_reference), weight(1.0) * steer, weight(1.0) * a,
                           change * weight(10.0) * (steer - last_steer), change * weight(1.0) * (a - last_a));
  }
  template <class X>
  CHICANE_INLINE auto terminal_residual(const X& s) const {
    const auto& [x, y, psi, v, epsi, last_steer, last_a] = s;
    return std::make_tuple(weight(200.0) * first_cte, weight(200.0) * epsi,
                           weight(0.1) * (v - speed_reference));
  }
  template <class X>
  CHICANE_INLINE auto next_cte(const X& s) const {
    return model().next_lateral_error(s);
  }
  [[nodiscard]] std::array<Real, 2> input_lower(int) const { return {-steer_limit, -acceleration_limit}; }
  [[nodiscard]] std::array<Real, 2> input_upper(int) const { return {steer_limit, acceleration_limit}; }

 private:
  static double weight(double w) { return DescribedData::weight(w); }
  [[nodiscard]] CHICANE_INLINE controller::DescribedModel<controller::CubicOver<Real>> model() const {
    return {.line = line,
            .dt = DescribedData::kStep,
            .turn_per_length = DescribedData::kStep / DescribedData::kLength};
  }
};

/// One of them.
struct StructuredDescribedProblem : DescribedOver<double> {
  StructuredDescribedProblem() = default;
  explicit StructuredDescribedProblem(const DescribedProblem& plain, double cte)
      : DescribedOver{.line = {plain.path},
                      .speed_reference = plain.speed_reference,
                      .steer_limit = plain.steer_limit,
                      .acceleration_limit = plain.acceleration_limit,
                      .first_cte = cte} {}

  static std::array<double, kNx> without_cte(const std::array<double, DescribedProblem::kNx>& s) {
    return {s[0], s[1], s[2], s[3], s[5], s[6], s[7]};
  }
};

template <int Capacity>
using DescribedTrajectory = solver::Trajectory<DescribedProblem::kNx, DescribedProblem::kNu, Capacity>;

/// A problem with the state it starts from.
struct DescribedInstance {
  DescribedProblem problem;
  std::array<double, DescribedProblem::kNx> start{};

  void place(double speed) {
    start = {0.0, 0.0, 0.0, speed, problem.path[0], -atan(problem.path[1]), 0.0, 0.0};
  }
};

/// Random paths and speeds; offsets up to 2 m, 22° and a length that fits the horizon.
inline DescribedInstance random_instance(Random& random, int horizon) {
  DescribedInstance instance;
  const double speed = random.uniform(5.0, 25.0);
  instance.problem.speed_reference = random.uniform(10.0, 25.0);
  const double length =
      std::fmax(20.0, std::fmax(speed, instance.problem.speed_reference) * horizon * DescribedProblem::kStep);
  instance.problem.path = {random.uniform(-2.0, 2.0), random.uniform(-0.4, 0.4),
                           random.uniform(-0.2, 0.2) / length,
                           random.uniform(-0.15, 0.15) / (length * length)};
  instance.place(speed);
  return instance;
}

/// Inputs of a critically damped path-following law: the better of the two cold starts.
template <int Capacity>
void guess_by_path_law(const DescribedInstance& instance, DescribedTrajectory<Capacity>& trajectory) {
  const DescribedProblem& p = instance.problem;
  auto s = instance.start;
  for (std::size_t k = 0; k < static_cast<std::size_t>(trajectory.horizon); ++k) {
    const double speed = std::fmax(s[3], 3.0);
    const double slope = p.path[1] + s[0] * (2.0 * p.path[2] + 3.0 * p.path[3] * s[0]);
    const double stretch = 1.0 + slope * slope;
    const double offset =
        (p.path[0] + s[0] * (p.path[1] + s[0] * (p.path[2] + s[0] * p.path[3])) - s[1]) / sqrt(stretch);
    const double curvature = (2.0 * p.path[2] + 6.0 * p.path[3] * s[0]) / (stretch * sqrt(stretch));
    const double rate = 1.2;
    const double pull =
        std::fmin(0.3, std::fmax(-0.3, DescribedProblem::kLength * rate * rate / (speed * speed) * offset));
    const double steer = DescribedProblem::kLength * curvature + pull -
                         2.0 * rate * DescribedProblem::kLength / speed * (s[2] - atan(slope));
    trajectory.u[k] = {
        std::fmin(p.steer_limit, std::fmax(-p.steer_limit, steer)),
        std::fmin(p.acceleration_limit, std::fmax(-p.acceleration_limit, 0.5 * (p.speed_reference - s[3])))};
    s = p.dynamics(0, s, trajectory.u[k]);
  }
}

}  // namespace chicane::bench
