// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <string>

#include "chicane/base/result.hpp"
#include "chicane/lap_time/plant_limit.hpp"
#include "chicane/road/track.hpp"
#include "chicane/scenario/scenario.hpp"

namespace chicane::apps {

struct LimitQuestion {
  bool wants_witness = true;
  double budget = 600.0;  ///< time of work; the best lap so far is the answer then [s]
};

/// The limit of an experiment's plant, found while the caller waits; tells on stderr how it goes. `wall_time`
/// becomes how long it took [s]. Fails as run::limit_of() does; `wants_stop` ends it.
[[nodiscard]] Result<lap_time::PlantLimit> limit_of(const scenario::Scenario& scenario,
                                                    const road::Track& track, const LimitQuestion& question,
                                                    const std::atomic<bool>& wants_stop, double& wall_time);

/// For whom and what a limit was found, and how long that took.
struct LimitRun {
  std::string track, car;
  double wall_time = 0.0;  ///< [s]
};

[[nodiscard]] std::string to_table(const LimitRun& run, const lap_time::PlantLimit& limit);
/// One JSON object (docs/reference/cli.md).
[[nodiscard]] std::string to_json(const LimitRun& run, const lap_time::PlantLimit& limit);
/// The line of the witness, which was driven, or else of the bound: the columns of a track first, so that it
/// can be driven on, then the whole motion of the car (road::RacingLinePoint).
[[nodiscard]] std::string to_csv(const LimitRun& run, const road::Track& track,
                                 const lap_time::PlantLimit& limit);

}  // namespace chicane::apps
