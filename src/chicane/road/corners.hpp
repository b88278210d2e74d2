// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "chicane/road/track.hpp"

namespace chicane::road {

/// Bend of a road. Places are arc lengths of its line [m], within one lap.
struct Corner {
  double begin = 0.0;
  double apex = 0.0;  ///< sharpest place of the line
  double end = 0.0;   ///< less than `begin` where the corner crosses s = 0 of a closed road
  double turn = 0.0;  ///< change of heading from begin to end [rad], left positive
};

/// Corners of a track in the order in which a lap from the start line meets their apexes; at most
/// `kMostCorners`.
///
/// The curvature of the line is averaged over 14 m. It makes a corner where it is above 1/220 m and the road
/// turns by 0.3 rad or more; bends to the same side with less than 20 m between them are one corner. Roads
/// narrower than 6 m on average are taken for models, and these lengths are smaller in proportion. The
/// dashboard finds the same corners (web/src/state/corners.ts). Allocates.
[[nodiscard]] std::vector<Corner> corners_of(const Track& track);
inline constexpr int kMostCorners = 128;

/// Ends of each corner's part of a lap, as distances from the start line [m]: half-way along the straight
/// to the next corner, the last one at the end of the lap. Empty without corners. Allocates.
[[nodiscard]] std::vector<double> corner_sectors(const Track& track, const std::vector<Corner>& corners);

}  // namespace chicane::road
