// SPDX-License-Identifier: MIT
#include "chicane/path/road_data.hpp"

#include <algorithm>
#include <cmath>

#include "chicane/base/assert.hpp"

namespace chicane::path {

RoadData road_data(const Track& track, double spacing) {
  CHICANE_ASSERT(spacing > 0.0);
  const Path& centre = track.centre();
  RoadData road;
  road.is_closed = centre.is_closed();
  road.length = centre.length();
  // Less a little: a length that is a multiple of the spacing but for rounding takes no interval more.
  const auto intervals = static_cast<std::size_t>(std::max(1.0, std::ceil(road.length / spacing - 1e-9)));
  road.points.reserve(intervals + 1);
  for (std::size_t k = 0; k <= intervals; ++k) {
    const double s = road.length * static_cast<double>(k) / static_cast<double>(intervals);
    const PathPoint point = centre.at(s);
    road.points.push_back({.s = s,
                           .position = point.position,
                           .heading = point.heading,
                           .curvature = point.curvature,
                           .left = track.left_width(s),
                           .right = track.right_width(s)});
  }
  return road;
}

}  // namespace chicane::path
