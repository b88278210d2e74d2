// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/base/types.hpp"

namespace chicane::path {

/// Where a curve is at one arc length.
struct PathPoint {
  Vec2 position = Vec2::Zero();  ///< in W [m]
  double heading = 0.0;          ///< of the tangent [rad], continuous along the path (not wrapped)
  double curvature = 0.0;        ///< [1/m], left positive
  double curvature_slope = 0.0;  ///< dκ/ds [1/m²]
};

/// Path coordinates of a point: s along, d to the left.
struct Projection {
  double s = 0.0;         ///< arc length of the nearest point [m]; in [0, length) when closed
  double d = 0.0;         ///< signed distance, left positive [m]
  double distance = 0.0;  ///< |point − nearest point| [m] (differs from |d| only beyond an open end)
};

/// A smooth plane curve by arc length: interpolating C² cubic spline through given points, periodic when closed, with the
/// parameter corrected so that s is arc length to about 1e-3 relative. Geometry only; knows no car.
///
/// Memory is reserved once: rebuild() within capacity() allocates nothing, so a controller may renew its path every step.
class Path {
 public:
  /// Reserves memory for `capacity` points and holds no curve (length 0).
  static Path with_capacity(int capacity);
  /// Fails with kInvalidArgument naming the point: fewer than 2 points (3 when closed), non-finite, coincident neighbours.
  [[nodiscard]] static Result<Path> create(std::span<const Vec2> points, bool closed);

  /// Replaces the curve without allocating. False, and no change, for data that create() would refuse or too many points.
  [[nodiscard]] bool rebuild(std::span<const Vec2> points, bool closed) noexcept;

  [[nodiscard]] bool is_closed() const noexcept { return closed_; }
  [[nodiscard]] double length() const noexcept { return length_; }
  [[nodiscard]] bool is_empty() const noexcept { return length_ <= 0.0; }
  /// Any s: wrapped when closed, extended by a straight line beyond the ends when open.
  [[nodiscard]] PathPoint at(double s) const noexcept;
  /// s in [0, length) for a closed path; clamped for an open one.
  [[nodiscard]] double wrap(double s) const noexcept;
  /// Signed distance along the path from s0 to s1: shortest way round when closed [m].
  [[nodiscard]] double difference(double s1, double s0) const noexcept;

  /// Nearest point of the whole curve. O(n).
  [[nodiscard]] Projection project(const Vec2& point) const noexcept;
  /// Nearest point within `window` [m] of arc length around s_guess. O(window).
  [[nodiscard]] Projection project(const Vec2& point, double s_guess, double window) const noexcept;

 private:
  bool closed_ = false;
  double length_ = 0.0;
};

}  // namespace chicane::path
