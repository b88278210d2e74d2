// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "chicane/base/vec2.hpp"

namespace chicane::road {

/// Two pieces of a polyline that touch: from points[first] and points[second] to their next points, first <
/// second.
struct Crossing {
  std::size_t first = 0;
  std::size_t second = 0;
  bool is_tangle = false;  ///< not looked at closely: there are too many pieces in one place
};

/// The places where the polyline through `points` crosses or touches itself (neighbours sharing a point do
/// not count), by rising `second`. Grid of cells as wide as the longest piece: O(n log n) for evenly spaced
/// points. A line that comes by the same cell hundreds of times is no road and is reported as crossing there,
/// once for each such cell. Ends after kMostCrossings.
inline constexpr std::size_t kMostCrossings = 10'000;
[[nodiscard]] std::vector<Crossing> find_crossings(std::span<const Vec2> points, bool closed);

}  // namespace chicane::road
