// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "chicane/base/result.hpp"
#include "chicane/path/track.hpp"
#include "chicane/road/racing_road.hpp"
#include "chicane/scenario/scenario.hpp"

namespace chicane::run {

/// Whether the scenario's controller races by a line that is planned for the whole road.
[[nodiscard]] bool races(const scenario::Scenario& scenario) noexcept;

/// The lap that a scenario's controller races by: the minimum-time line of the car it believes in on `track`,
/// with the shares of grip and brakes and the margin to the edges that its settings leave. Null where the
/// settings do not ask for one. Takes 1 to 15 s (lap_time::plan_racing_line); the same scenario and track
/// give the same bits.
///
/// kInvalidArgument names why there is no such lap: an open road, one that is too narrow or too tight.
[[nodiscard]] Result<std::shared_ptr<const road::RacingRoad>> plan_lap(const scenario::Scenario& scenario,
                                                                       const path::Track* track);

}  // namespace chicane::run
