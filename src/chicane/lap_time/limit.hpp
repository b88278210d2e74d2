// SPDX-License-Identifier: MIT
// The fastest lap that a simulated car can drive on a closed road: search, result, and comparison of driven
// laps with it.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/road/racing_road.hpp"
#include "chicane/road/track.hpp"
#include "chicane/sim/double_track.hpp"
#include "chicane/sim/plant.hpp"

namespace chicane::lap_time {

/// Times of a lap and of its thirds from the start line on [s].
struct LapTimes {
  double lap = 0.0;
  std::array<double, 3> sectors{};
  std::vector<double> corners{};  ///< times of corners, each with half of the straights beside it
};

/// Best lap of a run that was repeated without one cause of lost time (run/racing.hpp).
struct LapWithout {
  std::string cause;                                           ///< name of the cause: "latency"
  double lap_time = std::numeric_limits<double>::quiet_NaN();  ///< [s]; not-a-number: no lap was completed
  std::vector<double> corners{};  ///< times as LapTimes::corners; empty without a lap
  int off_track_events = 0;       ///< count in the whole run
};

/// Excess of `time` over the limit, relative: 0.05 is five per cent slower. Not-a-number for a time that was
/// not measured. Pre: limit > 0.
[[nodiscard]] constexpr double gap(double time, double limit) noexcept { return time / limit - 1.0; }

/// Progress of a search for a lap. Work is counted, not measured: the same search takes the same work on
/// every machine, so that a budget ends it at the same iterate.
struct PlanProgress {
  double work = 0.0;      ///< work so far: iterations · nodes / kNodesPerSecond [s]
  double expected = 0.0;  ///< work of a search without retries [s]; limited by the budget
  double lap_time = 0.0;  ///< lap time of the iterate [s]

  static constexpr double kNodesPerSecond = 12000.0;  ///< nodes of an iteration that a core does in a second
};

/// Laps driven in the plant, with its whole state and without latency: the plan's commands plus feedback
/// towards the plan.
struct Witness {
  double lap_time = 0.0;    ///< fastest lap [s]
  double worst = 0.0;       ///< slowest lap [s]
  int laps = 0;             ///< laps in succession, without a boundary event
  double least_edge = 0.0;  ///< gap from a contact patch to the edge of the drivable surface [m]
  road::RacingLine line;    ///< line that was driven; its margin is the planned gap
};

/// Reason of a lap that is the best so far though no budget ended its search.
inline constexpr const char* kNoOptimum = "with more slip of the tyres the search finds no optimum";

/// Effort of a search; work as in PlanProgress.
struct SearchEffort {
  int iterations = 0;
  double work = 0.0;  ///< [s]
};

/// Limit of a simulated car on a closed road (docs/limit.md): the optimum of the plant's equations, which no
/// controller should beat, and the best lap that was driven. The fastest possible lap lies between the two.
struct PlantLimit {
  LapTimes bound;                    ///< times of the optimum [s]
  road::RacingLine line;             ///< line of the optimum, without reserve; no bound if is_best_so_far
  std::optional<Witness> witness{};  ///< empty: no plan could be driven without an event, or none was wanted
  bool is_cut_short = false;         ///< the budget ended the search for the witness
  int nodes = 0;                     ///< nodes of the optimum
  SearchEffort effort{};             ///< effort of all searches
  SearchEffort of_optimum{};         ///< effort of the search without reserve
  double stationarity = 0.0;         ///< largest slope of the Lagrangian at the optimum, scaled
  double violation = 0.0;            ///< largest violated equation or inequality, scaled

  /// Whether the bound is one and no budget ended a search: the answer is the same without one.
  [[nodiscard]] bool is_whole() const noexcept { return !line.is_best_so_far && !is_cut_short; }
  /// Excess of the witness over the bound, relative; not-a-number without a bound.
  [[nodiscard]] double bracket() const noexcept;
};

/// Options of find_plant_limit().
struct PlantLimitOptions {
  double time_step = 0.08;    ///< time between nodes, about [s]; [0.01, 0.2]
  bool wants_witness = true;  ///< also drives plans in the plant
  int laps = 4;               ///< laps of the witness, after a flying start
  /// Limit of the work [s], > 0 (PlanProgress). The best lap so far is the answer then.
  double budget = std::numeric_limits<double>::infinity();
  /// Called after each iteration with its stage, its number and its lap time [s]. False ends the search. May
  /// be empty.
  std::function<bool(std::string_view stage, int iteration, double lap_time)> go_on{};
  std::function<void(const PlanProgress&)> on_progress{};  ///< progress towards the optimum; may be empty
};

/// Finds the limit of a plant on a track. Takes 1 to 60 s and some 10 MB. Deterministic. Keeps nothing
/// between calls.
///
/// `params`: parameters of the plant `double-track`. Fails with kNotFound for a plant without a limit model;
/// with kInvalidArgument for an open road, a road too narrow for the car or with a bend too tight for its
/// full lock (with the place and the radius), options out of range, and a search that ended without an
/// optimum.
[[nodiscard]] Result<PlantLimit> find_plant_limit(const road::Track& track, std::string_view plant,
                                                  const sim::PlantDeviation& deviation = {},
                                                  const PlantLimitOptions& options = {},
                                                  const sim::DoubleTrackParams& params = {});

/// Bound of a plant (PlantLimit) for comparison with driven laps.
struct Limit {
  LapTimes times;
  std::vector<road::LinePoint> line;  ///< points by time from the start line; the last repeats the first
};

/// Times [s] of the corners of `track` in a closed lap, each with half of the straights beside it
/// (road::corner_sectors()). Time is interpolated linearly between the line's points: within 1 ms. Empty for
/// an empty line. Allocates.
[[nodiscard]] std::vector<double> corner_times(const road::Track& track, const road::RacingLine& line);

/// Times and line of the bound, from the start line of `track` on, with the times of its corners.
[[nodiscard]] Limit bound_from_start(const road::Track& track, const PlantLimit& limit);

/// Limit of a run, or one sentence on why it is not known.
struct LimitAnswer {
  std::shared_ptr<const Limit> found{};  ///< the limit; null: not known
  std::string why_not{};                 ///< reason of an unknown limit; may be empty
  int first_lap = 1;                     ///< first lap with the limit's grip and mass
  std::vector<LapWithout> without{};     ///< laps that explain the gap to the limit; empty: not driven
};

}  // namespace chicane::lap_time
