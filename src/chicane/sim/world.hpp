// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "chicane/base/types.hpp"
#include "chicane/model/measurement.hpp"
#include "chicane/model/state.hpp"
#include "chicane/path/track.hpp"
#include "chicane/sim/plant.hpp"

namespace chicane::sim {

/// What the world says about the car on its track. Judged every 5 ms or every physics step, whichever is
/// longer; the lap and sector times are interpolated to the crossing.
struct WorldState {
  static constexpr int kSectors = 3;

  double time = 0.0;  ///< since reset() [s]

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
  bool is_finished = false;         ///< the end of an open track has been reached
  double lap_time = 0.0;            ///< of the running lap [s]
  double last_lap_time = 0.0;       ///< 0 before the first completed lap [s]
  double best_lap_time = 0.0;       ///< shortest of the completed laps, 0 before the first [s]
  bool last_lap_was_clean = false;  ///< no off-track moment during the last completed lap
  int void_laps = 0;                ///< rounds that left out more than 5 % of the line: not counted

  int sector = 0;                                    ///< [0, kSectors): thirds of the lap
  std::array<double, kSectors> sector_times{};       ///< of the running lap, 0 = not finished yet [s]
  std::array<double, kSectors> last_sector_times{};  ///< of the last completed lap [s]
};

/// A car on a track: advances the plant and judges where it is, by the plant's own contact patches and the
/// track's edges.
///
/// The drivable surface reaches to the edge plus the kerb: a patch is off when its outer edge is beyond. The
/// start line lies across the road at Track::start_s(). A lap counts when it is crossed forward for the first
/// time after driving at least 95 % of the line: crossing back and forth counts once, a short cut makes the
/// round void. Allocates nothing, cannot fail. One thread.
class World {
 public:
  /// Both must outlive the world. The car stands at the track's start.
  World(Plant& plant, const path::Track& track) noexcept;

  /// A new run: the car at arc length s, `offset` to the left of the line [m], heading along it, rolling at
  /// `speed` [m/s].
  void place(double s, double offset, double speed = 0.0) noexcept;
  /// A new run from any pose. Within 1 m of the start line the first lap is timed from now on, otherwise from
  /// the first crossing.
  void reset(const model::Pose& pose, double speed) noexcept;

  /// One physics step of the plant with the command that acts.
  void advance(const model::Command& command) noexcept;

  [[nodiscard]] const WorldState& state() const noexcept { return state_; }
  [[nodiscard]] const Plant& plant() const noexcept { return plant_; }
  [[nodiscard]] const path::Track& track() const noexcept { return track_; }
  /// Since reset() [s].
  [[nodiscard]] double time() const noexcept {
    return static_cast<double>(step_count_) * plant_.step_length();
  }

 private:
  void judge() noexcept;
  void locate(double elapsed) noexcept;
  void measure_edges(double elapsed) noexcept;
  void time_laps(double progress_before, double elapsed) noexcept;
  void cross_line(double crossing_time) noexcept;
  void start_lap(double crossing_time) noexcept;

  Plant& plant_;
  const path::Track& track_;
  long long step_count_ = 0;
  int steps_per_judgement_ = 1;
  double covered_ = 0.0;       ///< of the line since the lap began, without jumps [m]
  double lap_length_ = 0.0;    ///< from the start line to itself, or to the end of an open track [m]
  double next_line_ = 0.0;     ///< progress at the next crossing of the line [m]
  double lap_start_ = 0.0;     ///< [s]
  double sector_start_ = 0.0;  ///< [s]
  double off_track_at_lap_start_ = 0.0;
  double back_on_track_ = 0.0;  ///< how long already [s]
  int lost_for_ = 0;            ///< judgements far from the line
  WorldState state_;
};

/// Fills measurement.waypoints with the points telemetry shows for a car at (x, y, psi), by the rule of the
/// original (udacity/self-driving-car-sim v1.45, WaypointTracker): the nearest waypoint, or its successor
/// when that lies more than 90° off the car's direction, is next; shown are the one before it and those
/// after, `count` in all, around the lap when the track is closed, fewer at the end of an open one. Returns
/// how many. count is clamped to [0, kMaxWaypoints]. O(points), no allocation.
int select_waypoints(const path::Track& track, const model::Pose& pose, int count,
                     model::Measurement& measurement) noexcept;

}  // namespace chicane::sim
