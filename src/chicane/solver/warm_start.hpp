// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "chicane/base/compiler.hpp"
#include "chicane/solver/problem.hpp"

/// Guesses for the next solve: clamped inputs, their simulation, and shifted or resampled trajectories.

namespace chicane::solver {

/// Moves every input into its bounds. Inputs that are not finite become the admissible value nearest to zero.
template <OcpProblem P, int Capacity>
CHICANE_INLINE inline void clamp_inputs(const P& problem,
                                        Trajectory<P::kNx, P::kNu, Capacity>& trajectory) noexcept {
  for (int k = 0; k < trajectory.horizon; ++k) {
    const auto stage = static_cast<std::size_t>(k);
    const auto low = problem.input_lower(k);
    const auto high = problem.input_upper(k);
    for (std::size_t m = 0; m < low.size(); ++m) {
      double& u = trajectory.u[stage][m];
      u = std::min(std::max(std::isfinite(u) ? u : 0.0, low[m]), high[m]);
    }
  }
}

/// Simulates the clamped inputs from x0 into trajectory.x. True when every state is finite.
template <OcpProblem P, int Capacity>
bool roll_out(const P& problem, const std::array<double, P::kNx>& x0,
              Trajectory<P::kNx, P::kNu, Capacity>& trajectory) noexcept {
  trajectory.x[0] = x0;
  clamp_inputs(problem, trajectory);
  bool finite = true;
  for (int k = 0; k < trajectory.horizon; ++k) {
    const auto stage = static_cast<std::size_t>(k);
    trajectory.x[stage + 1] = next_state(problem, k, trajectory.x[stage], trajectory.u[stage]);
    for (const double value : trajectory.x[stage + 1]) finite = finite && std::isfinite(value);
  }
  return finite;
}

/// Resamples a trajectory to another grid: `horizon` intervals, each `ratio` times as long as before.
/// Interpolates between the old points, and repeats the last one beyond them. Pre: horizon in [1, Capacity],
/// ratio > 0.
template <int Nx, int Nu, int Capacity>
void resample(Trajectory<Nx, Nu, Capacity>& trajectory, int horizon, double ratio) noexcept {
  const Trajectory<Nx, Nu, Capacity> old = trajectory;
  trajectory.horizon = horizon;
  if (old.horizon < 1) return;
  const auto blend = [&](const auto& from, auto& to, int last_from, int last_to) {
    for (int k = 0; k <= last_to; ++k) {
      const double where = std::min(k * ratio, static_cast<double>(last_from));
      const int below = static_cast<int>(where);
      const auto& low = from[static_cast<std::size_t>(below)];
      const auto& high = from[static_cast<std::size_t>(std::min(below + 1, last_from))];
      auto& value = to[static_cast<std::size_t>(k)];
      for (std::size_t i = 0; i < value.size(); ++i) value[i] = low[i] + (where - below) * (high[i] - low[i]);
    }
  };
  blend(old.u, trajectory.u, old.horizon - 1, horizon - 1);
  blend(old.x, trajectory.x, old.horizon, horizon);
}

/// Shifts inputs and states to `steps` intervals later (fractions interpolate); the last ones are repeated.
/// Used between control cycles: steps = elapsed time / interval. Negative or non-finite `steps` count as 0.
template <int Nx, int Nu, int Capacity>
void shift(Trajectory<Nx, Nu, Capacity>& trajectory, double steps) noexcept {
  if (trajectory.horizon < 1 || !(steps > 0.0) || !std::isfinite(steps)) return;
  const double whole = std::floor(std::min(steps, static_cast<double>(trajectory.horizon)));
  const double part = std::min(steps - whole, 1.0);
  const int offset = static_cast<int>(whole);
  const auto blend = [&](auto& values, int last) {
    for (int k = 0; k <= last; ++k) {
      const auto from = values[static_cast<std::size_t>(std::min(k + offset, last))];
      const auto to = values[static_cast<std::size_t>(std::min(k + offset + 1, last))];
      auto& value = values[static_cast<std::size_t>(k)];
      for (std::size_t i = 0; i < value.size(); ++i) value[i] = from[i] + part * (to[i] - from[i]);
    }
  };
  blend(trajectory.u, trajectory.horizon - 1);
  blend(trajectory.x, trajectory.horizon);
}

}  // namespace chicane::solver
