// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "chicane/base/math.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/model/actuator.hpp"
#include "chicane/road/racing_road.hpp"
#include "chicane/road/reference_line.hpp"
#include "chicane/tracking/tracking_problem.hpp"
#include "chicane/tracking/tracking_solver.hpp"

/// The first guess of `tracking-mpc` where it has no answer to go on from.
namespace chicane::controller {

/// Inputs towards the line in state x, on the road as stage k of `problem` sees it.
[[nodiscard]] inline tracking::TrackingProblem::Input path_law(
    const tracking::TrackingProblem& problem, int k, const tracking::TrackingProblem::State& x) noexcept {
  using Problem = tracking::TrackingProblem;
  const double v = std::max(x[Problem::kVx], 1.0);
  const double curvature = problem.road.curvature.at(k) - x[Problem::kD] / (v * v) - 1.4 * x[Problem::kE] / v;
  return {problem.model->vehicle().wheelbase() * curvature, problem.road.speed.at(k) - x[Problem::kVx]};
}

/// Pulls a guess back that is far from the road: no place to linearise.
inline void keep_sane(tracking::TrackingProblem::State& x) noexcept {
  using Problem = tracking::TrackingProblem;
  x[Problem::kD] = std::clamp(x[Problem::kD], -5.0, 5.0);
  x[Problem::kE] = std::clamp(x[Problem::kE], -0.6, 0.6);
  x[Problem::kVx] = std::max(x[Problem::kVx], 0.0);
}

/// Adds what the steer helper leaves out along the guess `along` to what disturbs the stages of `problem`: a
/// change of v_y where the heading passes the gap, divided between the ends of the stages around it
/// (docs/limit.md, eq. 12). `s`: of the car on `line` [m].
inline void mind_helper_gap(tracking::TrackingProblem& problem, const tracking::TrackingTrajectory& along,
                            const road::ReferenceLine& line, double s) noexcept {
  using Problem = tracking::TrackingProblem;
  const model::VehicleParams& car = problem.model->vehicle();
  if (!(car.helper_gap > 0.0)) return;
  const auto heading = [&](std::size_t i) {
    return line.at(s + along.x[i][Problem::kS]).heading + along.x[i][Problem::kE];
  };
  double from = heading(0);
  for (std::size_t i = 0; i < static_cast<std::size_t>(along.horizon); ++i) {
    const double to = from + angle_difference(heading(i + 1), from);
    if (const double share = model::helper_gap_within(from, to); share > 0.0) {
      const auto& x = along.x[i];
      const double push = -model::helper_gap_turn(car, x[Problem::kR]) * x[Problem::kVx];
      const double of_this = i == 0 ? 1.0 : share;
      problem.road.pushed_vy[i] += of_this * push;
      if (i > 0) problem.road.pushed_vy[i - 1] += (1.0 - of_this) * push;
    }
    from = to;
  }
}

/// Expresses the states of an answer along another line, so that it goes on as the first guess there: a guess
/// made newly at the limit of the tyres is one from which a step does not converge. `plan`: where the states
/// are in the world. `far` [m]: beside the line. False, and an answer of no use, where one is farther.
/// Allocates nothing.
[[nodiscard]] inline bool move_to_line(const road::ReferenceLine& line, const Plan& plan, double reach,
                                       double far, tracking::TrackingTrajectory& answer) noexcept {
  using Problem = tracking::TrackingProblem;
  if (line.is_empty() || plan.size != answer.horizon + 1) return false;
  double last = 0.0, driven = 0.0;
  for (int k = 0; k <= answer.horizon; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const PlanPoint& point = plan.points[i];
    const road::ReferenceLine::Projection place =
        line.find({point.x, point.y}, point.psi, reach, k > 0 ? &last : nullptr, far);
    if (!(place.distance < far)) return false;
    if (k > 0) driven += line.is_closed() ? std::remainder(place.s - last, line.length()) : place.s - last;
    answer.x[i][Problem::kS] = driven;
    answer.x[i][Problem::kD] = place.d;
    answer.x[i][Problem::kE] = angle_difference(point.psi, line.at(place.s).heading);
    last = place.s;
  }
  return true;
}

/// How far beside `lap` [m] the plan of the next 1.5 s leads at most. Of the first lap (`now` is null) the
/// car's own place counts: the line through waypoints leaves grip to join it with, and crosses it before
/// long. 0 where `lap` is to be taken up at once, since it has less grip, which has to be braked for.
/// Allocates nothing.
[[nodiscard]] inline double beside_lap(const road::RacingRoad& lap, const road::RacingRoad* now,
                                       const Plan& plan, double reach, double far) noexcept {
  const double joining_time = now == nullptr ? 0.0 : 1.5;  // [s]
  if (lap.line().is_empty() || (now != nullptr && lap.grip() < now->grip())) return 0.0;
  double most = 0.0, last = 0.0;
  for (int k = 0; k < plan.size; ++k) {
    const PlanPoint& point = plan.points[static_cast<std::size_t>(k)];
    if (point.time > plan.points[0].time + joining_time) break;
    const road::ReferenceLine::Projection place =
        lap.line().find({point.x, point.y}, point.psi, reach, k > 0 ? &last : nullptr, far);
    most = std::max(most, place.distance);
    last = place.s;
  }
  return most;
}

/// How long something has not been there that was. One thread; allocates nothing.
struct Absence {
  double longest;      ///< that is borne [s]
  double since = 0.0;  ///< last there [s]
  bool was_there = false;
  bool is_long = false;

  void note(bool is_there, double time) noexcept {
    if (is_there) since = time;
    was_there = was_there || is_there;
    is_long = was_there && std::isfinite(time) && time - since > longest;
  }
  void reset() noexcept { *this = {.longest = longest}; }
};

}  // namespace chicane::controller
