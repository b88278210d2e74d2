// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "chicane/tracking/tracking_problem.hpp"

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

}  // namespace chicane::controller
