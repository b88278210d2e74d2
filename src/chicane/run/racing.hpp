// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <span>

#include "chicane/base/result.hpp"
#include "chicane/base/vec2.hpp"
#include "chicane/path/track.hpp"
#include "chicane/road/racing_road.hpp"
#include "chicane/scenario/scenario.hpp"

namespace chicane::run {

/// Whether the scenario's controller races by a line that is planned for the whole road.
[[nodiscard]] bool races(const scenario::Scenario& scenario) noexcept;

/// The lap that a scenario's controller races by: the minimum-time line of the car it believes in on `track`,
/// with the shares of grip and brakes and the margin to the edges that its settings leave. Null where the
/// settings do not ask for one, or let it know waypoints only (GuardRoad::kWaypoints). Takes 1 to 30 s
/// (lap_time::plan_racing_line); the same scenario and track give the same bits.
///
/// kInvalidArgument names why there is no such lap: an open road, one that is too narrow or too tight.
[[nodiscard]] Result<std::shared_ptr<const road::RacingRoad>> plan_lap(const scenario::Scenario& scenario,
                                                                       const path::Track* track);

/// The same on a road of which only its waypoints are known, closed and in driving order, with
/// TrackingMpcOptions::assumed_half_width for the centre of mass each side of them. `go_on` is asked in each
/// iteration; false ends the search. The same scenario and waypoints give the same bits.
[[nodiscard]] Result<std::shared_ptr<const road::RacingRoad>> plan_learned_lap(
    const scenario::Scenario& scenario, std::span<const Vec2> waypoints,
    const std::function<bool()>& go_on = {});

}  // namespace chicane::run
