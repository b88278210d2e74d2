// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>

#include "chicane/base/result.hpp"
#include "chicane/lap_time/plant_limit.hpp"
#include "chicane/road/track.hpp"
#include "chicane/scenario/scenario.hpp"

namespace chicane::apps {

struct LimitQuestion {
  bool wants_witness = true;
  double budget = 600.0;  ///< of work; then the best lap so far is the answer [s]
};

/// The limit of an experiment's plant, found while the caller waits; tells on stderr how it goes. `wall_time`
/// becomes how long it took [s]. Fails as run::limit_of() does; `wants_stop` ends it.
[[nodiscard]] Result<lap_time::PlantLimit> limit_of(const scenario::Scenario& scenario,
                                                    const road::Track& track, const LimitQuestion& question,
                                                    const std::atomic<bool>& wants_stop, double& wall_time);

}  // namespace chicane::apps
