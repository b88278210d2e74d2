// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include "chicane/base/compiler.hpp"

namespace chicane::solver {

/// Several consecutive stages at once, one in each lane of the pack V: stage `first` in lane 0. Functions of
/// a structured problem get one of these, or an int, as their stage `k`.
template <class V>
struct StageLanes {
  int first = 0;
};

/// Values of stages without lanes behind the last one: no lane ever reads beyond the array.
inline constexpr std::size_t kMostLanes = 8;
[[nodiscard]] constexpr std::size_t padded_stages(std::size_t count) noexcept {
  return (count + kMostLanes - 1) / kMostLanes * kMostLanes;
}

/// One number for each stage 0 … Capacity − 1, readable for one stage or for several in lanes.
template <std::size_t Capacity>
struct StageData {
  alignas(64) std::array<double, padded_stages(Capacity)> values{};

  [[nodiscard]] double& operator[](std::size_t k) noexcept { return values[k]; }
  [[nodiscard]] double at(int k) const noexcept { return values[static_cast<std::size_t>(k)]; }
  template <class V>
  [[nodiscard]] V at(StageLanes<V> k) const noexcept {
    return V::load(values.data() + k.first);
  }
};

/// The number of a stage as a value: k itself, or one in each lane.
[[nodiscard]] inline double stage_number(int k) noexcept { return k; }
template <class V>
[[nodiscard]] CHICANE_INLINE inline V stage_number(StageLanes<V> k) noexcept {
  alignas(64) static constexpr std::array<double, kMostLanes> kCount{0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0};
  return V::load(kCount.data()) + static_cast<double>(k.first);
}

}  // namespace chicane::solver
