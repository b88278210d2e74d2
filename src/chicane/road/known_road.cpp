// SPDX-License-Identifier: MIT
// The guard's road: line and edges of a track, of waypoints, or of a planned lap.
#include "chicane/road/known_road.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "chicane/base/math.hpp"

namespace chicane::road {
namespace {

// Chosen: those of public simulators are 5 to 25 m apart.
constexpr double kWaypointSpacing = 10.0;  // [m] between the waypoints taken from a track's line
constexpr double kMostToNext = 25.0;       // [m] limit of the assumed distance to the next waypoint
constexpr std::size_t kVisible = 6;        // waypoints of a measurement, as in Udacity's telemetry
constexpr std::size_t kFewest = 8;         // waypoints of the shortest loop that WaypointMap closes
constexpr double kPeriod = 0.32;      // [s] of a measurement: the most planning that Road::add() does at once
constexpr int kEdgeSteps = 5;         // iterations that find an edge across another line
constexpr double kFootToFoot = 12.0;  // [m] limit of the way along the centre between two iterations
constexpr double kEdgeFound = 0.01;   // [m] limit of the last iteration's step; else the first step counts

/// Options of the road learned from waypoints; the guard uses its line alone, not its speeds.
constexpr RoadOptions kSeen{
    .half_width = 0.0, .smoothing_width = 1.0, .remember_waypoints = true, .speed = {}};
constexpr double kFar = std::numeric_limits<double>::infinity();

/// Points of a closed track's line as waypoints of telemetry, evenly spaced.
std::vector<Vec2> waypoints_of(const RoadData& data) {
  std::vector<Vec2> waypoints;
  double next = 0.0;
  for (std::size_t i = 0; i + 1 < data.points.size(); ++i) {
    if (data.points[i].s < next || data.length - data.points[i].s < 0.5 * kWaypointSpacing) continue;
    waypoints.push_back(data.points[i].position);
    next = data.points[i].s + kWaypointSpacing;
  }
  return waypoints;
}

/// Road learned by driving past `waypoints` until its lap is planned, or for four laps and 2000 measurements.
std::unique_ptr<Road> learned_road(const std::vector<Vec2>& waypoints, const model::VehicleParams& vehicle) {
  auto road = std::make_unique<Road>(kSeen, vehicle);
  model::Measurement shown;
  shown.waypoint_count = kVisible;
  const std::size_t most = 4 * waypoints.size() + 2000;
  for (std::size_t i = 0; i < most && !road->line().is_closed(); ++i) {
    for (std::size_t k = 0; k < kVisible; ++k) shown.waypoints[k] = waypoints[(i + k) % waypoints.size()];
    road->add(shown);
    shown.time += kPeriod;
  }
  return road;
}

}  // namespace

KnownRoad::KnownRoad(const RoadData& data, const model::VehicleParams& vehicle)
    : line_{static_cast<int>(data.points.size())} {
  const int intervals = static_cast<int>(data.points.size()) - 1;
  if (intervals < 1 || !line_.shape(data.length, intervals, data.is_closed)) return;
  rooms_.reserve(data.points.size());
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const RoadPoint& point = data.points[i];
    line_.samples()[i].curve = {.position = point.position,
                                .tangent = Vec2{cos(point.heading), sin(point.heading)},
                                .heading = point.heading,
                                .curvature = point.curvature};
    rooms_.push_back({{point.left, point.right}});
  }
  find_narrowest();
  if (data.is_closed) smooth(data, vehicle);
}

void KnownRoad::smooth(const RoadData& data, const model::VehicleParams& vehicle) {
  const std::vector<Vec2> waypoints = waypoints_of(data);
  if (waypoints.size() < kFewest) return;
  const std::unique_ptr<Road> planned = learned_road(waypoints, vehicle);
  if (!planned->line().is_closed()) return;
  const ReferenceLine centre = line_;
  // Distance from the point `here`, whose foot on the centre is `foot`, to the edge on a side (1: left, −1:
  // right), across the new line: steps by the gap to the edge as measured across the centre.
  const auto distance_to_edge = [&](const CurvePoint& here, const ReferenceLine::Projection& foot,
                                    double side) {
    const Vec2 across = side * Vec2{-here.tangent.y(), here.tangent.x()};
    const auto gap = [&](const ReferenceLine::Projection& at) {
      const Edges widths = this->edges(at.s);
      return (side > 0.0 ? widths.left : widths.right) - side * at.d;
    };
    const double first = gap(foot);
    double room = first, step = first;
    for (int i = 0; i < kEdgeSteps; ++i) {
      step = gap(centre.project(here.position + room * across, foot.s, kFootToFoot));
      room += step;
    }
    return std::fabs(step) < kEdgeFound ? room : first;
  };
  std::vector<Room> rooms;
  rooms.reserve(planned->line().samples().size());
  for (const ReferenceLine::Sample& sample : planned->line().samples()) {
    const ReferenceLine::Projection foot =
        centre.project_along(sample.curve.position, sample.curve.heading, 2.0 * vehicle.width);
    rooms.push_back(
        {{distance_to_edge(sample.curve, foot, 1.0), distance_to_edge(sample.curve, foot, -1.0)}});
  }
  line_ = planned->line();
  rooms_ = std::move(rooms);
  find_narrowest();
}

KnownRoad::KnownRoad(double half_width, const model::VehicleParams& vehicle)
    : line_{2}, half_width_{half_width} {
  seen_.emplace(kSeen, vehicle);
}

void KnownRoad::use_line(const RacingRoad* lap) {
  if (lap == nullptr || lap->line().is_empty()) return;
  line_ = lap->line();
  rooms_.clear();
  for (std::size_t i = 0; i < line_.samples().size(); ++i) {
    const double s = static_cast<double>(i) * line_.spacing();
    rooms_.push_back({seen_ ? assumed_edges(line_.demand(s).offset) : lap->room(s)});
  }
  is_raced_ = true;
  find_narrowest();
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

/// Index of the sample of line_ before s, and the weight of the next one.
std::pair<std::size_t, double> KnownRoad::place(double s) const noexcept {
  const double length = line_.length();
  double along = std::clamp(s, 0.0, length);
  if (line_.is_closed() && along != s) along = s - std::floor(s / length) * length;
  const double place = along / line_.spacing();
  const auto i = std::min(static_cast<std::size_t>(std::max(place, 0.0)), rooms_.size() - 2);
  return {i, std::clamp(place - static_cast<double>(i), 0.0, 1.0)};
}

KnownRoad::Edges KnownRoad::edges(double s) const noexcept {
  if (is_learning()) return assumed_edges(seen_->line().demand(s).offset);
  const auto [i, share] = place(s);
  const Edges &from = rooms_[i].edges, &to = rooms_[i + 1].edges;
  return {from.left + share * (to.left - from.left), from.right + share * (to.right - from.right)};
}

KnownRoad::Here KnownRoad::here(double s) const noexcept {
  if (is_learning()) return {seen_->line().demand(s).curvature, {-kFar, -kFar}};
  const auto [i, share] = place(s);
  const double from = line_.samples()[i].curve.curvature, to = line_.samples()[i + 1].curve.curvature;
  const bool is_beyond = !line_.is_closed() && !(s >= 0.0 && s <= line_.length());
  const double slope = (to - from) / line_.spacing();
  return {is_beyond ? 0.0 : from + share * line_.spacing() * slope, rooms_[i].narrowest};
}

void KnownRoad::find_narrowest() noexcept {
  const auto last = static_cast<std::ptrdiff_t>(rooms_.size()) - 1;
  const auto reach = std::min(static_cast<std::ptrdiff_t>(std::ceil(kReach / line_.spacing())), last - 1);
  for (std::ptrdiff_t i = 0; i <= last; ++i) {
    Edges least{kFar, kFar};
    const auto take_in = [&](std::ptrdiff_t at) {
      const Edges& there = rooms_[static_cast<std::size_t>(at)].edges;
      least = {std::min(least.left, there.left), std::min(least.right, there.right)};
    };
    for (std::ptrdiff_t k = i - reach; k <= i + 1 + reach; ++k) {
      const std::ptrdiff_t at =
          line_.is_closed() ? (k + last) % last : std::clamp(k, std::ptrdiff_t{0}, last);
      take_in(at);
      if (line_.is_closed() && at == 0) take_in(last);  // the same place, by its own computation
    }
    rooms_[static_cast<std::size_t>(i)].narrowest = least;
  }
}

}  // namespace chicane::road
