// SPDX-License-Identifier: MIT
#include "chicane/run/racing.hpp"

#include <tuple>

#include "chicane/controller/registry.hpp"
#include "chicane/lap_time/racing_plan.hpp"

namespace chicane::run {

bool races(const scenario::Scenario& scenario) noexcept {
  using Entry = controller::TrackingMpcEntry;
  return scenario.controller == Entry::kName && std::get<Entry::Options>(scenario.controllers).racing_line;
}

Result<std::shared_ptr<const road::RacingRoad>> plan_lap(const scenario::Scenario& scenario,
                                                         const path::Track* track) {
  using Entry = controller::TrackingMpcEntry;
  const auto& options = std::get<Entry::Options>(scenario.controllers);
  if (!races(scenario) || track == nullptr) return std::shared_ptr<const road::RacingRoad>{};
  const Result<path::RacingLine> lap = lap_time::plan_racing_line(*track, scenario.vehicle,
                                                                  {.margin = options.edge_margin,
                                                                   .grip_share = options.grip_share,
                                                                   .slip_share = options.slip_share,
                                                                   .brake_share = options.brake_share,
                                                                   .speed_limit = options.speed_limit});
  if (!lap) return fail(lap.error());
  return std::make_shared<const road::RacingRoad>(path::line_points(*track, *lap), track->kerb_width());
}

}  // namespace chicane::run
