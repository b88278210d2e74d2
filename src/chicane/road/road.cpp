// SPDX-License-Identifier: MIT
// Road that a controller learns: adds waypoints to the map, and plans stretch and lap in instalments.
#include "chicane/road/road.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace chicane::road {
namespace {

// Knots of a stretch on a closed road. Chosen: 270 m, enough until the lap is planned.
constexpr int kClosedStretchKnots = 90;
// Waypoint at which laps begin. Derived: the first one whose curve other waypoints before it have shaped.
constexpr int kSeam = WaypointLine::kSettled + 1;

}  // namespace

Road::Road(const RoadOptions& options, const model::VehicleParams& vehicle)
    : options_{options},
      vehicle_{vehicle},
      stretch_planner_{kStretchKnots},
      lap_planner_{WaypointLine::kCapacity},
      stretch_{LinePlanner::samples_for(kStretchKnots)},
      laps_{ReferenceLine{LinePlanner::samples_for(WaypointLine::kCapacity)},
            ReferenceLine{LinePlanner::samples_for(WaypointLine::kCapacity)}} {
  configure_planners();
}

void Road::configure_planners() noexcept {
  const LinePlannerOptions line{.smoothing_width = options_.smoothing_width, .speed = options_.speed};
  stretch_planner_.configure(line, vehicle_);
  lap_planner_.configure(line, vehicle_);
}

void Road::reset() noexcept {
  map_.clear();
  generation_ = map_.generation();
  waypoints_.clear();
  stretch_.clear();
  is_lap_ = is_lap_begun_ = false;
  ++revision_;
}

void Road::configure(const RoadOptions& options, const model::VehicleParams& vehicle) noexcept {
  if (options == options_ && vehicle == vehicle_) return;
  options_ = options;
  vehicle_ = vehicle;
  configure_planners();
  is_lap_begun_ = false;
  if (is_lap_) {
    plan_lap(1);
  } else if (waypoints_.newest() >= 0) {
    plan_stretch();
  }
}

void Road::add(const model::Measurement& now) noexcept {
  if (!options_.remember_waypoints && !map_.points().empty()) {
    const bool is_new =
        now.waypoint_count > 0 && (map_.points().front() - now.waypoints[0]).norm() > WaypointMap::kSame;
    if (is_new) map_.clear();
  }
  if (!is_lap_ && waypoints_.is_full()) map_.clear();
  const bool has_grown = map_.add(now);
  const int shares = shares_until(now.time);
  if (map_.generation() != generation_) {
    generation_ = map_.generation();
    waypoints_.clear();
    is_lap_ = is_lap_begun_ = false;
  }
  if (!map_.is_closed()) {
    if (has_grown && waypoints_.extend(map_, static_cast<int>(map_.points().size()) - 1)) plan_stretch();
  } else if (!is_lap_ && waypoints_.newest() < newest_needed(now)) {
    extend_past_seam(newest_needed(now), shares);
  } else if (!is_lap_ || is_lap_begun_) {
    plan_lap(shares);
  }
}

int Road::shares_until(double time) noexcept {
  const double shares = std::round((time - time_) / kShare);
  time_ = time;
  return shares >= 1.0 ? static_cast<int>(std::min(shares, static_cast<double>(kMostShares))) : 1;
}

int Road::newest_needed(const model::Measurement& now) const noexcept {
  // Far enough into the second lap that its curve at the seam is settled, and as far as the car sees.
  const int count = static_cast<int>(map_.points().size());
  const int first = map_.first_seen() < count / 2 ? map_.first_seen() + count : map_.first_seen();
  return std::max(count + kSeam + WaypointLine::kSettled, first + now.waypoint_count - 1);
}

void Road::extend_past_seam(int newest, int shares) noexcept {
  constexpr int kAtOnce = 3;  // waypoints in a share; chosen: a few µs
  for (int share = 0; share < shares && waypoints_.newest() < newest; ++share) {
    const int to = std::min(newest, waypoints_.newest() + kAtOnce);
    if (waypoints_.extend(map_, to) && to == newest) plan_stretch();
  }
}

void Road::plan_stretch() noexcept {
  const int count = static_cast<int>(map_.points().size());
  int first = map_.first_seen();
  if (first + count <= waypoints_.newest()) first += count;
  const double from = std::max(0.0, waypoints_.along(first) - kBehind);
  // Begins at a knot of the waypoint line, so that the settled part stays the same.
  const double knot = std::floor(from / WaypointLine::kSpacing) * WaypointLine::kSpacing;
  const double most = (map_.is_closed() ? kClosedStretchKnots : kStretchKnots - 2) * WaypointLine::kSpacing;
  const double to = std::min(waypoints_.along(waypoints_.newest()), knot + most);
  stretch_.clear();
  ++revision_;
  if (!stretch_planner_.begin(knot, to, false)) return;
  (void)stretch_planner_.advance(std::numeric_limits<int>::max(), waypoints_, stretch_);
}

void Road::plan_lap(int shares) noexcept {
  const std::size_t other = 1 - current_lap_;
  if (!is_lap_begun_) {
    const int count = static_cast<int>(map_.points().size());
    is_lap_begun_ = lap_planner_.begin(waypoints_.along(kSeam), waypoints_.along(kSeam + count), true);
    if (!is_lap_begun_) return;
  }
  if (!lap_planner_.advance(shares * kLapWork, waypoints_, laps_[other])) return;
  is_lap_begun_ = false;
  if (laps_[other].is_empty()) return;
  current_lap_ = other;
  is_lap_ = true;
  ++revision_;
}

}  // namespace chicane::road
