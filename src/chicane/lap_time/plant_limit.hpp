// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "chicane/base/result.hpp"
#include "chicane/lap_time/lap_times.hpp"
#include "chicane/lap_time/plan_progress.hpp"
#include "chicane/road/road_data.hpp"
#include "chicane/road/track.hpp"
#include "chicane/sim/double_track.hpp"
#include "chicane/sim/plant.hpp"

namespace chicane::lap_time {

/// Laps that were really driven in the plant: with its whole state, without latency, what a plan asks for
/// plus feedback towards it.
struct Witness {
  double lap_time = 0.0;    ///< the best of them [s]
  double worst = 0.0;       ///< and the slowest [s]
  int laps = 0;             ///< in succession, without a boundary event since the start
  double least_edge = 0.0;  ///< of a contact patch to the edge of the drivable surface [m]
  road::RacingLine line;    ///< that was driven after; its margin is what it planned to keep
};

/// What a search took; work as PlanProgress counts it.
struct SearchEffort {
  int iterations = 0;
  double work = 0.0;  ///< [s]
};

/// The fastest lap of a simulated car on a closed road (docs/limit.md): the optimum of the plant's own
/// equations, which no controller should beat, and the best lap that was driven. The truth lies between.
struct PlantLimit {
  LapTimes bound;         ///< of the optimum [s]
  road::RacingLine line;  ///< of the optimum, without any reserve; no bound where it is_best_so_far
  std::optional<Witness>
      witness{};              ///< none: no plan could be driven without an event, or none was asked for
  bool is_cut_short = false;  ///< the budget ended the search for the witness
  int nodes = 0;              ///< of the optimum
  SearchEffort effort{};      ///< of all searches
  SearchEffort of_optimum{};  ///< of the one without reserve alone
  double stationarity = 0.0;  ///< of the optimum: largest slope of the Lagrangian, scaled
  double violation = 0.0;     ///< largest violated equation or inequality, scaled

  /// No budget ended a search: the same answer as without one.
  [[nodiscard]] bool is_whole() const noexcept { return !line.is_best_so_far && !is_cut_short; }
  /// How much slower the witness is than the bound, relative; not-a-number without one.
  [[nodiscard]] double bracket() const noexcept;
};

struct PlantLimitOptions {
  double time_step = 0.08;  ///< between nodes, about [s]; [0.01, 0.2]
  bool wants_witness = true;
  int laps = 4;  ///< of the witness, after a flying start
  /// Work after which the best lap so far is the answer (PlanProgress) [s], > 0.
  double budget = std::numeric_limits<double>::infinity();
  /// Called with the progress, and the lap time, after each iteration; false ends the search. May be empty.
  std::function<bool(std::string_view stage, int iteration, double lap_time)> go_on{};
  std::function<void(const PlanProgress&)> on_progress{};  ///< of the optimum; may be empty
};

/// Finds it. Takes 1 to 60 s and some 10 MB. Deterministic. Keeps nothing between calls.
///
/// `params`: of the plant `double-track`. kNotFound for a plant that has no model here; kInvalidArgument for
/// an open road, a road too narrow for the car or with a bend too tight for its full lock (names the place
/// and the radius), options out of range, and for a search that ended without an optimum.
[[nodiscard]] Result<PlantLimit> find_plant_limit(const road::Track& track, std::string_view plant,
                                                  const sim::PlantDeviation& deviation = {},
                                                  const PlantLimitOptions& options = {},
                                                  const sim::DoubleTrackParams& params = {});

}  // namespace chicane::lap_time
