// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
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

  [[nodiscard]] CHICANE_INLINE std::array<double, 2> input_lower(int) const {
    return {-steer_limit, -acceleration_limit};
  }
  [[nodiscard]] CHICANE_INLINE std::array<double, 2> input_upper(int) const {
    return {steer_limit, acceleration_limit};
  }

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
/// a), with the constant 1 as wide as one 512-bit vector.
struct StructuredDescribedProblem : DescribedData {
  static constexpr int kNx = 7;
  static constexpr int kNu = 2;
  static constexpr int kNr = 7;
  static constexpr int kNe = 3;
  static constexpr int kNc = 0;
  static constexpr bool kRealTime = true;

  controller::Cubic line{};
  double first_cte = 0.0;  ///< given with the start: a constant of the cost

  StructuredDescribedProblem() = default;
  StructuredDescribedProblem(const DescribedData& plain, double cte)
      : DescribedData{plain}, line{plain.path}, first_cte{cte} {}

  static std::array<double, kNx> without_cte(const std::array<double, 8>& s) {
    return {s[0], s[1], s[2], s[3], s[5], s[6], s[7]};
  }

  CHICANE_INLINE auto dynamics(auto, const auto& s, const auto& input) const {
    return model().next(s, input, input);
  }
  CHICANE_INLINE auto residual(auto k, const auto& s, const auto& input) const {
    const auto& [x, y, psi, v, epsi, last_steer, last_a] = s;
    const auto& [steer, a] = input;
    const auto change = select(solver::stage_number(k) > 0.0, 1.0, 0.0);
    return std::make_tuple(weight(200.0) * next_cte(s), weight(200.0) * epsi,
                           weight(0.1) * (v - speed_reference), weight(1.0) * steer, weight(1.0) * a,
                           change * weight(10.0) * (steer - last_steer), change * weight(1.0) * (a - last_a));
  }
  CHICANE_INLINE auto terminal_residual(const auto& s) const {
    const auto& [x, y, psi, v, epsi, last_steer, last_a] = s;
    return std::make_tuple(weight(200.0) * first_cte, weight(200.0) * epsi,
                           weight(0.1) * (v - speed_reference));
  }
  CHICANE_INLINE auto next_cte(const auto& s) const { return model().next_lateral_error(s); }

 private:
  [[nodiscard]] CHICANE_INLINE controller::DescribedModel<controller::Cubic> model() const {
    return {.line = line, .dt = kStep, .turn_per_length = kStep / kLength};
  }
};

template <int Capacity>
using DescribedTrajectory = solver::Trajectory<DescribedProblem::kNx, DescribedProblem::kNu, Capacity>;

/// A problem with the state it starts from.
template <class Problem>
struct Posed {
  Problem problem;
  std::array<double, DescribedProblem::kNx> start{};

  void place(double speed) {
    start = {0.0, 0.0, 0.0, speed, problem.path[0], -atan(problem.path[1]), 0.0, 0.0};
  }
};

using DescribedInstance = Posed<DescribedProblem>;

/// Random paths and speeds; offsets up to 2 m, 22° and a length that fits the horizon.
template <class Problem = DescribedProblem>
Posed<Problem> random_instance(Random& random, int horizon) {
  Posed<Problem> instance;
  const double speed = random.uniform(5.0, 25.0);
  instance.problem.speed_reference = random.uniform(10.0, 25.0);
  const double length =
      std::fmax(20.0, std::fmax(speed, instance.problem.speed_reference) * horizon * DescribedProblem::kStep);
  instance.problem.path = {random.uniform(-2.0, 2.0), random.uniform(-0.4, 0.4),
                           random.uniform(-0.2, 0.2) / length,
                           random.uniform(-0.15, 0.15) / (length * length)};
  instance.place(speed);
  if constexpr (Problem::kNc > 0) instance.problem.draw_window(random, horizon);
  return instance;
}

/// Inputs of a critically damped path-following law: the better of the two cold starts.
template <class Problem, int Capacity>
void guess_by_path_law(const Posed<Problem>& instance, DescribedTrajectory<Capacity>& trajectory) {
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

/// The described problem with a soft corridor low_k <= cte_k <= high_k (linear penalty 500, quadratic 100):
/// half-width 1.2 m with a window that forces the car at least 0.6 m to one side.
struct CorridorProblem : DescribedProblem {
  static constexpr int kNc = 2;

  int window_begin = 0;
  int window_end = 0;
  double window_side = 1.0;
  double half_width = 1.2;
  double keep_out = 0.6;
  solver::SoftPenalty penalty{.linear = 500.0, .quadratic = 100.0};

  template <class T>
  std::array<T, kNc> constraint(int k, const std::array<T, kNx>& s, const std::array<T, kNu>&) const {
    double low = -half_width;
    double high = half_width;
    if (k >= window_begin && k < window_end) {
      low = window_side > 0.0 ? keep_out : -2.0;
      high = window_side > 0.0 ? 2.0 : -keep_out;
    }
    return {s[4] - high, low - s[4]};
  }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return penalty; }
  /// A window in the middle of a horizon, on a side by chance.
  void draw_window(Random& random, int horizon) {
    window_begin = horizon / 3;
    window_end = horizon / 3 + std::max(2, horizon / 4);
    window_side = random.uniform() < 0.5 ? 1.0 : -1.0;
  }
};

/// The same problem in the solver's structured form. cte_{k+1} is an output of stage k, so each bound stands
/// one stage earlier; the last stage has none, as the end has none.
struct StructuredCorridorProblem : StructuredDescribedProblem {
  static constexpr int kNc = 2;
  static constexpr std::size_t kCapacity = 200;
  static constexpr double kFar = 1e3;  ///< [m]

  solver::StageData<kCapacity> low;
  solver::StageData<kCapacity> high;
  solver::SoftPenalty penalty;

  StructuredCorridorProblem() = default;
  StructuredCorridorProblem(const CorridorProblem& plain, double cte, int horizon)
      : StructuredDescribedProblem(plain, cte), penalty(plain.penalty) {
    for (int k = 0; k < horizon; ++k) {
      const std::array<double, 2> excess =
          plain.constraint(k + 1, std::array<double, DescribedProblem::kNx>{}, std::array<double, 2>{});
      const bool is_last = k == horizon - 1;
      high[static_cast<std::size_t>(k)] = is_last ? kFar : -excess[0];
      low[static_cast<std::size_t>(k)] = is_last ? -kFar : excess[1];
    }
  }

  CHICANE_INLINE auto constraint(auto k, const auto& s, const auto&) const {
    const auto cte = next_cte(s);
    return std::make_tuple(cte - high.at(k), low.at(k) - cte);
  }
  [[nodiscard]] CHICANE_INLINE solver::SoftPenalty soft_penalty(int) const { return penalty; }
  [[nodiscard]] static std::string_view constraint_name(int c) { return c == 0 ? "left edge" : "right edge"; }
  [[nodiscard]] static std::string_view constraint_unit(int) { return "m"; }
};

}  // namespace chicane::bench
