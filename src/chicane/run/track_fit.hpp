// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "chicane/model/state.hpp"
#include "chicane/road/track.hpp"

namespace chicane::run {

/// Waypoints may lie so far beyond a road's edge and still be its [m]: maps of one road differ.
inline constexpr double kBesideRoad = 5.0;

/// Whether the waypoints that are shown belong to another road than `track`: at least half of them, of two or
/// more, lie more than kBesideRoad beyond its edges. Then the distance of the farthest from its line [m],
/// otherwise nothing. Cost: a search of the whole line for each waypoint.
[[nodiscard]] std::optional<double> distance_to_other_road(const road::Track& track,
                                                           const model::Measurement& shown) noexcept;

}  // namespace chicane::run
