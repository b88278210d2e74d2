// SPDX-License-Identifier: MIT
// Map of waypoints: matches new ones to known ones, closes the loop, and extends the curve through them.
#include "chicane/road/waypoint_map.hpp"

#include <algorithm>
#include <cmath>

#include "chicane/base/math.hpp"

namespace chicane::road {
namespace {

constexpr std::size_t kFewestForLoop = 8;  // waypoints of the shortest loop; chosen
constexpr double kStraightOn = 0.9;        // least cosine between the ways to and from the waypoint of a loop

bool is_same(const Vec2& a, const Vec2& b) {
  return (a - b).squared_norm() < WaypointMap::kSame * WaypointMap::kSame;
}

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
  for (int k = 0; k < n; ++k) {
    const int i = (hint_ + k) % n;
    if (is_same(points_[static_cast<std::size_t>(i)], point)) return i;
  }
  return -1;
}

// On a road that crosses itself another passage may have a waypoint at the same point: the next waypoint
// decides, if the measurement has it, else the direction, which leaves some cases undecided.
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
  int before = 0;  // unknown waypoints before the first known one
  for (; first < count && known < 0; ++first) {
    const Vec2& p = now.waypoints[static_cast<std::size_t>(first)];
    if (!p.is_finite()) continue;
    known = find(p);
    before += known < 0 ? 1 : 0;
  }
  bool changed = false;
  const bool is_full = !is_closed_ && static_cast<int>(points_.size()) + count > kCapacity;
  const bool begins_ahead = !is_closed_ && known == 0 && before > 1;  // one: a noisy place at the start
  if (known < 0 || is_full || begins_ahead) {
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
    if (!p.is_finite()) continue;
    const int size = static_cast<int>(points_.size());
    if (known >= 0 && known + 1 < size) {
      ++known;  // stored already
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

WaypointLine::WaypointLine() : raw_{Path::with_capacity(kWindow)} {
  knots_.resize(static_cast<std::size_t>(kCapacity));
  along_.resize(static_cast<std::size_t>(kMostWaypoints));
}

void WaypointLine::clear() noexcept {
  knot_count_ = settled_knots_ = 0;
  newest_ = -1;
  settled_ = 0;
  along_[0] = 0.0;
}

bool WaypointLine::extend(const WaypointMap& map, int newest) noexcept {
  const auto points = map.points();
  const int first = std::max(0, settled_ - kSettled);
  const int count = newest - first + 1;
  if (count < 2 || count > kWindow || newest >= kMostWaypoints) return false;
  std::array<Vec2, kWindow> window;
  for (int i = 0; i < count; ++i)
    window[static_cast<std::size_t>(i)] = points[static_cast<std::size_t>(first + i) % points.size()];
  if (!raw_.rebuild({window.data(), static_cast<std::size_t>(count)}, false)) return false;

  // Difference of arc length between the whole curve and this spline, taken at the end of the settled part.
  const double shift = along(settled_) - raw_.arc_length(settled_ - first);
  const double end = shift + raw_.length();
  const int last_knot = static_cast<int>(std::min(std::ceil((end + kTail) / kSpacing), 1e6));
  if (last_knot >= kCapacity || (last_knot - settled_knots_) * kSpacing > kReach) return false;
  for (int i = settled_; i <= newest; ++i)
    along_[static_cast<std::size_t>(i)] = shift + raw_.arc_length(i - first);
  knot_count_ = settled_knots_;
  while (knot_count_ <= last_knot) sample(knot_count_ * kSpacing, shift);
  newest_ = newest;
  settled_ = std::max(settled_, newest - kSettled);
  settled_knots_ = std::min(static_cast<int>(along(settled_) / kSpacing) + 1, knot_count_);
  return true;
}

void WaypointLine::sample(double s, double raw_shift) noexcept {
  const PathPoint at = raw_.at(s - raw_shift);
  double heading = at.heading;
  if (knot_count_ > 0) {
    const double before = knots_[static_cast<std::size_t>(knot_count_ - 1)].heading;
    heading = before + angle_difference(heading, before);
  }
  knots_[static_cast<std::size_t>(knot_count_)] = {at.position, Vec2{cos(at.heading), sin(at.heading)},
                                                   heading, at.curvature};
  ++knot_count_;
}

CurvePoint WaypointLine::at(double s) const noexcept {
  const double position = std::max(s, 0.0) / kSpacing;
  const int index = std::clamp(static_cast<int>(position), 0, knot_count_ - 2);
  const auto i = static_cast<std::size_t>(index);
  return between(knots_[i], knots_[i + 1], kSpacing, std::clamp(position - index, 0.0, 1.0));
}

}  // namespace chicane::road
