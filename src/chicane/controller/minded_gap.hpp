// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include "chicane/model/helper_gap.hpp"
#include "chicane/road/reference_line.hpp"
#include "chicane/tracking/tracking_problem.hpp"
#include "chicane/tracking/tracking_solver.hpp"

namespace chicane::controller {

/// Adds what the steer helper leaves out along the guess `along` to what disturbs the stages of `problem`: a
/// change of v_y where the heading passes the gap, divided between the ends of the stages around it
/// (docs/racing_gap.md, eq. 2). `s`: of the car on `line` [m].
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

}  // namespace chicane::controller
