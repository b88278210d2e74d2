// SPDX-License-Identifier: MIT
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
  double smoothing_width =
      1.5;  ///< the reference line may leave the waypoint line by this much [m]; 0 = none
  bool remember_waypoints = true;  ///< false: waypoints of the last measurement only
  SpeedPlanOptions speed{};

  friend bool operator==(const RoadOptions&, const RoadOptions&) = default;
};

/// Road as a controller knows it: remembered waypoints, a smooth reference line along them with its speeds,
/// and the room left and right of it. All memory is reserved at construction.
///
/// Until a lap is known the line reaches from a little behind the car to the last waypoint seen, and is
/// planned again with each new one. When the loop closes, the lap is planned during the drive, kLapWork for
/// each kShare that has passed, and takes over when it is ready: 3 to 5 s for a lap of 1.3 km, however rarely
/// measurements come. So add() is bounded, by about 30 µs when it is called every kShare
/// (docs/controller.md), and does the same work for the same measurements.
class Road {
 public:
  Road(const RoadOptions& options, const model::VehicleParams& vehicle);
  void reset() noexcept;
  /// Applies other settings to the same road: if they differ, everything is planned again.
  void configure(const RoadOptions& options, const model::VehicleParams& vehicle) noexcept;

  /// Takes in the waypoints of a measurement, and does this cycle's share of the planning.
  void add(const model::Measurement& now) noexcept;

  /// The reference line in W; empty while nothing is known.
  [[nodiscard]] const ReferenceLine& line() const noexcept {
    return is_lap_ ? laps_[current_lap_] : stretch_;
  }
  struct Room {
    double left = 0.0;   ///< [m]
    double right = 0.0;  ///< [m]
  };
  /// Room for the centre of mass on both sides of the reference line where it has moved sideways by `offset`
  /// [m].
  [[nodiscard]] Room room(double offset) const noexcept {
    return {options_.half_width - offset, options_.half_width + offset};
  }
  /// Number of the line: positions along an older one are void.
  [[nodiscard]] unsigned revision() const noexcept { return revision_; }
  /// The waypoints of a closed road in driving order, once its lap is planned; empty before.
  [[nodiscard]] std::span<const Vec2> closed_waypoints() const noexcept {
    return is_lap_ ? map_.points() : std::span<const Vec2>{};
  }

 private:
  static constexpr double kShare = 0.04;     ///< [s] of driving that pay for one share of planning
  static constexpr int kMostShares = 8;      ///< limit in one measurement, however long ago the last one is
  static constexpr int kLapWork = 1500;      ///< units of LinePlanner in each share
  static constexpr int kStretchKnots = 128;  ///< 380 m
  static constexpr double kBehind = 60.0;    ///< [m] start of the line behind the first waypoint seen

  void configure_planners() noexcept;
  [[nodiscard]] int shares_until(double time) noexcept;
  void go_round(int newest, int shares) noexcept;
  void plan_stretch() noexcept;
  void plan_lap(int shares) noexcept;
  [[nodiscard]] int newest_needed(const model::Measurement& now) const noexcept;

  RoadOptions options_;
  model::VehicleParams vehicle_;
  WaypointMap map_;
  WaypointLine waypoints_;
  LinePlanner stretch_planner_;
  LinePlanner lap_planner_;
  ReferenceLine stretch_;
  std::array<ReferenceLine, 2> laps_;  ///< one to drive by, one to be planned
  std::size_t current_lap_ = 0;
  unsigned generation_ = 0;  ///< generation of the map that the lines belong to
  unsigned revision_ = 0;
  double time_ = 0.0;          ///< time of the last measurement [s]
  bool is_lap_ = false;        ///< the current lap is driven by
  bool is_lap_begun_ = false;  ///< the other one is being planned
};

}  // namespace chicane::road
