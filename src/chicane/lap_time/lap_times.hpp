// SPDX-License-Identifier: MIT
#pragma once

#include <array>

namespace chicane::lap_time {

/// Times of a lap and of its thirds from the start line on [s].
struct LapTimes {
  double lap = 0.0;
  std::array<double, 3> sectors{};
};

/// How much longer `time` is than the limit's, relative: 0.05 is five per cent slower. Not-a-number for one
/// that was not measured. Pre: limit > 0.
[[nodiscard]] constexpr double gap(double time, double limit) noexcept { return time / limit - 1.0; }

}  // namespace chicane::lap_time
