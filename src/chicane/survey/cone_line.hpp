// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/base/vec2.hpp"
#include "chicane/road/track.hpp"

namespace chicane::survey {

/// Cones as Formula Student has them: blue ones left of the road, yellow ones right.
struct Cones {
  std::vector<Vec2> left = {}, right = {};  ///< in any order [m]
  std::vector<Vec2> either = {};            ///< orange: of the nearer side
};

/// A place where a side has no cone for much longer than elsewhere.
struct ConeGap {
  bool is_left = true;
  Vec2 place{};         ///< the middle of the gap
  double length = 0.0;  ///< [m]
};

struct ConeRoad {
  std::vector<road::TrackPoint> points = {};  ///< evenly spaced, in the direction that has `left` on its left
  bool is_closed = true;
  std::vector<ConeGap> gaps = {};
  double median_width = 0.0;  ///< [m]
};

/// The line as far from the left cones as from the right ones, each side joined to a fence in its order along
/// the road: first found from the cones alone, then from the fences, so that it does not swing between cones.
/// Cones may be missing; a gap is named where it is more than 1.6 times as long as those beside it.
///
/// kParse for fewer than three cones on a side, more than 20,000, a road longer than 20 km, and cones between
/// which there is no line.
[[nodiscard]] Result<ConeRoad> line_between(const Cones& cones);

}  // namespace chicane::survey
