// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "chicane/base/math.hpp"
#include "chicane/base/vec2.hpp"

namespace chicane::test {

/// A place on a closed, counter-clockwise line of two straights and two half circles.
struct StadiumPlace {
  Vec2 position;
  double heading, curvature;
};

/// `s` metres from the begin of the straight that leads along x from the origin, one lap at most.
inline StadiumPlace stadium_place(double s, double radius, double straight) {
  const double half = straight + kPi * radius;
  const bool is_back = s >= half;
  const double on = is_back ? s - half : s;
  const double angle = std::clamp((on - straight) / radius, 0.0, kPi);
  const Vec2 at{std::min(on, straight) + radius * std::sin(angle), radius * (1.0 - std::cos(angle))};
  return {is_back ? Vec2{straight, 2.0 * radius} - at : at, angle + (is_back ? kPi : 0.0),
          angle > 0.0 ? 1.0 / radius : 0.0};
}

/// Points at equal distances on such a line.
inline std::vector<Vec2> even_stadium(int count, double radius, double straight, double begin = 0.0) {
  const double round = 2.0 * straight + kTwoPi * radius;
  std::vector<Vec2> points;
  for (int i = 0; i < count; ++i)
    points.push_back(stadium_place(std::fmod(begin + round * i / count, round), radius, straight).position);
  return points;
}

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
