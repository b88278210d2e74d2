// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/base/vec2.hpp"
#include "chicane/model/measurement.hpp"
#include "chicane/model/state.hpp"
#include "chicane/road/track.hpp"
#include "chicane/sim/judge.hpp"
#include "chicane/sim/plant.hpp"

namespace chicane::sim {

/// A car on a track: advances the plant, and has a judge look at it every 5 ms or every physics step,
/// whichever is longer, by the plant's own contact patches. Allocates in the constructor only, cannot fail.
/// One thread at a time; what it returns by reference changes with the next advance(), place() or reset().
class World {
 public:
  /// Both must outlive the world. The car stands at the track's start.
  World(Plant& plant, const road::Track& track);

  /// A new run: the car at arc length s, `offset` to the left of the line [m], heading along it, rolling at
  /// `speed` [m/s].
  void place(double s, double offset, double speed = 0.0) noexcept;
  /// A new run from any pose.
  void reset(const model::Pose& pose, double speed) noexcept;
  /// A new run from any pose and motion; the wheel stands straight.
  void reset(const model::State& start) noexcept;

  /// The car is there at `time` [s] of the run that goes on, moving like this: it was driven elsewhere, and
  /// only seen. Times rise.
  void see(double time, const model::State& car) noexcept;

  /// The car stands at `pose` from now on, in the run that goes on: a simulator has reset it. Laps begin
  /// anew.
  void put(const model::Pose& pose) noexcept;

  /// A copy of a world goes on with copies of its plant and its track, which must outlive it.
  void stand_on(Plant& plant, const road::Track& track) noexcept;

  /// One physics step of the plant with the command that acts.
  void advance(const model::Command& command) noexcept;

  [[nodiscard]] const WorldState& state() const noexcept { return judge_.state(); }
  [[nodiscard]] const Judge& judge() const noexcept { return judge_; }
  [[nodiscard]] const Plant& plant() const noexcept { return *plant_; }
  [[nodiscard]] const road::Track& track() const noexcept { return judge_.track(); }
  /// Since reset() [s].
  [[nodiscard]] double time() const noexcept {
    return begin_ + static_cast<double>(step_count_) * plant_->step_length();
  }

 private:
  [[nodiscard]] Sighting sighting() const noexcept;

  Plant* plant_;
  Judge judge_;
  double begin_ = 0.0;        ///< steps count from there [s]: 0, or where the car was last seen
  long long step_count_ = 0;  ///< since then
  int steps_per_judgement_ = 1;
};

/// Fills measurement.waypoints with the points telemetry shows for a car at (x, y, psi), by the rule of the
/// original (udacity/self-driving-car-sim v1.45, WaypointTracker): the nearest waypoint, or its successor
/// when that lies more than 90° off the car's direction, is next; shown are the one before it and those
/// after, `count` in all, around the lap when the track is closed, fewer at the end of an open one. Where a
/// road crosses itself, which the original has nowhere, they are those of the passage along the car. Returns
/// how many. count is clamped to [0, kMaxWaypoints]. O(points), no allocation.
int select_waypoints(const road::Track& track, const model::Pose& pose, int count,
                     model::Measurement& measurement) noexcept;

}  // namespace chicane::sim
