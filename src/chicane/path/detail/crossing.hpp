// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "chicane/base/vec2.hpp"

namespace chicane::path {

/// Two pieces of a polyline that touch: from points[first] and points[second] to their next points, first <
/// second.
struct Crossing {
  std::size_t first = 0;
  std::size_t second = 0;
};

/// A place where the polyline through `points` crosses or touches itself (neighbours sharing a point do not
/// count), the one with the smallest `second`. Grid of cells as wide as the longest piece: O(n log n) for
/// evenly spaced points. A line that comes by the same cell hundreds of times is no road either and is
/// reported as crossing there.
[[nodiscard]] std::optional<Crossing> find_crossing(std::span<const Vec2> points, bool closed);

}  // namespace chicane::path
