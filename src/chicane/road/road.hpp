// SPDX-License-Identifier: MIT
// Road: what a controller learns of its road from waypoints, planned into a line to drive by.
#pragma once

#include <array>
#include <span>

#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/road/line_planner.hpp"
#include "chicane/road/reference_line.hpp"
#include "chicane/road/waypoint_map.hpp"

namespace chicane::road {

/// Options for turning waypoints into the road that a controller drives on.
struct RoadOptions {
  double half_width = 3.0;  ///< room for the centre of mass each side of the waypoint line [m]
  /// Largest distance of the reference line from the waypoint line [m]; 0: the waypoint line itself.
  double smoothing_width = 1.5;
  bool remember_waypoints = true;  ///< false: waypoints of the last measurement only
  SpeedPlanOptions speed{};

  friend bool operator==(const RoadOptions&, const RoadOptions&) = default;
};

/// Road as a controller knows it: remembered waypoints, a smooth reference line along them with its speeds,
/// and the room left and right of that line. All memory is reserved at construction.
///
/// Until the loop closes, the line is a stretch from up to 60 m before the first waypoint of the last
/// measurement to its last one, and is planned again with each new waypoint. Then the lap is planned during
/// the drive, with 15 µs of work for each 40 ms, and replaces the stretch when it is ready: after 3 to 5 s
/// for a lap of 1.3 km, however rarely measurements come. So add() is bounded, by about 30 µs when it is
/// called every 40 ms (docs/controller.md), and does the same work for the same measurements.
class Road {
 public:
  Road(const RoadOptions& options, const model::VehicleParams& vehicle);
  /// Forgets all waypoints, and the line.
  void reset() noexcept;
  /// Applies other settings to the same road: if they differ, everything is planned again.
  void configure(const RoadOptions& options, const model::VehicleParams& vehicle) noexcept;

  /// Adds the waypoints of a measurement to the map, and does this cycle's share of the planning.
  void add(const model::Measurement& now) noexcept;

  /// Reference line in the world frame; empty while no waypoints are known.
  [[nodiscard]] const ReferenceLine& line() const noexcept {
    return is_lap_ ? laps_[current_lap_] : stretch_;
  }
  /// Distances that the centre of mass may move to both sides of a line.
  struct Room {
    double left = 0.0;   ///< [m]
    double right = 0.0;  ///< [m]
  };
  /// Room on both sides of the reference line where it is `offset` [m] left of the waypoint line.
  [[nodiscard]] Room room(double offset) const noexcept {
    return {options_.half_width - offset, options_.half_width + offset};
  }
  /// Number that changes with the line. Positions along an older line are invalid.
  [[nodiscard]] unsigned revision() const noexcept { return revision_; }
  /// Waypoints of a closed road in driving order, once its lap is planned; empty before.
  [[nodiscard]] std::span<const Vec2> closed_waypoints() const noexcept {
    return is_lap_ ? map_.points() : std::span<const Vec2>{};
  }

 private:
  // Chosen: 15 µs in a cycle of 40 ms, and a lap of 1.3 km is planned after 3 to 5 s.
  static constexpr double kShare = 0.04;     ///< time that allows one share of planning [s]
  static constexpr int kMostShares = 8;      ///< most shares at one measurement
  static constexpr int kLapWork = 1500;      ///< units of work of LinePlanner in each share, 10 ns each
  static constexpr int kStretchKnots = 128;  ///< limit of a stretch; 380 m, more than six waypoints reach
  static constexpr double kBehind = 60.0;    ///< most of a stretch before the first waypoint seen [m]; chosen

  void configure_planners() noexcept;
  /// Number of shares due at a measurement, by the time since the last one.
  [[nodiscard]] int shares_until(double time) noexcept;
  /// Extends the waypoint line of a closed map up to waypoint `newest`, a few waypoints in each share; then
  /// plans the stretch again.
  void extend_past_seam(int newest, int shares) noexcept;
  void plan_stretch() noexcept;
  /// Continues the plan of the lap by some shares, or begins one.
  void plan_lap(int shares) noexcept;
  /// Number of the waypoint up to which the waypoint line of a closed map has to reach.
  [[nodiscard]] int newest_needed(const model::Measurement& now) const noexcept;

  RoadOptions options_;
  model::VehicleParams vehicle_;
  WaypointMap map_;
  WaypointLine waypoints_;
  LinePlanner stretch_planner_;
  LinePlanner lap_planner_;
  ReferenceLine stretch_;
  std::array<ReferenceLine, 2> laps_;  ///< the current lap, and the one being planned
  std::size_t current_lap_ = 0;        ///< index of the current lap
  unsigned generation_ = 0;            ///< generation of the map that the lines belong to
  unsigned revision_ = 0;              ///< see revision()
  double time_ = 0.0;                  ///< time of the last measurement [s]
  bool is_lap_ = false;                ///< line() is the current lap, not the stretch
  bool is_lap_begun_ = false;          ///< the other lap is being planned
};

}  // namespace chicane::road
