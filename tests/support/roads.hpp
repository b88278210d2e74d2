// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <vector>

#include "chicane/base/math.hpp"
#include "chicane/road/track.hpp"

namespace chicane::test {

/// `count` points about the origin, counter-clockwise from the x axis, `radius(angle)` [m] away.
template <class Radius>
std::vector<Vec2> points_round(int count, const Radius& radius) {
  std::vector<Vec2> points;
  for (int i = 0; i < count; ++i) {
    const double angle = kTwoPi * i / count;
    points.push_back(radius(angle) * Vec2{std::cos(angle), std::sin(angle)});
  }
  return points;
}
inline std::vector<Vec2> circle_points(double radius, int count) {
  return points_round(count, [&](double /*angle*/) { return radius; });
}

/// Points of a figure of eight, 200 m wide and twice `height` [m] high; the first one is `shift` of a gap
/// behind the crossing.
inline std::vector<Vec2> eight_points(int count, double height, double shift = 0.0) {
  std::vector<Vec2> points;
  for (int i = 0; i < count; ++i) {
    const double angle = kTwoPi * (i + shift) / count;
    points.emplace_back(100.0 * std::sin(angle), height * std::sin(2.0 * angle));
  }
  return points;
}

/// Points of a road as wide everywhere [m].
inline std::vector<road::TrackPoint> with_widths(const std::vector<Vec2>& line, double left, double right) {
  std::vector<road::TrackPoint> points;
  for (const Vec2& point : line) points.push_back({point, left, right});
  return points;
}

inline constexpr road::TrackOptions kThroughThePoints{.smoothing_sigma = 0.0};

/// A circle about the origin, counter-clockwise, s = 0 on the x axis.
inline road::Track circle_road(double radius, int count, double left, double right,
                               const road::TrackOptions& options = kThroughThePoints) {
  return road::Track::create("circle", with_widths(circle_points(radius, count), left, right), true, options)
      .value();
}

/// Closed, with corners to both sides; `side` −1 mirrors it at the y axis, with its edges.
inline road::Track bean_road(double side, double size, double left, double right) {
  const std::vector<Vec2> line = points_round(140, [&](double angle) {
    return size * (75.0 + 25.0 * std::cos(2.0 * angle) + 12.0 * std::sin(3.0 * angle));
  });
  std::vector<road::TrackPoint> points =
      with_widths(line, side > 0.0 ? left : right, side > 0.0 ? right : left);
  for (road::TrackPoint& point : points) point.position.x() *= side;
  return road::Track::create("bean", points, true).value();
}

/// From the origin `count` times 10 m along x; open.
inline std::vector<road::TrackPoint> straight_points(int count, double left, double right) {
  std::vector<Vec2> line;
  for (int i = 0; i <= count; ++i) line.emplace_back(10.0 * i, 0.0);
  return with_widths(line, left, right);
}
inline road::Track straight_road(int count, double left, double right,
                                 const road::TrackOptions& options = kThroughThePoints) {
  return road::Track::create("straight", straight_points(count, left, right), false, options).value();
}

}  // namespace chicane::test
