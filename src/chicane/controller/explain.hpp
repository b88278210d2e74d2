// SPDX-License-Identifier: MIT
// Explanation of the answer to an optimal control problem: cost by term, active constraints, limiter of the
// speed.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

#include "chicane/controller/controller.hpp"
#include "chicane/controller/cubic_problem.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/road/reference_line.hpp"
#include "chicane/solver/problem.hpp"
#include "chicane/tracking/tracking_problem.hpp"

namespace chicane::controller {

/// Terms of the cost of TrackingProblem: groups of its residuals, in the order of their names.
struct TrackingTerms {
  enum Group : std::uint8_t { kLateral, kHeading, kSpeed, kSteerRate, kJerk, kEdge, kSlip, kFriction, kYaw };
  static constexpr std::array<std::string_view, 9> kNames{
      "lateral", "heading", "speed", "steer_rate", "jerk", "edge", "slip", "friction", "end_yaw_rate"};
  /// Group of each residual of a stage, and of the end of the horizon.
  static constexpr std::array<Group, tracking::TrackingProblem::kNr> kStage{
      kLateral, kHeading, kSpeed, kSteerRate, kJerk, kEdge, kEdge, kSlip, kSlip, kSteerRate, kFriction};
  static constexpr std::array<Group, tracking::TrackingProblem::kNe> kEnd{kLateral, kHeading, kSpeed, kYaw};
  /// Residuals of a stage that are above zero while a soft constraint is active.
  static constexpr std::array<std::pair<std::size_t, Constraint>, 6> kOneSided{
      {{5, Constraint::kLeftEdge},
       {6, Constraint::kRightEdge},
       {7, Constraint::kFrontTire},
       {8, Constraint::kRearTire},
       {9, Constraint::kSteerRate},
       {10, Constraint::kFrictionEllipse}}};
};

/// Terms of the cost of CubicProblem: those of equation 7, in its order (docs/the_five_systems.md).
struct CubicTerms {
  static constexpr std::array<std::string_view, 8> kNames{
      "lateral", "heading", "speed", "steer", "throttle", "steer_change", "throttle_change", "speed_steer"};
  static constexpr std::array<std::uint8_t, CubicProblem::kNr> kStage{0, 1, 2, 3, 4, 5, 6, 7};
  static constexpr std::array<std::uint8_t, CubicProblem::kNe> kEnd{0, 1, 2};
  static constexpr std::array<std::pair<std::size_t, Constraint>, 0> kOneSided{};
};

/// Bits of Constraint for inputs `u` (steering, pedal or acceleration) at their bounds.
[[nodiscard]] inline std::uint32_t bounds_met(const std::array<double, 2>& u,
                                              const std::array<double, 2>& low,
                                              const std::array<double, 2>& high) noexcept {
  constexpr double kTouch = 1e-6;  // tolerance at a bound, in the input's unit; chosen above rounding
  std::uint32_t bits = 0;
  if (u[0] <= low[0] + kTouch || u[0] >= high[0] - kTouch) bits |= bit(Constraint::kSteerLimit);
  if (u[1] >= high[1] - kTouch) bits |= bit(Constraint::kThrottleMax);
  if (u[1] <= low[1] + kTouch) bits |= bit(Constraint::kBrakeMax);
  return bits;
}

/// Fills cost terms and active constraints from an answer. Evaluates the residuals once along the plan: about
/// 40 ns a stage. `Terms`: a struct as above; `Trajectory` has horizon, x and u.
template <class Terms, class Problem, class Trajectory>
void explain(const Problem& problem, const Trajectory& answer, Explanation& explanation) noexcept {
  static_assert(Terms::kNames.size() <= Explanation::kMaxCostTerms);
  explanation.cost_terms = {};
  explanation.cost_term_count = static_cast<int>(Terms::kNames.size());
  explanation.active_now = explanation.active_ahead = 0;
  const auto add_cost = [&](const auto& residual, const auto& groups) {
    for (std::size_t i = 0; i < groups.size(); ++i)
      explanation.cost_terms[groups[i]] += 0.5 * residual[i] * residual[i];
  };
  for (int k = 0; k < answer.horizon; ++k) {
    const auto& x = answer.x[static_cast<std::size_t>(k)];
    const auto& u = answer.u[static_cast<std::size_t>(k)];
    const auto residual = solver::to_array<double>(problem.residual(k, x, u));
    add_cost(residual, Terms::kStage);
    std::uint32_t active = bounds_met(u, problem.input_lower(k), problem.input_upper(k));
    for (const auto& [row, constraint] : Terms::kOneSided)
      if (residual[row] > 0.0) active |= bit(constraint);
    if (k == 0) explanation.active_now = active;
    explanation.active_ahead |= active;
  }
  const auto& end = answer.x[static_cast<std::size_t>(answer.horizon)];
  add_cost(solver::to_array<double>(problem.terminal_residual(end)), Terms::kEnd);
}

/// Limiter of the speed of a car at `speed` [m/s] whose allowed speed is `limit` [m/s] for the reason `by`.
/// If that is not reached, the limiter is the drive at full throttle.
[[nodiscard]] inline SpeedLimiter limiter_of(double speed, double limit, SpeedLimiter by,
                                             std::uint32_t active_now) noexcept {
  constexpr double kReached = 0.5;  // [m/s] below the limit that counts as reached; chosen
  const bool is_reached = speed >= limit - kReached;
  if (!is_reached && (active_now & bit(Constraint::kThrottleMax)) != 0U) return SpeedLimiter::kPower;
  // Below the wanted speed other terms of the cost than the speed's hold the car back.
  return !is_reached && by == SpeedLimiter::kAsked ? SpeedLimiter::kPartThrottle : by;
}

/// Limiter of the speed at a place of a planned lap: a constraint that is active in the first stage, else the
/// limit of the car that the planned motion is at.
[[nodiscard]] inline SpeedLimiter limiter_of_lap(const road::ReferenceLine::Demand& planned,
                                                 const model::VehicleParams& car,
                                                 std::uint32_t active_now) noexcept {
  constexpr double kSlowing = 0.5;  // [m/s²] deceleration beyond rolling that is braking; chosen
  constexpr double kNearly = 0.9;   // share of grip or steering rate that is at the limit; chosen
  constexpr double kNoMore = 0.3;   // [m/s²] reserve of the drive that is none; chosen
  const auto is_active = [&](auto... constraints) { return (active_now & (bit(constraints) | ...)) != 0U; };
  if (is_active(Constraint::kThrottleMax)) return SpeedLimiter::kPower;
  const double v = planned.speed;
  const double along = v * planned.speed_slope;
  const double rolling = longitudinal_acceleration(car, 0.0, v);
  if (is_active(Constraint::kBrakeMax) || along < rolling - kSlowing) return SpeedLimiter::kBraking;
  const double grip = car.cornering_friction() * car.load(v);
  const double across = v * v * (1.0 - car.steer_helper) * planned.curvature;
  const double coupled = car.friction_coupling * along;
  if (is_active(Constraint::kFrontTire, Constraint::kRearTire, Constraint::kFrictionEllipse) ||
      across * across + coupled * coupled > kNearly * kNearly * grip * grip)
    return SpeedLimiter::kCurvature;
  if (along > longitudinal_acceleration(car, 1.0, v) - kNoMore) return SpeedLimiter::kPower;
  const double steer_rate = car.wheelbase() * std::fabs(planned.curvature_slope) * v;
  if (is_active(Constraint::kSteerRate) || steer_rate > kNearly * car.steer_rate_limit)
    return SpeedLimiter::kSteerRate;
  if (is_active(Constraint::kLeftEdge, Constraint::kRightEdge)) return SpeedLimiter::kEdge;
  return SpeedLimiter::kPlan;
}

/// Fills allowed speed and limiter at the place where the command acts. `raced`: the car that the planned lap
/// is for; null without a planned lap.
inline void explain_speed(const road::ReferenceLine::Demand& planned, double speed,
                          const model::VehicleParams* raced, Explanation& explanation) noexcept {
  explanation.speed_limit = planned.speed;
  explanation.speed_limiter = raced != nullptr
                                  ? limiter_of_lap(planned, *raced, explanation.active_now)
                                  : limiter_of(speed, planned.speed, planned.limiter, explanation.active_now);
}

}  // namespace chicane::controller
