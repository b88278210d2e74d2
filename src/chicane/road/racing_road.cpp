// SPDX-License-Identifier: MIT
// Planned laps: interpolation, conversion to lines and roads as plain data, and resampling by the arc length
// of the line as a RacingRoad.
#include "chicane/road/racing_road.hpp"

#include <algorithm>
#include <cmath>

#include "chicane/base/compiler.hpp"
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
  // 1e-9 absorbs rounding: a length that is a multiple of the spacing takes no extra interval.
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
  // Whole turns alone tell the last heading of a lap from the first.
  if (is_closed)
    points[last].heading =
        points[0].heading + kTwoPi * std::round((points[last].heading - points[0].heading) / kTwoPi);
  for (std::size_t i = 0; i < last; ++i) {
    const std::size_t before = i > 0 ? i - 1 : (is_closed ? last - 1 : 0);
    const double turn = wrap_angle(points[i + 1].heading - points[before].heading);
    double duration = points[i + 1].time - points[before].time;
    if (duration < 0.0) duration += line.lap_time();
    LinePoint& p = points[i];
    p.curvature = turn / duration / p.speed;
    p.lateral_acceleration = p.speed * p.speed * p.curvature;
    p.longitudinal_acceleration = (points[i + 1].speed - points[before].speed) / duration;
  }
  const LinePoint& neighbour = points[is_closed ? 0 : last - 1];
  points[last].curvature = neighbour.curvature;
  points[last].lateral_acceleration = neighbour.lateral_acceleration;
  points[last].longitudinal_acceleration = neighbour.longitudinal_acceleration;
  return points;
}

namespace {

CurvePoint curve_of(const LinePoint& point) {
  return {.position = point.position,
          .tangent = {cos(point.heading), sin(point.heading)},
          .heading = point.heading,
          .curvature = point.curvature};
}

/// Arc length between two points of a line [m]: the chord, lengthened as an arc of the same turn.
double length_between(const LinePoint& from, const LinePoint& to) {
  const double chord = (to.position - from.position).norm();
  const double turn = to.heading - from.heading;
  return chord * (1.0 + turn * turn / 24.0);
}

/// Arc length of the line at each point of a lap [m].
std::vector<double> arc_lengths(std::span<const LinePoint> lap) {
  std::vector<double> s(lap.size());
  for (std::size_t i = 1; i < lap.size(); ++i) s[i] = s[i - 1] + length_between(lap[i - 1], lap[i]);
  return s;
}

constexpr std::size_t kLeastPoints = 8;  // chosen: fewer are no lap
// Stop at the end of an open road: aimed at kBehindStop behind a point that lies kBeforeEnd before the road's
// end, or at the finish where less room is behind it, so that the car passes the finish. Chosen: a car's
// length or three of reserve.
constexpr double kBeforeEnd = 14.0;  // [m]
constexpr double kBehindStop = 2.0;  // [m]
constexpr double kFootReach = 12.0;  // [m] search along the road from the foot of a sample to the next foot
constexpr double kNear = 4.0;  // [m] nearer edges are measured across the line: cars may drive along them
constexpr int kSteps = 4;      // iterations that find a near edge

/// Distance [m] from the point `here`, whose foot on the track's centre line is near s, across its tangent to
/// the edge on the left (side 1) or right (−1).
double room_beside(const Track& track, const CurvePoint& here, double s, double side) noexcept {
  const Vec2 across = side * Vec2{-here.tangent.y(), here.tangent.x()};
  // Gap to the edge, across the centre line, from the point `away` [m] beside `here`.
  const auto gap = [&](double away) {
    const Projection foot = track.centre().project(here.position + away * across, s, kFootReach);
    const double width = side > 0.0 ? track.left_width(foot.s) : track.right_width(foot.s);
    return width + track.kerb_width() - side * foot.d;
  };
  double room = gap(0.0);
  for (int k = 0; k < kSteps && room < kNear; ++k) room += gap(room);
  return room;
}

}  // namespace

RacingRoad::RacingRoad(std::span<const LinePoint> lap, double kerb, const Basis& basis)
    : line_{0}, basis_{basis} {
  if (lap.size() < kLeastPoints) return;
  const std::vector<double> s = arc_lengths(lap);
  const double length = s.back();
  const int intervals = static_cast<int>(std::ceil(length / kSpacing));
  line_ = ReferenceLine{intervals + 1};
  if (!line_.shape(length, intervals, basis.is_closed)) return;
  rooms_.resize(line_.samples().size());
  sideslips_.resize(rooms_.size());
  std::size_t from = 0;
  for (std::size_t i = 0; i < rooms_.size(); ++i) {
    const double at = std::min(static_cast<double>(i) * line_.spacing(), length);
    while (from + 2 < lap.size() && s[from + 1] < at) ++from;
    const LinePoint& a = lap[from];
    const LinePoint& b = lap[from + 1];
    const double piece = s[from + 1] - s[from];
    const double share = std::clamp((at - s[from]) / piece, 0.0, 1.0);
    const auto blend = [&](double of_a, double of_b) { return of_a + share * (of_b - of_a); };
    ReferenceLine::Sample& sample = line_.samples()[i];
    sample.curve = between(curve_of(a), curve_of(b), piece, share);
    sample.offset = blend(a.d, b.d);
    sample.speed = blend(a.speed, b.speed);
    sample.limiter = SpeedLimiter::kNone;
    sideslips_[i] = blend(a.sideslip, b.sideslip);
    rooms_[i] = {blend(a.left, b.left) + kerb, blend(a.right, b.right) + kerb};
  }
  if (!basis.is_closed) stop_at_end();
}

void RacingRoad::measure_rooms(const Track& track, std::span<const LinePoint> lap) noexcept {
  if (!basis_.terms.slides) return;  // a car that does not slide stays near the line
  double s = rooms_.empty() ? 0.0 : lap.front().s;
  for (std::size_t i = 0; i < rooms_.size(); ++i) {
    const CurvePoint& here = line_.samples()[i].curve;
    s = track.centre().project(here.position, s, kFootReach).s;
    rooms_[i].left = std::min(rooms_[i].left, room_beside(track, here, s, 1.0));
    rooms_[i].right = std::min(rooms_[i].right, room_beside(track, here, s, -1.0));
  }
}

void RacingRoad::stop_at_end() noexcept {
  const std::span<ReferenceLine::Sample> samples = line_.samples();
  const double end = line_.length() - std::min(kBeforeEnd, basis_.room_behind) + kBehindStop;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double left = std::max(0.0, end - static_cast<double>(i) * line_.spacing());
    samples[i].speed = std::min(samples[i].speed, std::sqrt(2.0 * basis_.braking * left));
  }
  samples.back().speed = 0.0;
}

RacingRoad::Place RacingRoad::place(double s) const noexcept {
  const double inside = line_.is_closed() ? s - line_.length() * std::floor(s / line_.length())
                                          : std::clamp(s, 0.0, line_.length());
  const double position = inside / line_.spacing();
  const std::size_t i = std::min(static_cast<std::size_t>(position), rooms_.size() - 2);
  return {i, position - static_cast<double>(i)};
}

Road::Room RacingRoad::room(double s) const noexcept {
  const auto [i, share] = place(s);
  return {rooms_[i].left + share * (rooms_[i + 1].left - rooms_[i].left),
          rooms_[i].right + share * (rooms_[i + 1].right - rooms_[i].right)};
}

double RacingRoad::sideslip(double s) const noexcept {
  const auto [i, share] = place(s);
  return sideslips_[i] + share * (sideslips_[i + 1] - sideslips_[i]);
}

}  // namespace chicane::road
