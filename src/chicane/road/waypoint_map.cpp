// SPDX-License-Identifier: MIT
#include "chicane/road/waypoint_map.hpp"

#include <algorithm>
#include <cmath>

namespace chicane::road {
namespace {

constexpr std::size_t kFewestForLoop = 8;  // waypoints of the shortest loop
constexpr double kStraightOn = 0.9;        // cosine between the way to a waypoint and the way on from it

bool is_same(const Vec2& a, const Vec2& b) {
  const double dx = a.x() - b.x();
  const double dy = a.y() - b.y();
  return dx * dx + dy * dy < WaypointMap::kSame * WaypointMap::kSame;
}

bool is_finite(const Vec2& p) { return std::isfinite(p.x()) && std::isfinite(p.y()); }

}  // namespace

WaypointMap::WaypointMap() { points_.reserve(static_cast<std::size_t>(kCapacity)); }

void WaypointMap::clear() noexcept {
  points_.clear();
  is_closed_ = false;
  hint_ = 0;
  ++generation_;
}

int WaypointMap::find(const Vec2& point) const noexcept {
  const int n = static_cast<int>(points_.size());
  for (int i = hint_; i < n; ++i) {
    if (is_same(points_[static_cast<std::size_t>(i)], point)) return i;
  }
  for (int i = 0; i < std::min(hint_, n); ++i) {
    if (is_same(points_[static_cast<std::size_t>(i)], point)) return i;
  }
  return -1;
}

/// Whether waypoint `i` of a measurement is the map's first one come round again. On a road that crosses
/// itself another passage may have a waypoint in the same place: the one that follows decides, where it is
/// seen.
WaypointMap::Loop WaypointMap::closes(std::span<const Vec2> seen, std::size_t i) const noexcept {
  if (points_.size() < kFewestForLoop || !is_same(points_.front(), seen[i])) return Loop::kOpen;
  if (i + 1 < seen.size()) return is_same(points_[1], seen[i + 1]) ? Loop::kClosed : Loop::kOpen;
  const Vec2 arrival = seen[i] - points_.back();
  const Vec2 departure = points_[1] - points_.front();
  const double cosine = arrival.dot(departure) / std::max(arrival.norm() * departure.norm(), 1e-12);
  return cosine >= kStraightOn ? Loop::kClosed : Loop::kUndecided;
}

bool WaypointMap::add(const model::Measurement& now) noexcept {
  const int count = std::clamp(now.waypoint_count, 0, model::Measurement::kMaxWaypoints);
  int known = -1;  // index in the map of waypoint `first` of the measurement
  int first = 0;
  for (; first < count && known < 0; ++first) {
    const Vec2& p = now.waypoints[static_cast<std::size_t>(first)];
    if (is_finite(p)) known = find(p);
  }
  bool changed = false;
  const bool is_full = !is_closed_ && static_cast<int>(points_.size()) + count > kCapacity;
  if (known < 0 || is_full) {
    if (count < 2) return false;
    known = -1;
    clear();
    first = 0;
    changed = true;
  } else {
    hint_ = known;
    if (is_closed_) return false;
  }
  for (int i = first; i < count && !is_closed_; ++i) {
    const Vec2& p = now.waypoints[static_cast<std::size_t>(i)];
    if (!is_finite(p)) continue;
    const int size = static_cast<int>(points_.size());
    if (known >= 0 && known + 1 < size) {
      ++known;  // already stored in this place
      continue;
    }
    if (size > 0 && is_same(points_.back(), p)) continue;
    const Loop loop =
        closes({now.waypoints.data(), static_cast<std::size_t>(count)}, static_cast<std::size_t>(i));
    if (loop == Loop::kUndecided) break;
    if (loop == Loop::kClosed) {
      is_closed_ = true;
      changed = true;
    } else {
      points_.push_back(p);
      known = static_cast<int>(points_.size()) - 1;
      changed = true;
    }
  }
  return changed;
}

}  // namespace chicane::road
