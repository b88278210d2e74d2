// SPDX-License-Identifier: MIT
// Waypoints of telemetry as a map of the road: WaypointMap has the points, WaypointLine the curve through
// them.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "chicane/base/vec2.hpp"
#include "chicane/model/state.hpp"
#include "chicane/road/path.hpp"
#include "chicane/road/reference_line.hpp"

namespace chicane::road {

/// Waypoints of all measurements so far in driving order, closed into a loop as soon as the first one is seen
/// again. Telemetry repeats waypoints exactly, so two closer than kSame are one.
///
/// Memory for kCapacity waypoints is reserved at construction; add() allocates nothing. A measurement starts
/// a new map if no waypoint of it is known (another scene, or a car that was moved), if its waypoints do not
/// fit the capacity, or if, before the map is closed, it has two waypoints before the map's first.
class WaypointMap {
 public:
  static constexpr int kCapacity = 4096;  ///< waypoints
  static constexpr double kSame = 0.3;    ///< [m] chosen: far below the spacing of waypoints

  WaypointMap();
  void clear() noexcept;
  /// Adds the waypoints of a measurement. True when the map changed.
  [[nodiscard]] bool add(const model::Measurement& now) noexcept;

  [[nodiscard]] std::span<const Vec2> points() const noexcept { return points_; }
  [[nodiscard]] bool is_closed() const noexcept { return is_closed_; }
  /// Index in the map of the first known waypoint of the last measurement that had one.
  [[nodiscard]] int first_seen() const noexcept { return hint_; }
  /// Count of restarts of the map.
  [[nodiscard]] unsigned generation() const noexcept { return generation_; }

 private:
  enum class Loop { kOpen, kClosed, kUndecided };
  /// Whether waypoint `i` of a measurement is the first one of the map again.
  [[nodiscard]] Loop closes(std::span<const Vec2> seen, std::size_t i) const noexcept;
  /// Index of a known waypoint at `point`; −1: none.
  [[nodiscard]] int find(const Vec2& point) const noexcept;

  std::vector<Vec2> points_;
  bool is_closed_ = false;
  unsigned generation_ = 0;
  int hint_ = 0;  ///< see first_seen(); find() begins there
};

/// Curve through the waypoints as they become known: a C² spline through the newest ones, stored as evenly
/// spaced knots. The effect of a new waypoint on the spline falls to a quarter from each waypoint to the one
/// before. A piece with kSettled waypoints ahead is settled: it is stored for good, and only the part beyond
/// it is computed again.
///
/// Numbers of waypoints go on beyond the end of a lap: n + i is waypoint i of a closed map of n waypoints.
/// Memory is reserved at construction; extend() allocates nothing and takes a few µs, bounded by kReach.
class WaypointLine {
 public:
  static constexpr double kSpacing = 3.0;      ///< spacing of the knots [m]
  static constexpr int kCapacity = 8192;       ///< knots: a lap of 24 km
  static constexpr int kMostWaypoints = 4608;  ///< a full map and 512 waypoints of its second lap
  static constexpr int kSettled = 5;           ///< waypoints ahead after which a piece is settled
  static constexpr double kTail = 15.0;        ///< length of the curve beyond the newest waypoint [m]
  static constexpr double kReach = 1500.0;     ///< longest stretch computed at once [m]; bounds the time

  WaypointLine();
  void clear() noexcept;

  /// Extends the curve to waypoint number `newest`. False, and no change, for fewer than two waypoints,
  /// coordinates out of range, more than kReach that is not settled, or beyond the capacity.
  bool extend(const WaypointMap& map, int newest) noexcept;

  /// Last waypoint of the curve; −1: no curve.
  [[nodiscard]] int newest() const noexcept { return newest_; }
  /// Whether the next stretch may be beyond the capacity.
  [[nodiscard]] bool is_full() const noexcept {
    return newest_ >= 0 &&
           (along(newest_) > kCapacity * kSpacing - kReach || newest_ > kMostWaypoints - kWindow);
  }
  /// Last waypoint of the settled part.
  [[nodiscard]] int settled() const noexcept { return settled_; }
  /// Arc length at a waypoint up to newest() [m].
  [[nodiscard]] double along(int waypoint) const noexcept {
    return along_[static_cast<std::size_t>(waypoint)];
  }
  /// Point at arc length s >= 0 [m]; the curve continues straight for at least kTail beyond the newest
  /// waypoint.
  [[nodiscard]] CurvePoint at(double s) const noexcept;

 private:
  static constexpr int kWindow = 48;  ///< waypoints of one spline
  /// Adds the knot at arc length s, which is s − raw_shift on raw_ [m].
  void sample(double s, double raw_shift) noexcept;

  std::vector<CurvePoint> knots_;
  std::vector<double> along_;  ///< arc length by waypoint [m]
  Path raw_;                   ///< spline through the newest waypoints
  int knot_count_ = 0;         ///< knots in use
  int settled_knots_ = 0;      ///< knots that are settled
  int newest_ = -1;            ///< see newest()
  int settled_ = 0;            ///< see settled()
};

}  // namespace chicane::road
