// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "chicane/lap_time/lap_times.hpp"
#include "chicane/lap_time/plant_limit.hpp"
#include "chicane/road/road_data.hpp"
#include "chicane/road/track.hpp"

namespace chicane::lap_time {

/// The bound of a plant as driven laps are compared with it (PlantLimit).
struct Limit {
  LapTimes times;
  std::vector<road::LinePoint> line;  ///< by rising time, from the start line; the last repeats the first
};

/// Times and line of the bound, from the start line of `track` on.
[[nodiscard]] Limit bound_from_start(const road::Track& track, const PlantLimit& limit);

/// The limit of a run, or in one sentence why there is none (yet).
struct LimitAnswer {
  std::shared_ptr<const Limit> found{};  ///< null: not known
  std::string why_not{};                 ///< empty when it is, or when no reason is known
  int first_lap = 1;  ///< it holds for laps from this one on; before, the car had other grip or mass
};

}  // namespace chicane::lap_time
