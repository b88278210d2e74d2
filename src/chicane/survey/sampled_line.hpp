// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/base/vec2.hpp"
#include "chicane/road/track.hpp"

/// Lines from surveyed points: lengths and equal steps of polylines, the plane of geographic coordinates, and
/// the middle of a road between cones.

namespace chicane::survey {

/// Length of a polyline [m]; of a closed one including the piece from its last point to its first.
[[nodiscard]] double length_of(std::span<const Vec2> line, bool closed) noexcept;

/// The polyline's points at equal distances of about `spacing` [m], the first point first; an open one keeps
/// its last. Pre: two different points, spacing > 0. At most a million points.
[[nodiscard]] std::vector<Vec2> sampled(std::span<const Vec2> line, bool closed, double spacing);

/// Twice the area within a closed line [m²], positive for a counter-clockwise one.
[[nodiscard]] double turned_area(std::span<const Vec2> line) noexcept;

/// The median. Pre: at least one value.
[[nodiscard]] double median(std::vector<double> values);

/// A place on the earth [deg], WGS 84.
struct Geographic {
  double latitude = 0.0, longitude = 0.0;
};

/// Coordinates (east, north) [m] on the plane that touches the ellipsoid at middle_of(places). Lengths within
/// 30 km are exact to 1e-4. Without heights. Pre: |latitude| < 89.
[[nodiscard]] std::vector<Vec2> to_plane(std::span<const Geographic> places);

/// Origin of to_plane(): the middle of the places' extent.
[[nodiscard]] Geographic middle_of(std::span<const Geographic> places) noexcept;

/// Cones as Formula Student has them: blue ones left of the road, yellow ones right.
struct Cones {
  std::vector<Vec2> left = {}, right = {};  ///< points in any order [m]
  std::vector<Vec2> either = {};            ///< orange ones: count for the nearer side
};

/// A gap between cones of one side that is much longer than others.
struct ConeGap {
  bool is_left = true;
  Vec2 place{};         ///< middle of the gap [m]
  double length = 0.0;  ///< [m]
};

struct ConeRoad {
  std::vector<road::TrackPoint> points = {};  ///< evenly spaced, in the direction that has `left` on its left
  bool is_closed = true;
  std::vector<ConeGap> gaps = {};
  double median_width = 0.0;  ///< [m]
};

/// The line halfway between left and right cones. A first line from the cones alone gives their order along
/// the road; the cones of each side are then joined to a fence, and the line between the fences does not
/// swing from cone to cone. Cones may be missing: gaps more than 1.6 times as long as their neighbours are
/// reported.
///
/// kParse for fewer than three cones on a side, more than 20,000, a road longer than 20 km, and cones between
/// which there is no line.
[[nodiscard]] Result<ConeRoad> line_between(const Cones& cones);

}  // namespace chicane::survey
