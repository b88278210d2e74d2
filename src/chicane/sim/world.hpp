// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <vector>

#include "chicane/base/vec2.hpp"
#include "chicane/model/state.hpp"
#include "chicane/road/track.hpp"
#include "chicane/sim/plant.hpp"

/// A car on its track: its position along the road, whether it is on it, and its laps.

namespace chicane::sim {

/// Position of a car on its track, and its laps. Lap and sector times are interpolated to the crossing.
struct WorldState {
  static constexpr int kSectors = 3;

  double time = 0.0;  ///< time of the last sighting [s]

  double s = 0.0;              ///< arc length of the nearest point of the track's line [m]
  double lateral_error = 0.0;  ///< offset of the centre of mass from the line [m], left positive
  double heading_error = 0.0;  ///< yaw minus the line's heading [rad], in (−π, π]
  double progress = 0.0;       ///< along the line since the start line, not wrapped [m]; negative before it

  double edge_distance = 0.0;      ///< gap from outermost contact patch to edge [m], negative = off the road
  double min_edge_distance = 0.0;  ///< smallest edge_distance of the run [m]
  bool is_off_track = false;       ///< true from edge_distance < 0 on, until it was >= 0.05 m for 0.2 s
  int off_track_events = 0;        ///< times is_off_track became true
  double off_track_time = 0.0;     ///< total time with edge_distance < 0 [s]

  int lap = 0;                      ///< laps completed; an open track has one
  bool is_timed = false;            ///< the start line has been crossed (or the run began on it)
  bool is_finished = false;         ///< the finish of an open track has been reached
  double lap_time = 0.0;            ///< time since the running lap began [s]
  double last_lap_time = 0.0;       ///< 0 before the first completed lap [s]
  double best_lap_time = 0.0;       ///< shortest of the completed laps, 0 before the first [s]
  bool last_lap_was_clean = false;  ///< no off-track moment during the last completed lap
  int void_laps = 0;                ///< rounds that left out more than 5 % of the line: not counted

  int sector = 0;                                    ///< [0, kSectors): thirds of the lap
  std::array<double, kSectors> sector_times{};       ///< in the running lap, 0 = not finished yet [s]
  std::array<double, kSectors> last_sector_times{};  ///< sectors of the last completed lap [s]
};

/// Observation of a car from beside the road.
struct Sighting {
  model::Pose pose{};
  double speed = 0.0;                    ///< magnitude of the velocity [m/s]
  std::array<Vec2, 4> contact_points{};  ///< Plant::contact_points() [m]
};

/// Projects a car without a previous position; at a crossing, picks the road closest to the heading.
[[nodiscard]] road::Projection project_anywhere(const road::Track& track, const model::Pose& car) noexcept;

/// Judges a car from a sequence of sightings: its position on the track, whether all of it is on the road,
/// and its laps. It needs no plant: the car may be simulated here (World) or elsewhere.
///
/// The drivable surface reaches to the edge plus the kerb: a patch is off when its outer edge is beyond. The
/// start line lies across the road at Track::start_s(). A lap counts when the car crosses it forward for the
/// first time after at least 95 % of the line: crossing back and forth counts once, a short cut makes the lap
/// void. Motion between two sightings is interpolated linearly. Allocates in the constructor only, cannot
/// fail. One thread.
class Judge {
 public:
  /// `track` must outlive the judge. Call reset() before anything else.
  explicit Judge(const road::Track& track);

  /// Starts a new run from any pose, at `time` [s]. Within 1 m of the start line the first lap is timed from
  /// now on, otherwise from the first crossing. For wheelbases below 1.5 m all lengths shrink in proportion.
  void reset(double time, const Sighting& car) noexcept;
  /// Adds a sighting at `time` [s]; times must rise.
  void see(double time, const Sighting& car) noexcept;

  /// Continues the judgement on a copy of the track, which must outlive the judge.
  void stand_on(const road::Track& track) noexcept { track_ = &track; }

  [[nodiscard]] const WorldState& state() const noexcept { return state_; }
  [[nodiscard]] const road::Track& track() const noexcept { return *track_; }
  [[nodiscard]] const std::vector<road::Corner>& corners() const noexcept { return corners_; }
  /// Corner times of the last completed lap, each with half of the straights beside it [s]; zeros before it.
  [[nodiscard]] std::span<const double> last_corner_times() const noexcept { return last_corner_times_; }

 private:
  /// Projects the car on the line, `elapsed` [s] after the previous sighting.
  void locate(double elapsed, const Sighting& car) noexcept;
  /// Measures the gap to the edges, and counts the time off the road.
  void measure_edges(double elapsed, const Sighting& car) noexcept;
  /// Ends the laps, sectors and corners that the car has passed since it was at `progress_before` [m].
  void time_laps(double progress_before, double elapsed) noexcept;
  /// Counts a lap, or voids it, when the car has crossed the start line.
  void cross_line(double crossing_time) noexcept;
  void start_lap(double crossing_time) noexcept;
  void end_corner(double crossing_time) noexcept;

  const road::Track* track_;
  double size_ = 1.0;          ///< scale of distances: size of the car over full size, at most 1
  double covered_ = 0.0;       ///< line covered since the lap began, without jumps [m]
  double lap_length_ = 0.0;    ///< Track::lap_length() [m]
  double next_line_ = 0.0;     ///< progress at the next crossing of the start line [m]
  double lap_start_ = 0.0;     ///< time at which the lap began [s]
  double sector_start_ = 0.0;  ///< time at which the sector began [s]
  std::vector<road::Corner> corners_;
  std::vector<double> corner_ends_;                       ///< road::corner_sectors() [m]
  std::vector<double> corner_times_, last_corner_times_;  ///< corners of the running lap, of the last one [s]
  std::size_t corner_ = 0;                                ///< index of the current corner
  double corner_start_ = 0.0;                             ///< time at which the corner began [s]
  double off_track_at_lap_start_ = 0.0;                   ///< WorldState::off_track_time then [s]
  double back_on_track_ = 0.0;                            ///< time since the car came back on track [s]
  int lost_for_ = 0;                                      ///< successive sightings far from the line
  WorldState state_;
};

/// Plant and judge together: advances the plant, and gives the judge a sighting every 5 ms or every physics
/// step, whichever is longer. Allocates in the constructor only, cannot fail. One thread at a time; returned
/// references change with the next advance(), place() or reset().
class World {
 public:
  /// `plant` and `track` must outlive the world. The car stands at the track's start.
  World(Plant& plant, const road::Track& track);

  /// Starts a new run: the car at arc length s, `offset` to the left of the line [m], heading along it,
  /// rolling at `speed` [m/s].
  void place(double s, double offset, double speed = 0.0) noexcept;
  /// Starts a new run from any pose.
  void reset(const model::Pose& pose, double speed) noexcept;
  /// Starts a new run from any pose and motion; the wheel stands straight.
  void reset(const model::State& start) noexcept;

  /// Continues the run with a car that was driven elsewhere and only observed: its motion at `time` [s].
  /// Times rise.
  void see(double time, const model::State& car) noexcept;

  /// Continues the run with the car standing at `pose`: a simulator has reset it. Lap timing restarts.
  void put(const model::Pose& pose) noexcept;

  /// Moves a copied world to copies of its plant and its track, which must outlive it.
  void stand_on(Plant& plant, const road::Track& track) noexcept;

  /// Advances the plant by one physics step with the command that acts.
  void advance(const model::Command& command) noexcept;

  [[nodiscard]] const WorldState& state() const noexcept { return judge_.state(); }
  [[nodiscard]] const Judge& judge() const noexcept { return judge_; }
  [[nodiscard]] const Plant& plant() const noexcept { return *plant_; }
  [[nodiscard]] const road::Track& track() const noexcept { return judge_.track(); }
  /// Time since reset() [s].
  [[nodiscard]] double time() const noexcept {
    return begin_ + static_cast<double>(step_count_) * plant_->step_length();
  }

 private:
  /// Sighting of the plant.
  [[nodiscard]] Sighting sighting() const noexcept;

  Plant* plant_;
  Judge judge_;
  double begin_ = 0.0;        ///< time at which the steps start to count [s]: 0, or the last see() or put()
  long long step_count_ = 0;  ///< steps since begin_
  int steps_per_judgement_ = 1;  ///< physics steps between two sightings
};

/// Fills measurement.waypoints with the points that telemetry shows for a car at `pose`, and returns their
/// number. By the rule of the original (udacity/self-driving-car-sim v1.45, WaypointTracker) the next
/// waypoint is the nearest one, or its successor if the nearest lies more than 90° off the car's direction.
/// Telemetry shows the waypoint before the next one and those after, `count` in all: around the lap of a
/// closed track, fewer at the end of an open one. Where a road crosses itself (nowhere in the original), the
/// passage along the car's heading counts. `count` is clamped to [0, kMaxWaypoints]. O(points), no
/// allocation.
int select_waypoints(const road::Track& track, const model::Pose& pose, int count,
                     model::Measurement& measurement) noexcept;

}  // namespace chicane::sim
