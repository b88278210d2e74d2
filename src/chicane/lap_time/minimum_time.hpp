// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/lap_time/lap_times.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/path/road_data.hpp"
#include "chicane/path/track.hpp"

namespace chicane::lap_time {

/// How good a limit is (docs/limit.md, section 11).
struct LimitReport {
  int rounds = 0;             ///< problems solved one after the other
  int iterations = 0;         ///< turns of the solver in all of them
  int stages = 0;             ///< of one problem
  double spacing = 0.0;       ///< of the stages along the track's line [m]
  double stationarity = 0.0;  ///< of the last problem (solver::SolveReport)
  double last_offset = 0.0;   ///< how far the last round moved the line [m]
  double last_change = 0.0;   ///< by how much it changed the lap time, relative
  double seam_offset = 0.0;   ///< between the lap's end and its beginning: across [m]
  double seam_speed = 0.0;    ///< and in speed [m/s]
  double violation = 0.0;     ///< largest violation of a constraint: [m] of an edge, else relative
};

/// The fastest lap of a car that follows its path on a closed road (docs/limit.md, sections 7 to 11): the
/// quick limit. No bound for a plant, which has tyres and a body that slides: see find_plant_limit().
struct Limit {
  LapTimes times;
  double mean_speed = 0.0;            ///< length of the line over lap time [m/s]
  double top_speed = 0.0;             ///< [m/s]
  double least_speed = 0.0;           ///< [m/s]
  double line_length = 0.0;           ///< of the racing line [m]
  std::vector<path::LinePoint> line;  ///< by rising time, from the start line; the last repeats the first
  LimitReport report;
};

struct LimitOptions {
  double spacing = 2.0;  ///< of the stages along the track's line [m]; [0.5, 5]; raised on very long roads
  int most_rounds = 200;
  /// Told the round and the lap time after each round; false ends the search. May be empty.
  std::function<bool(int round, double lap_time)> go_on{};
};

/// Finds the limit. Takes 1 to 30 s; about 100 MB while it does. Deterministic: the same road, car and
/// options give the same bits. Keeps nothing between calls: several threads may search at once.
///
/// kInvalidArgument for a model car, an open road, a road narrower than the car (names the place), options
/// out of range, parameters that validate() refuses, and for a search that ended without an optimum: the
/// message says how far it came.
[[nodiscard]] Result<Limit> find_limit(const path::Track& track, const model::VehicleParams& vehicle,
                                       const LimitOptions& options = {});

}  // namespace chicane::lap_time
