// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/base/vec2.hpp"
#include "chicane/road/track.hpp"

/// Geometry of surveyed points, from which importers make roads: polylines, coordinates on the earth, and the
/// line between two rows of cones.

namespace chicane::survey {

/// Length of a polyline [m]. A closed one includes the piece from its last point to its first.
[[nodiscard]] double length_of(std::span<const Vec2> line, bool closed) noexcept;

/// Points on the polyline at equal distances of about `spacing` [m], from its first point on. The points of
/// an open one end at its last point. Pre: two different points, spacing > 0. At most a million points.
[[nodiscard]] std::vector<Vec2> sampled(std::span<const Vec2> line, bool closed, double spacing);

/// Area within a closed line [m²]; positive for a counter-clockwise line.
[[nodiscard]] double signed_area(std::span<const Vec2> line) noexcept;

/// Place on the earth in the system WGS 84 [deg].
struct Geographic {
  double latitude = 0.0, longitude = 0.0;
};

/// Coordinates (east, north) [m] on the plane that touches the ellipsoid at middle_of(places). The relative
/// error of lengths is below 1e-4 within 30 km. Heights are ignored. Pre: |latitude| < 89.
[[nodiscard]] std::vector<Vec2> to_plane(std::span<const Geographic> places);

/// Middle of the places' extent: origin of to_plane().
[[nodiscard]] Geographic middle_of(std::span<const Geographic> places) noexcept;

/// Cones of a Formula Student course: blue ones left of the road, yellow ones right, in any order.
struct Cones {
  std::vector<Vec2> left = {}, right = {};  ///< places [m]
  std::vector<Vec2> either = {};            ///< places of orange cones, which belong to the nearer side [m]
};

/// Gap between neighbouring cones of one side, much longer than the gaps beside it.
struct ConeGap {
  bool is_left = true;
  Vec2 place{};         ///< middle of the gap [m]
  double length = 0.0;  ///< [m]
};

/// Road between two rows of cones.
struct ConeRoad {
  std::vector<road::TrackPoint> points = {};  ///< every 0.5 m, in the driving direction: Cones::left is left
  bool is_closed = true;
  std::vector<ConeGap> gaps = {};
  double median_width = 0.0;  ///< [m]
};

/// Line halfway between left and right cones, found in two passes. The first line is halfway between single
/// cones and gives their order along the road. The second is halfway between the fences that join the cones
/// in this order, and so does not swing from cone to cone. Gaps longer than 1.6 times the median of their
/// neighbours are reported, because cones may be missing there.
///
/// Fails with kParse for fewer than three cones on a side, more than 20,000 cones, a course wider than 20 km,
/// and cones without a line between them.
[[nodiscard]] Result<ConeRoad> line_between(const Cones& cones);

}  // namespace chicane::survey
