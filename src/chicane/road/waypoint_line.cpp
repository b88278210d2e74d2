// SPDX-License-Identifier: MIT
#include "chicane/road/waypoint_line.hpp"

#include <algorithm>
#include <cmath>

#include "chicane/base/angle.hpp"
#include "chicane/base/math.hpp"

namespace chicane::road {

WaypointLine::WaypointLine() : raw_{road::Path::with_capacity(kWindow)} {
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

  // Arc length of the whole line less that of this spline: they agree where the settled part ends.
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
  const road::PathPoint at = raw_.at(s - raw_shift);
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
