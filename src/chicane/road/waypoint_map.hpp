// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <vector>

#include "chicane/base/vec2.hpp"
#include "chicane/model/state.hpp"
#include "chicane/road/path.hpp"
#include "chicane/road/reference_line.hpp"

namespace chicane::road {

/// The road as a car learns it: the waypoints of all measurements so far in driving order, closed into a loop
/// as soon as the first one is seen again. Telemetry repeats waypoints exactly, so two closer than kSame are
/// one.
///
/// Memory for kCapacity waypoints is reserved at construction; add() allocates nothing. A measurement whose
/// waypoints match nothing known starts a new map (another scene, or a car that was moved), and so do one
/// that no longer fits and, before the map is closed, one from two waypoints before its first.
class WaypointMap {
 public:
  static constexpr int kCapacity = 4096;
  static constexpr double kSame = 0.3;  ///< [m]

  WaypointMap();
  void clear() noexcept;
  /// Takes in the waypoints of a measurement. True when the map changed.
  [[nodiscard]] bool add(const model::Measurement& now) noexcept;

  [[nodiscard]] std::span<const Vec2> points() const noexcept { return points_; }
  [[nodiscard]] bool is_closed() const noexcept { return is_closed_; }
  /// Index of the first waypoint of the last measurement that showed one known.
  [[nodiscard]] int first_seen() const noexcept { return hint_; }
  /// Count of restarts of the map.
  [[nodiscard]] unsigned generation() const noexcept { return generation_; }

 private:
  enum class Loop { kOpen, kClosed, kUndecided };
  [[nodiscard]] Loop closes(std::span<const Vec2> seen, std::size_t i) const noexcept;
  [[nodiscard]] int find(const Vec2& point) const noexcept;

  std::vector<Vec2> points_;
  bool is_closed_ = false;
  unsigned generation_ = 0;
  int hint_ = 0;  ///< index where the last measurement's first waypoint was found
};

/// Curve through the waypoints as they become known: a C² spline through the newest ones, kept as knots of
/// one spacing. A waypoint moves the spline before it less and less (by a quarter from one to the next), so
/// with kSettled of them ahead a piece is settled: it is stored for good, and only the part beyond is
/// computed again.
///
/// Waypoints are counted on beyond the end of a lap: number n + i of a closed map of n is number i again.
/// Memory is reserved at construction; extend() allocates nothing and takes a few µs, bounded by kReach.
class WaypointLine {
 public:
  static constexpr double kSpacing = 3.0;      ///< spacing of the knots [m]
  static constexpr int kCapacity = 8192;       ///< knots: a lap of 24 km
  static constexpr int kMostWaypoints = 4608;  ///< a map, and on into its second lap
  static constexpr int kSettled = 5;           ///< waypoints ahead after which a piece is settled
  static constexpr double kTail = 15.0;        ///< [m]
  static constexpr double kReach = 1500.0;     ///< [m] longest stretch drawn at once

  WaypointLine();
  void clear() noexcept;

  /// Draws the line on to waypoint number `newest`. False, and nothing changed, when that is no curve: fewer
  /// than two waypoints, coordinates out of range, more than kReach not settled, or beyond the capacity.
  bool extend(const WaypointMap& map, int newest) noexcept;

  [[nodiscard]] int newest() const noexcept { return newest_; }  ///< waypoint drawn to; −1 for none
  /// The next stretch may be beyond the capacity.
  [[nodiscard]] bool is_full() const noexcept {
    return newest_ >= 0 &&
           (along(newest_) > kCapacity * kSpacing - kReach || newest_ > kMostWaypoints - kWindow);
  }
  [[nodiscard]] int settled() const noexcept { return settled_; }  ///< waypoint settled to
  /// Arc length at a waypoint drawn to [m].
  [[nodiscard]] double along(int waypoint) const noexcept {
    return along_[static_cast<std::size_t>(waypoint)];
  }
  /// The curve at arc length s >= 0 [m]; beyond the end it goes straight on for at least kTail.
  [[nodiscard]] CurvePoint at(double s) const noexcept;

 private:
  static constexpr int kWindow = 48;  ///< waypoints of one spline
  void sample(double s, double raw_shift) noexcept;

  std::vector<CurvePoint> knots_;
  std::vector<double> along_;  ///< arc length by waypoint [m]
  road::Path raw_;             ///< through the newest waypoints
  int knot_count_ = 0;
  int settled_knots_ = 0;
  int newest_ = -1;
  int settled_ = 0;
};

}  // namespace chicane::road
