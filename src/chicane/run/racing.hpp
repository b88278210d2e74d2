// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string_view>

#include "chicane/base/result.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/lap_time/limit.hpp"
#include "chicane/road/racing_road.hpp"
#include "chicane/road/track.hpp"
#include "chicane/scenario/scenario.hpp"

namespace chicane::run {

/// Whether the scenario's controller races by a line that is planned for the whole road.
[[nodiscard]] bool races(const scenario::Scenario& scenario) noexcept;

/// TrackingMpcOptions::plan_budget of the scenario [s].
[[nodiscard]] double plan_budget(const scenario::Scenario& scenario) noexcept;

/// Whether the scenario's car gets round `track` by what its controller may use of the width.
/// kInvalidArgument "track: hairpins is not for the car indy: the bend at s = ..." names place and radius, or
/// the width.
[[nodiscard]] Result<void> check_room(const scenario::Scenario& scenario, const road::Track& track);

/// What a caller of plan_lap() hears.
struct PlanHooks {
  std::function<void(const lap_time::PlanProgress&)> on_progress{};  ///< after each iteration; may be empty
  std::function<void(std::string_view)> say{};  ///< a line where it is not the optimum; may be empty
};

/// The lap that a scenario's controller races by: the minimum-time line of the car it assumes on `track`,
/// with the shares of grip and brakes and the margin to the edges that its settings leave. Null where the
/// settings do not ask for one, or let it know waypoints only (GuardRoad::kWaypoints), and where the search
/// finds none: the controller then follows its reference. Takes 1 to 30 s (lap_time::plan_racing_line), or
/// milliseconds from the cache (plan_cache.hpp). Where TrackingMpcOptions::plan_budget ends the search, the
/// best plan so far. The same scenario and track give the same bits.
///
/// kInvalidArgument names why there is no such lap: a road that is too narrow or too tight, or
/// must_stop_planning().
[[nodiscard]] Result<std::shared_ptr<const road::RacingRoad>> plan_lap(const scenario::Scenario& scenario,
                                                                       const road::Track* track,
                                                                       const PlanHooks& hooks = {});

/// The lap that a controller wants: with another grip, on `track`, or on a road through waypoints with
/// TrackingMpcOptions::assumed_half_width for the centre of mass each side of them. Null where it is to be
/// the track, and that is null. `go_on` is asked in each iteration; false ends the search. The same scenario,
/// track and request give the same bits.
[[nodiscard]] Result<std::shared_ptr<const road::RacingRoad>> plan_wanted_lap(
    const scenario::Scenario& scenario, const road::Track* track, const controller::LapRequest& request,
    const std::function<bool()>& go_on = {});

}  // namespace chicane::run
