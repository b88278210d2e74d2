// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <vector>

#include "chicane/base/math.hpp"
#include "chicane/base/vec2.hpp"

namespace chicane::test {

/// Points of a closed, counter-clockwise line of two half circles and two straights without points between.
inline std::vector<Vec2> stadium(double radius, int chords, double straight) {
  std::vector<Vec2> points;
  for (const double side : {-1.0, 1.0}) {
    for (int k = 0; k <= chords; ++k) {
      const double angle = kPi * (0.5 * side + static_cast<double>(k) / chords);
      points.emplace_back((side < 0.0 ? straight : 0.0) + radius * std::cos(angle), radius * std::sin(angle));
    }
  }
  return points;
}

}  // namespace chicane::test
