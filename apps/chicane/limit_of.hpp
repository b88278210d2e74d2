// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <memory>
#include <optional>

#include "chicane/base/result.hpp"
#include "chicane/lap_time/minimum_time.hpp"
#include "chicane/lap_time/plant_limit.hpp"
#include "chicane/path/track.hpp"
#include "chicane/scenario/scenario.hpp"

namespace chicane::apps {

/// The limit of an experiment, found while the caller waits; tells on stderr how it goes. `wall_time` becomes
/// how long it took [s]. Fails as find_limit() does; `wants_stop` ends it.
[[nodiscard]] Result<std::shared_ptr<const lap_time::Limit>> limit_of(const scenario::Scenario& scenario,
                                                                      const path::Track& track,
                                                                      std::optional<double> spacing,
                                                                      const std::atomic<bool>& wants_stop,
                                                                      double& wall_time);

/// The bound of the experiment's plant and its witness, or the best lap so far after `budget` of work [s];
/// everything else as limit_of().
[[nodiscard]] Result<lap_time::PlantLimit> plant_limit_of(const scenario::Scenario& scenario,
                                                          const path::Track& track, double budget,
                                                          const std::atomic<bool>& wants_stop,
                                                          double& wall_time);

}  // namespace chicane::apps
