// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "chicane/base/angle.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/road/racing_road.hpp"
#include "chicane/road/reference_line.hpp"
#include "chicane/tracking/tracking_solver.hpp"

namespace chicane::controller {

/// Expresses the states of an answer along another line, so that it goes on as the first guess there: a guess
/// made anew at the limit of the tyres is one from which a step does not converge. `plan`: where the states
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

}  // namespace chicane::controller
