// SPDX-License-Identifier: MIT
#include "chicane/run/track_fit.hpp"

#include <algorithm>

namespace chicane::run {

std::optional<double> distance_to_other_road(const road::Track& track,
                                             const model::Measurement& shown) noexcept {
  int beside = 0;
  double farthest = 0.0;
  for (int i = 0; i < shown.waypoint_count; ++i) {
    const road::Projection foot = track.centre().project(shown.waypoints[static_cast<std::size_t>(i)]);
    if (track.edge_distance(foot) < -kBesideRoad) ++beside;
    farthest = std::max(farthest, foot.distance);
  }
  if (shown.waypoint_count < 2 || 2 * beside < shown.waypoint_count) return std::nullopt;
  return farthest;
}

}  // namespace chicane::run
