// SPDX-License-Identifier: MIT
// The solver's copy of a trajectory, variable by variable, so that eight stages fill a vector, and operations
// on it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "chicane/base/compiler.hpp"
#include "chicane/base/pack.hpp"
#include "chicane/solver/problem.hpp"

namespace chicane::solver {

/// Eight stages in the lanes of one pack.
template <class Arch>
using Stages = Pack<Arch, 8>;

/// Length of an array with a number for each stage 0 … Capacity, and with room to load eight numbers from one
/// stage after any group of eight.
template <std::size_t Capacity>
inline constexpr std::size_t kStageStride = padded_stages(Capacity + 1) + 8;

/// Whether each of the eight stages from k on is before stage `horizon`.
template <class V>
[[nodiscard]] CHICANE_INLINE inline auto stages_before(std::size_t k, std::size_t horizon) noexcept {
  return stage_number(StageLanes<V>{static_cast<int>(k)}) < V(static_cast<double>(horizon));
}

/// States and inputs of a horizon, or a step of them, in the order in which the solver works: all stages of
/// one variable, then of the next, so that eight stages are one load.
template <std::size_t Nx, std::size_t Nu, std::size_t Capacity>
struct Iterate {
  alignas(64) double x[Nx][kStageStride<Capacity>]{};  ///< x[i][k], k <= horizon
  alignas(64) double u[Nu][kStageStride<Capacity>]{};  ///< u[m][k], k < horizon
  std::size_t horizon = 0;                             ///< number of stages

  Iterate() = default;
  Iterate(const Iterate&) = delete;
  /// Copies the stages of the horizon alone; the rest of the arrays stays.
  Iterate& operator=(const Iterate& o) noexcept {
    if (&o == this) return *this;
    horizon = o.horizon;
    const std::size_t size = padded_stages(horizon + 1);
    for (std::size_t i = 0; i < Nx; ++i) std::copy(o.x[i], o.x[i] + size, x[i]);
    for (std::size_t m = 0; m < Nu; ++m) std::copy(o.u[m], o.u[m] + size, u[m]);
    return *this;
  }

  /// State of stage k.
  template <class T>
  [[nodiscard]] std::array<T, Nx> state(std::size_t k) const noexcept {
    std::array<T, Nx> result;
    for (std::size_t i = 0; i < Nx; ++i) result[i] = T(x[i][k]);
    return result;
  }
  /// Input of stage k.
  template <class T>
  [[nodiscard]] std::array<T, Nu> input(std::size_t k) const noexcept {
    std::array<T, Nu> result;
    for (std::size_t m = 0; m < Nu; ++m) result[m] = T(u[m][k]);
    return result;
  }
  /// Copies to the trajectory of the user.
  template <class Trajectory>
  CHICANE_INLINE inline void write(Trajectory& trajectory) const noexcept {
    trajectory.horizon = static_cast<int>(horizon);
    for (std::size_t k = 0; k <= horizon; ++k) trajectory.x[k] = state<double>(k);
    for (std::size_t k = 0; k < horizon; ++k) trajectory.u[k] = input<double>(k);
  }
};

/// Copies the step of the quadratic program to `step`. Its states are stored stage by stage, and are
/// transposed in blocks of 8 × 8. `ClampInputs`: limits inputs to their bounds. Returns the largest change of
/// an input.
template <class Arch, bool ClampInputs, class Lq, class Step>
double collect_step(const Lq& lq, std::size_t horizon, Step& step) noexcept {
  using V = Stages<Arch>;
  step.horizon = horizon;
  for (std::size_t k0 = 0; k0 <= horizon; k0 += 8) {
    for (std::size_t block = 0; block < Lq::kLanes; block += 8) {
      V rows[8];
      unroll<8>([&](auto lane)
                    CHICANE_INLINE { rows[lane] = V::load(lq.dx[std::min(k0 + lane, horizon)] + block); });
      transpose(rows);
      unroll<8>([&](auto i) CHICANE_INLINE {
        if (block + i < Lq::kNx) rows[i].store(step.x[block + i] + k0);
      });
    }
  }
  double longest = 0.0;
  for (std::size_t m = 0; m < Lq::kNu; ++m) {
    for (std::size_t k = 0; k < horizon; ++k) {
      const double du =
          ClampInputs ? std::min(std::max(lq.du[k][m], lq.lq.low[m][k]), lq.lq.high[m][k]) : lq.du[k][m];
      step.u[m][k] = du;
      longest = std::max(longest, std::fabs(du));
    }
  }
  return longest;
}

/// Sets to = from + length · step. `to` may be `from`.
template <class Arch, class Point>
void add_step(const Point& from, double length, const Point& step, Point& to) noexcept {
  using V = Stages<Arch>;
  to.horizon = from.horizon;
  for (std::size_t k = 0; k <= from.horizon; k += 8) {
    const auto move = [&](const double* value, const double* change, double* moved) CHICANE_INLINE {
      (V::load(value + k) + length * V::load(change + k)).store(moved + k);
    };
    for (std::size_t i = 0; i < std::size(from.x); ++i) move(from.x[i], step.x[i], to.x[i]);
    for (std::size_t m = 0; m < std::size(from.u); ++m) move(from.u[m], step.u[m], to.u[m]);
  }
}

/// Whether two points are equal but for rounding.
template <class Arch, class Point>
bool equal_within_rounding(const Point& from, const Point& to) noexcept {
  constexpr double kTiny = 1e-15;  // about five roundings, relative; absolute near zero; chosen
  const auto keeps = [&](const auto& a, const auto& b, std::size_t count) {
    for (std::size_t i = 0; i < std::size(a); ++i) {
      for (std::size_t k = 0; k < count; ++k) {
        if (std::fabs(a[i][k] - b[i][k]) > kTiny * (1.0 + std::fabs(a[i][k]))) return false;
      }
    }
    return true;
  };
  return keeps(from.u, to.u, from.horizon) && keeps(from.x, to.x, from.horizon + 1);
}

/// Largest change of an input between two points.
template <class Point>
CHICANE_INLINE inline double max_input_change(const Point& from, const Point& to) noexcept {
  double longest = 0.0;
  for (std::size_t m = 0; m < std::size(from.u); ++m) {
    for (std::size_t k = 0; k < from.horizon; ++k)
      longest = std::max(longest, std::fabs(to.u[m][k] - from.u[m][k]));
  }
  return longest;
}

}  // namespace chicane::solver
