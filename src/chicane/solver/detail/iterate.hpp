// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "chicane/base/inlining.hpp"
#include "chicane/base/math_pack.hpp"
#include "chicane/solver/problem.hpp"

namespace chicane::solver {

/// Eight stages in the lanes of one pack.
template <class Arch>
using Stages = Pack<Arch, 8>;

/// One number for each stage 0 … Capacity. The stage after any group of eight can be read as a group, too.
template <std::size_t Capacity>
inline constexpr std::size_t kStageStride = padded_stages(Capacity + 1) + 8;

/// A trajectory as the solver works on it: stage after stage of one variable, so that eight are one load.
/// Also a step of one.
template <std::size_t Nx, std::size_t Nu, std::size_t Capacity>
struct Iterate {
  alignas(64) double x[Nx][kStageStride<Capacity>]{};  ///< x[i][k], k <= horizon
  alignas(64) double u[Nu][kStageStride<Capacity>]{};
  std::size_t horizon = 0;

  Iterate() = default;
  Iterate(const Iterate&) = delete;
  /// Copies the horizon, not the capacity.
  Iterate& operator=(const Iterate& o) noexcept {
    if (&o == this) return *this;
    horizon = o.horizon;
    const std::size_t size = padded_stages(horizon + 1);
    for (std::size_t i = 0; i < Nx; ++i) std::copy(o.x[i], o.x[i] + size, x[i]);
    for (std::size_t m = 0; m < Nu; ++m) std::copy(o.u[m], o.u[m] + size, u[m]);
    return *this;
  }

  template <class T>
  [[nodiscard]] std::array<T, Nx> state(std::size_t k) const noexcept {
    std::array<T, Nx> result;
    for (std::size_t i = 0; i < Nx; ++i) result[i] = T(x[i][k]);
    return result;
  }
  template <class T>
  [[nodiscard]] std::array<T, Nu> input(std::size_t k) const noexcept {
    std::array<T, Nu> result;
    for (std::size_t m = 0; m < Nu; ++m) result[m] = T(u[m][k]);
    return result;
  }
  /// Into the public form.
  template <class Trajectory>
  CHICANE_INLINE inline void write(Trajectory& trajectory) const noexcept {
    trajectory.horizon = static_cast<int>(horizon);
    for (std::size_t k = 0; k <= horizon; ++k) trajectory.x[k] = state<double>(k);
    for (std::size_t k = 0; k < horizon; ++k) trajectory.u[k] = input<double>(k);
  }
};

}  // namespace chicane::solver
