// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <vector>

#include "chicane/base/vec2.hpp"
#include "chicane/model/state.hpp"
#include "chicane/road/track.hpp"
#include "chicane/sim/plant.hpp"

namespace chicane::sim {

/// Where a car is on its track, and what laps it has driven; lap and sector times are interpolated to the
/// crossing.
struct WorldState {
  static constexpr int kSectors = 3;

  double time = 0.0;  ///< of the last sighting [s]

  double s = 0.0;              ///< arc length of the nearest point of the track's line [m]
  double lateral_error = 0.0;  ///< of the centre of mass from the line [m], left positive
  double heading_error = 0.0;  ///< yaw minus the line's heading [rad], in (−π, π]
  double progress = 0.0;       ///< along the line since the start line, not wrapped [m]; negative before it

  double edge_distance = 0.0;  ///< of the outermost contact patch to the edge [m], negative = off the road
  double min_edge_distance = 0.0;  ///< smallest so far [m]
  bool is_off_track = false;       ///< from edge_distance < 0 on, until it was >= 0.05 m for 0.2 s
  int off_track_events = 0;        ///< times is_off_track became true
  double off_track_time = 0.0;     ///< with edge_distance < 0 [s]

  int lap = 0;                      ///< laps completed; an open track has one
  bool is_timed = false;            ///< the start line has been crossed (or the run began on it)
  bool is_finished = false;         ///< the finish of an open track has been reached
  double lap_time = 0.0;            ///< of the running lap [s]
  double last_lap_time = 0.0;       ///< 0 before the first completed lap [s]
  double best_lap_time = 0.0;       ///< shortest of the completed laps, 0 before the first [s]
  bool last_lap_was_clean = false;  ///< no off-track moment during the last completed lap
  int void_laps = 0;                ///< rounds that left out more than 5 % of the line: not counted

  int sector = 0;                                    ///< [0, kSectors): thirds of the lap
  std::array<double, kSectors> sector_times{};       ///< of the running lap, 0 = not finished yet [s]
  std::array<double, kSectors> last_sector_times{};  ///< of the last completed lap [s]
};

/// A car as an observer beside the road sees it.
struct Sighting {
  model::Pose pose{};
  double speed = 0.0;                    ///< [m/s]
  std::array<Vec2, 4> contact_points{};  ///< Plant::contact_points()
};

/// Where a car is that nobody has followed: of roads that cross under it on the one it goes along.
[[nodiscard]] road::Projection project_anywhere(const road::Track& track, const model::Pose& car) noexcept;

/// Judges a car by what is seen of it, one sighting after the other: where it is on the track, whether all of
/// it is on the road, its laps. Knows no plant: the car may be simulated here (World) or elsewhere.
///
/// The drivable surface reaches to the edge plus the kerb: a patch is off when its outer edge is beyond. The
/// start line lies across the road at Track::start_s(). A lap counts when it is crossed forward for the first
/// time after driving at least 95 % of the line: crossing back and forth counts once, a short cut makes the
/// round void. Between two sightings the car is taken to go evenly. Allocates in the constructor only, cannot
/// fail. One thread.
class Judge {
 public:
  /// `track` must outlive the judge. Call reset() before anything else.
  explicit Judge(const road::Track& track);

  /// A new run from any pose, at `time` [s]. Within 1 m of the start line the first lap is timed from now on,
  /// otherwise from the first crossing. For cars shorter than 1.5 m between the axles all lengths are smaller
  /// in proportion.
  void reset(double time, const Sighting& car) noexcept;
  /// Time rises from sighting to sighting.
  void see(double time, const Sighting& car) noexcept;

  /// The same judgement on a copy of the track, which must outlive the judge.
  void stand_on(const road::Track& track) noexcept { track_ = &track; }

  [[nodiscard]] const WorldState& state() const noexcept { return state_; }
  [[nodiscard]] const road::Track& track() const noexcept { return *track_; }
  [[nodiscard]] const std::vector<road::Corner>& corners() const noexcept { return corners_; }
  /// Of the last completed lap, for each corner with half of the straights beside it [s]; zeros before it.
  [[nodiscard]] std::span<const double> last_corner_times() const noexcept { return last_corner_times_; }

 private:
  void locate(double elapsed, const Sighting& car) noexcept;
  void measure_edges(double elapsed, const Sighting& car) noexcept;
  void time_laps(double progress_before, double elapsed) noexcept;
  void cross_line(double crossing_time) noexcept;
  void start_lap(double crossing_time) noexcept;
  void end_corner(double crossing_time) noexcept;

  const road::Track* track_;
  double size_ = 1.0;          ///< of the car, over one in full size: what is far for it
  double covered_ = 0.0;       ///< of the line since the lap began, without jumps [m]
  double lap_length_ = 0.0;    ///< Track::lap_length()
  double next_line_ = 0.0;     ///< progress at the next crossing of the line [m]
  double lap_start_ = 0.0;     ///< [s]
  double sector_start_ = 0.0;  ///< [s]
  std::vector<road::Corner> corners_;
  std::vector<double> corner_ends_;                       ///< road::corner_sectors()
  std::vector<double> corner_times_, last_corner_times_;  ///< [s]
  std::size_t corner_ = 0;                                ///< of the running lap
  double corner_start_ = 0.0;                             ///< [s]
  double off_track_at_lap_start_ = 0.0;
  double back_on_track_ = 0.0;  ///< how long already [s]
  int lost_for_ = 0;            ///< sightings far from the line
  WorldState state_;
};

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
