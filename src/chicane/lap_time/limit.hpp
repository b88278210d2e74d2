// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "chicane/lap_time/lap_times.hpp"
#include "chicane/lap_time/plant_limit.hpp"
#include "chicane/road/track.hpp"

namespace chicane::lap_time {

/// The bound of a plant as driven laps are compared with it (PlantLimit).
struct Limit {
  LapTimes times;
  std::vector<road::LinePoint> line;  ///< by rising time, from the start line; the last repeats the first
};

/// Times [s] that a closed lap of `track` takes for each of road::corners_of(), with half of the straights
/// beside it: road::corner_sectors(). Between the line's points the time is linear: within 1 ms. Empty for an
/// empty line. Allocates.
[[nodiscard]] std::vector<double> corner_times(const road::Track& track, const road::RacingLine& line);

/// Times and line of the bound, from the start line of `track` on; times of its corners, too.
[[nodiscard]] Limit bound_from_start(const road::Track& track, const PlantLimit& limit);

/// The limit of a run, or in one sentence why there is none (yet).
struct LimitAnswer {
  std::shared_ptr<const Limit> found{};  ///< null: not known
  std::string why_not{};                 ///< empty when it is, or when no reason is known
  int first_lap = 1;  ///< it holds for laps from this one on; before, the car had other grip or mass
  std::vector<LapWithout> without{};  ///< laps that explain the gap to it; empty where they were not driven
};

}  // namespace chicane::lap_time
