// SPDX-License-Identifier: MIT
#include "chicane/road/road_data.hpp"

#include <algorithm>
#include <cmath>

#include "chicane/base/angle.hpp"
#include "chicane/base/assert.hpp"
#include "chicane/base/math.hpp"

namespace chicane::road {

RacingLinePoint RacingLine::at(double s) const noexcept {
  if (is_empty() || !(length > 0.0) || !std::isfinite(s)) return {};
  const double wrapped = std::clamp(s - length * std::floor(s / length), 0.0, length);
  const auto behind = std::upper_bound(points.begin() + 1, points.end() - 1, wrapped,
                                       [](double place, const RacingLinePoint& p) { return place < p.s; });
  const RacingLinePoint& a = *(behind - 1);
  const RacingLinePoint& b = *behind;
  const double share = b.s > a.s ? (wrapped - a.s) / (b.s - a.s) : 0.0;
  const auto between = [&](double RacingLinePoint::*value) {
    return a.*value + share * (b.*value - a.*value);
  };
  using P = RacingLinePoint;
  return {.s = wrapped,
          .time = between(&P::time),
          .offset = between(&P::offset),
          .heading = between(&P::heading),
          .vx = between(&P::vx),
          .vy = between(&P::vy),
          .yaw_rate = between(&P::yaw_rate),
          .steer = between(&P::steer),
          .steer_command = between(&P::steer_command),
          .acceleration = between(&P::acceleration),
          .throttle = between(&P::throttle)};
}

RoadData road_data(const Track& track, double spacing) {
  CHICANE_ASSERT(spacing > 0.0);
  const Path& centre = track.centre();
  RoadData road;
  road.is_closed = centre.is_closed();
  road.length = centre.length();
  // Less a little: a length that is a multiple of the spacing but for rounding takes no interval more.
  const auto intervals = static_cast<std::size_t>(std::max(1.0, std::ceil(road.length / spacing - 1e-9)));
  road.points.reserve(intervals + 1);
  for (std::size_t k = 0; k <= intervals; ++k) {
    const double s = road.length * static_cast<double>(k) / static_cast<double>(intervals);
    const PathPoint point = centre.at(s);
    road.points.push_back({.s = s,
                           .position = point.position,
                           .heading = point.heading,
                           .curvature = point.curvature,
                           .left = track.left_width(s),
                           .right = track.right_width(s)});
  }
  return road;
}

std::vector<LinePoint> line_points(const Track& track, const RacingLine& line) {
  std::vector<LinePoint> points;
  if (line.is_empty()) return points;
  const Path& centre = track.centre();
  for (const RacingLinePoint& at : line.points) {
    const PathPoint foot = centre.at(at.s);
    LinePoint p;
    p.s = at.s;
    p.time = at.time;
    p.d = at.offset;
    p.position = foot.position + at.offset * Vec2{-chicane::sin(foot.heading), chicane::cos(foot.heading)};
    p.sideslip = chicane::atan2(at.vy, at.vx);
    p.heading = foot.heading + at.heading + p.sideslip;
    p.speed = hypot(at.vx, at.vy);
    p.left = track.left_width(at.s) - at.offset;
    p.right = track.right_width(at.s) + at.offset;
    points.push_back(p);
  }
  const std::size_t last = points.size() - 1;
  const bool is_closed = centre.is_closed();
  // The end of a lap has the heading of its beginning, and what the road has turned.
  if (is_closed)
    points[last].heading =
        points[0].heading + kTwoPi * std::round((points[last].heading - points[0].heading) / kTwoPi);
  for (std::size_t i = 0; i < last; ++i) {
    const std::size_t before = i > 0 ? i - 1 : (is_closed ? last - 1 : 0);
    const double turned = wrap_angle(points[i + 1].heading - points[before].heading);
    double taken = points[i + 1].time - points[before].time;
    if (taken < 0.0) taken += line.lap_time();
    LinePoint& p = points[i];
    p.curvature = turned / taken / p.speed;
    p.lateral_acceleration = p.speed * p.speed * p.curvature;
    const double faster = points[i + 1].speed - points[before].speed;
    p.longitudinal_acceleration = faster / taken;
  }
  const LinePoint& like = points[is_closed ? 0 : last - 1];
  points[last].curvature = like.curvature;
  points[last].lateral_acceleration = like.lateral_acceleration;
  points[last].longitudinal_acceleration = like.longitudinal_acceleration;
  return points;
}

}  // namespace chicane::road
