// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/base/vec2.hpp"
#include "chicane/road/track.hpp"

namespace chicane::survey {

/// Length of a polyline, with the way from its last point to its first where it is closed [m].
[[nodiscard]] double length_of(std::span<const Vec2> line, bool closed) noexcept;

/// The polyline's points at equal distances of about `spacing` [m], the first point first; an open one keeps
/// its last. Pre: two different points, spacing > 0. At most a million points.
[[nodiscard]] std::vector<Vec2> sampled(std::span<const Vec2> line, bool closed, double spacing);

/// Twice the area that a closed line goes round to the left [m²]: positive for one counter-clockwise.
[[nodiscard]] double turned_area(std::span<const Vec2> line) noexcept;

/// The median, of which there has to be a value; values are moved.
[[nodiscard]] double median(std::vector<double> values);

/// A place on the earth [deg], WGS 84.
struct Geographic {
  double latitude = 0.0, longitude = 0.0;
};

/// East and north of the middle of the places' extent [m], on the plane that touches the ellipsoid there:
/// lengths are right to 1e-4 within 30 km. Heights are left out. Pre: |latitude| < 89.
[[nodiscard]] std::vector<Vec2> to_plane(std::span<const Geographic> places);

/// The middle that to_plane() counts from.
[[nodiscard]] Geographic middle_of(std::span<const Geographic> places) noexcept;

/// Cones as Formula Student has them: blue ones left of the road, yellow ones right.
struct Cones {
  std::vector<Vec2> left = {}, right = {};  ///< in any order [m]
  std::vector<Vec2> either = {};            ///< orange: of the nearer side
};

/// A place where a side has no cone for much longer than elsewhere.
struct ConeGap {
  bool is_left = true;
  Vec2 place{};         ///< the middle of the gap
  double length = 0.0;  ///< [m]
};

struct ConeRoad {
  std::vector<road::TrackPoint> points = {};  ///< evenly spaced, in the direction that has `left` on its left
  bool is_closed = true;
  std::vector<ConeGap> gaps = {};
  double median_width = 0.0;  ///< [m]
};

/// The line as far from the left cones as from the right ones, each side joined to a fence in its order along
/// the road: first found from the cones alone, then from the fences, so that it does not swing between cones.
/// Cones may be missing; a gap is named where it is more than 1.6 times as long as those beside it.
///
/// kParse for fewer than three cones on a side, more than 20,000, a road longer than 20 km, and cones between
/// which there is no line.
[[nodiscard]] Result<ConeRoad> line_between(const Cones& cones);

}  // namespace chicane::survey
