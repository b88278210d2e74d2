// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "chicane/base/owned.hpp"
#include "chicane/model/braking_stability.hpp"
#include "chicane/model/prediction.hpp"
#include "chicane/road/known_road.hpp"
#include "chicane/safety/stop_planner.hpp"
#include "chicane/tracking/tracking_problem.hpp"
#include "chicane/tracking/tracking_solver.hpp"

namespace chicane::safety {

/// Searches for the stop that a law does not find, where a car is near the limit of its tyres: with
/// foresight, it brakes where the road leaves the grip for it (docs/safety_derivation.md, "The stop", eq.
/// 5a). The optimal control problem of the default controller with another aim: standing instead of fast.
///
/// Memory is reserved at construction; one thread. Each search begins with what the last one found.
class StopSearch {
 public:
  explicit StopSearch(const model::VehicleParams& vehicle);
  void set_vehicle(const model::VehicleParams& vehicle) noexcept;
  /// The last stop found is of no use any more: another road, another run.
  void forget() noexcept { has_last_ = false; }

  /// The stop from `start` on; `planner` ends it where the car is slow, and begins the search where there is
  /// no last stop. Pre: the road is not empty, `start` is finite.
  [[nodiscard]] StopCheck plan(const road::KnownRoad& road, const StopStart& start, double margin,
                               const StopPlanner& planner, StopCourse& out) noexcept;

 private:
  using Problem = tracking::TrackingProblem;

  void guess_from_last(const road::KnownRoad& road, const StopStart& start) noexcept;
  void guess_from_line(const road::KnownRoad& road, const StopStart& start) noexcept;
  [[nodiscard]] int stages(const road::KnownRoad& road, const StopStart& start) const noexcept;
  [[nodiscard]] double aimed(const road::KnownRoad& road, double s0, const Problem::State& x) const noexcept;
  [[nodiscard]] StopCheck tell(const road::KnownRoad& road, const StopStart& start,
                               const StopPlanner& planner, StopCourse& out) const noexcept;
  void ask_road(const road::KnownRoad& road, double s0, int k) noexcept;

  model::PredictionModel model_;
  model::BrakingStability stability_;
  Problem problem_;
  Owned<tracking::TrackingSolver> solver_;
  tracking::TrackingTrajectory now_, last_;
  double s_ = 0.0;     ///< where last_ begins [m]
  double time_ = 0.0;  ///< and when [s]
  bool has_last_ = false;
  bool is_careful_ = false;  ///< braking that leaves a pole that feedback can catch is aimed at, and no more
};

}  // namespace chicane::safety
