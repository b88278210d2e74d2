// SPDX-License-Identifier: MIT
// The median of numbers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace chicane {

/// Median; of an even number of values the upper one of the middle two. Changes the order of `values`. No
/// allocation. Pre: at least one value.
[[nodiscard]] inline double median(std::span<double> values) noexcept {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}
/// The same of numbers that keep their order.
[[nodiscard]] inline double median(std::vector<double> values) { return median(std::span(values)); }

}  // namespace chicane
