// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

namespace chicane {

/// `value` in [low, high]; nothing when it is outside. What lies beyond a border by no more than the rounding
/// of single precision, a millionth of the larger border (or of 1), is the border: programs that compute with
/// floats mean it. Not-a-number is outside. Requires finite low <= high.
[[nodiscard]] inline std::optional<double> within(double value, double low, double high) noexcept {
  const double rounding = 1e-6 * std::max({1.0, std::fabs(low), std::fabs(high)});
  if (!(value >= low - rounding && value <= high + rounding)) return std::nullopt;
  return std::clamp(value, low, high);
}

}  // namespace chicane
