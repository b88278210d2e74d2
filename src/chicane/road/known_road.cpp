// SPDX-License-Identifier: MIT
// The guard's road: line and edges, from a track or from the waypoints seen so far.
#include "chicane/road/known_road.hpp"

#include <cmath>
#include <memory>
#include <utility>

#include "chicane/base/math.hpp"

namespace chicane::road {
namespace {

/// The speed plan of a supervisor's line is not used.
constexpr double kWaypointSpacing = 10.0;  // [m]
constexpr double kMostToNext = 25.0;       // [m] from the last waypoint to the next
constexpr RoadOptions kSeen{
    .half_width = 0.0, .smoothing_width = 1.0, .remember_waypoints = true, .speed = {}};
constexpr int kEdgeSteps = 5;         // iterations that find an edge across another line
constexpr double kFootToFoot = 12.0;  // [m] along the centre from one of their feet to the next
constexpr double kEdgeFound = 0.01;   // [m] their last step; where it is larger the first one counts

}  // namespace

KnownRoad::KnownRoad(const road::RoadData& data, const model::VehicleParams& vehicle)
    : line_{static_cast<int>(data.points.size())} {
  const int intervals = static_cast<int>(data.points.size()) - 1;
  if (intervals < 1 || !line_.shape(data.length, intervals, data.is_closed)) return;
  edges_.reserve(data.points.size());
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const road::RoadPoint& point = data.points[i];
    line_.samples()[i].curve = {.position = point.position,
                                .tangent = Vec2{cos(point.heading), sin(point.heading)},
                                .heading = point.heading,
                                .curvature = point.curvature};
    edges_.push_back({point.left, point.right});
  }
  if (data.is_closed) smooth(data, vehicle);
}

/// Replaces the track's own line by the smooth one that a controller plans from its waypoints: as wide in the
/// bends.
void KnownRoad::smooth(const road::RoadData& data, const model::VehicleParams& vehicle) {
  std::vector<Vec2> waypoints;
  double next = 0.0;
  for (std::size_t i = 0; i + 1 < data.points.size(); ++i) {
    if (data.points[i].s < next || data.length - data.points[i].s < 0.5 * kWaypointSpacing) continue;
    waypoints.push_back(data.points[i].position);
    next = data.points[i].s + kWaypointSpacing;
  }
  if (waypoints.size() < 8) return;
  const auto planned = std::make_unique<Road>(kSeen, vehicle);
  model::Measurement shown;
  shown.waypoint_count = 6;
  const std::size_t most = 4 * waypoints.size() + 2000;
  for (std::size_t i = 0; i < most && !planned->line().is_closed(); ++i) {
    for (std::size_t k = 0; k < 6; ++k) shown.waypoints[k] = waypoints[(i + k) % waypoints.size()];
    planned->add(shown);
    shown.time += 0.32;
  }
  if (!planned->line().is_closed()) return;
  const ReferenceLine centre = line_;
  const auto beside = [&](const CurvePoint& here, const ReferenceLine::Projection& foot, double side) {
    const Vec2 across = side * Vec2{-here.tangent.y(), here.tangent.x()};
    const auto left_over = [&](const ReferenceLine::Projection& at) {
      const Edges widths = this->edges(at.s);
      return (side > 0.0 ? widths.left : widths.right) - side * at.d;
    };
    const double first = left_over(foot);
    double room = first, step = first;
    for (int i = 0; i < kEdgeSteps; ++i) {
      step = left_over(centre.project(here.position + room * across, foot.s, kFootToFoot));
      room += step;
    }
    return std::fabs(step) < kEdgeFound ? room : first;
  };
  std::vector<Edges> edges;
  edges.reserve(planned->line().samples().size());
  for (const ReferenceLine::Sample& sample : planned->line().samples()) {
    const ReferenceLine::Projection place =
        centre.project_along(sample.curve.position, sample.curve.heading, 2.0 * vehicle.width);
    edges.push_back({beside(sample.curve, place, 1.0), beside(sample.curve, place, -1.0)});
  }
  line_ = planned->line();
  edges_ = std::move(edges);
}

KnownRoad::KnownRoad(double half_width, const model::VehicleParams& vehicle)
    : line_{2}, half_width_{half_width} {
  seen_.emplace(kSeen, vehicle);
}

void KnownRoad::use_line(const RacingRoad* lap) {
  if (lap == nullptr || lap->line().is_empty()) return;
  line_ = lap->line();
  edges_.clear();
  for (std::size_t i = 0; i < line_.samples().size(); ++i) {
    const double s = static_cast<double>(i) * line_.spacing();
    const Road::Room room = lap->room(s);
    edges_.push_back(seen_ ? assumed_edges(line_.demand(s).offset) : Edges{room.left, room.right});
  }
  is_raced_ = true;
  slides_ = lap->terms().slides;
  ++lines_;
}

void KnownRoad::reset() noexcept {
  if (!seen_) return;
  seen_->reset();
  next_waypoint_ = 0.0;
  if (is_raced_) ++lines_;
  is_raced_ = false;
}

void KnownRoad::add(const model::Measurement& now) noexcept {
  if (!is_learning()) return;
  seen_->add(now);
  const std::size_t count = now.waypoint_count;
  if (count < 2) return;
  const double apart = (now.waypoints[count - 1] - now.waypoints[count - 2]).norm();
  if (std::isfinite(apart)) next_waypoint_ = std::min(apart, kMostToNext);
}

KnownRoad::Edges KnownRoad::edges(double s) const noexcept {
  if (is_learning()) return assumed_edges(seen_->line().demand(s).offset);
  const double length = line_.length();
  double along = std::clamp(s, 0.0, length);
  if (line_.is_closed() && along != s) along = s - std::floor(s / length) * length;
  const auto last = edges_.size() - 2;
  const double place = along / line_.spacing();
  const auto i = std::min(static_cast<std::size_t>(std::max(place, 0.0)), last);
  const double share = std::clamp(place - static_cast<double>(i), 0.0, 1.0);
  const Edges& from = edges_[i];
  const Edges& to = edges_[i + 1];
  return {from.left + share * (to.left - from.left), from.right + share * (to.right - from.right)};
}

}  // namespace chicane::road
