// SPDX-License-Identifier: MIT
#include "chicane/controller/road.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "chicane/base/math.hpp"

namespace chicane::controller {
namespace {

constexpr int kOpenWindow = 18;  // last waypoints used while the lap is not closed

/// Eq. 9: what the curvature's slope costs relative to curvature is the yaw inertia against the tyres' share.
double slope_length(const model::VehicleParams& vehicle) noexcept {
  const double length = vehicle.yaw_inertia / (vehicle.mass * vehicle.rear_axle);
  return std::clamp(length / std::max(0.05, 1.0 - vehicle.steer_helper), 1.0, 10.0);
}

}  // namespace

Road::Road(const RoadOptions& options, const model::VehicleParams& vehicle)
    : options_{options},
      vehicle_{vehicle},
      raw_{path::Path::with_capacity(WaypointMap::kCapacity)},
      line_{path::Path::with_capacity(WaypointMap::kCapacity)},
      smoother_{options.smoothing_width, slope_length(vehicle)} {
  knots_.reserve(static_cast<std::size_t>(LineSmoother::kMaxKnots));
  offset_.reserve(static_cast<std::size_t>(LineSmoother::kMaxKnots));
}

void Road::reset() noexcept {
  map_.clear();
  knot_count_ = 0;
  line_ = path::Path::with_capacity(WaypointMap::kCapacity);
  ++revision_;
}

void Road::configure(const RoadOptions& options, const model::VehicleParams& vehicle) noexcept {
  if (options == options_ && vehicle == vehicle_) return;
  const bool has_same_line =
      options.smoothing_width == options_.smoothing_width && slope_length(vehicle) == slope_length(vehicle_);
  options_ = options;
  vehicle_ = vehicle;
  if (!has_same_line) {
    smoother_.configure(options.smoothing_width, slope_length(vehicle));
    rebuild();
  } else if (is_known()) {
    speed_plan_.rebuild(line_, vehicle_, options_.speed);
  }
}

void Road::add(const model::Measurement& now) noexcept {
  if (!options_.remember_waypoints && !map_.points().empty()) {
    const bool is_new =
        now.waypoint_count > 0 && (map_.points().front() - now.waypoints[0]).norm() > WaypointMap::kSame;
    if (is_new) map_.clear();
  }
  if (map_.add(now)) rebuild();
}

void Road::rebuild() noexcept {
  std::span<const Vec2> points = map_.points();
  if (!map_.is_closed() && points.size() > static_cast<std::size_t>(kOpenWindow))
    points = points.last(static_cast<std::size_t>(kOpenWindow));
  if (points.size() < 3 || !raw_.rebuild(points, map_.is_closed())) return;
  if (!smooth()) return;
  speed_plan_.rebuild(line_, vehicle_, options_.speed);
  ++revision_;
}

bool Road::smooth() noexcept {
  const bool closed = raw_.is_closed();
  const int intervals = LineSmoother::knots_for(raw_.length(), closed);
  const double spacing = raw_.length() / intervals;
  const bool use = smoother_.smooth(raw_, spacing, intervals);
  knot_count_ = closed ? intervals : intervals + 1;
  knots_.clear();
  offset_.clear();
  for (int k = 0; k < knot_count_; ++k) {
    const path::PathPoint at = raw_.at(k * spacing);
    const double n = use ? smoother_.offset(k) : 0.0;
    offset_.push_back(n);
    knots_.emplace_back(at.position.x() - n * sin(at.heading), at.position.y() + n * cos(at.heading));
  }
  return line_.rebuild(knots_, closed);
}

Road::Room Road::room(double s) const noexcept {
  if (knot_count_ < 2) return {options_.half_width, options_.half_width};
  const double position =
      line_.wrap(s) / line_.length() * (line_.is_closed() ? knot_count_ : knot_count_ - 1);
  const int i = std::clamp(static_cast<int>(position), 0, knot_count_ - 1);
  const int j = line_.is_closed() ? (i + 1) % knot_count_ : std::min(i + 1, knot_count_ - 1);
  const double share = std::clamp(position - i, 0.0, 1.0);
  const double n = offset_[static_cast<std::size_t>(i)] +
                   share * (offset_[static_cast<std::size_t>(j)] - offset_[static_cast<std::size_t>(i)]);
  return {options_.half_width - n, options_.half_width + n};
}

}  // namespace chicane::controller
