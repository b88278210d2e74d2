// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/base/math.hpp"
#include "chicane/model/state.hpp"
#include "chicane/road/road.hpp"
#include "support/chicane_test.hpp"

namespace chicane::road {

/// Waypoints of a flattened circle, about 12 m apart.
inline std::vector<Vec2> stadium(int count = 60) {
  std::vector<Vec2> points;
  for (int i = 0; i < count; ++i) {
    const double angle = kTwoPi * i / count;
    points.emplace_back(150.0 * cos(angle), 80.0 * sin(angle));
  }
  return points;
}

/// What a car sees of them: `count` from number `first` on.
inline model::Measurement seeing(const std::vector<Vec2>& points, int first, int count = 6) {
  model::Measurement now;
  now.waypoint_count = count;
  for (int i = 0; i < count; ++i) now.waypoints[i] = points[(first + i) % points.size()];
  return now;
}

/// Drives round until the lap is planned. Returns how many measurements that took after the loop was closed.
inline int learn(Road& road, const std::vector<Vec2>& points, int begin = 0) {
  const int count = static_cast<int>(points.size());
  for (int i = 0; i < count; ++i) road.add(seeing(points, begin + i));
  int more = 0;
  for (; !road.line().is_closed() && more < 1000; ++more) road.add(seeing(points, begin + more / 8));
  EXPECT_TRUE(road.line().is_closed());
  return more;
}

}  // namespace chicane::road
