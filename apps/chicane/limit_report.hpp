// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "chicane/lap_time/plant_limit.hpp"
#include "chicane/road/track.hpp"

namespace chicane::apps {

/// For whom and what a limit was found, and how long that took.
struct LimitRun {
  std::string track, car;
  bool wants_witness = true;
  double wall_time = 0.0;  ///< [s]
};

[[nodiscard]] std::string to_table(const LimitRun& run, const lap_time::PlantLimit& limit);
/// One JSON object (docs/cli.md).
[[nodiscard]] std::string to_json(const LimitRun& run, const lap_time::PlantLimit& limit);
/// The line of the witness, which was driven, or else of the bound: the columns of a track first, so that it
/// can be driven on, then the whole motion of the car (road::RacingLinePoint).
[[nodiscard]] std::string to_csv(const LimitRun& run, const road::Track& track,
                                 const lap_time::PlantLimit& limit);

}  // namespace chicane::apps
