// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/base/vec2.hpp"

namespace chicane::road {

/// Point of a curve at one arc length.
struct PathPoint {
  Vec2 position{};               ///< position in W [m]
  double heading = 0.0;          ///< heading of the tangent [rad], continuous along the path (not wrapped)
  double curvature = 0.0;        ///< [1/m], left positive
  double curvature_slope = 0.0;  ///< dκ/ds [1/m²], jumps at the given points
};

/// Path coordinates of a point: s along, d to the left.
struct Projection {
  double s = 0.0;  ///< arc length of the nearest point [m]; in [0, length) when closed
  double d = 0.0;  ///< signed distance, left positive [m]
  double distance =
      0.0;  ///< |point − nearest point| [m] (differs from |d| beyond an open end or at the window's end)
};

/// A smooth plane curve by arc length: interpolating C² cubic spline through given points, periodic when
/// closed, natural (no curvature at the ends) when open. s is arc length exactly at the points; between them
/// |dr/ds| is within 1e-3 of 1 where the curve turns by less than 0.35 rad from point to point, within 1e-2
/// below 0.6 rad. Heading and curvature are those of the curve itself, whatever its parameter. Geometry only;
/// knows no car.
///
/// Memory is reserved once: rebuild() within capacity() allocates nothing, so a controller may renew its path
/// every step. at() takes O(1), also for unevenly spaced points. Copies keep the capacity. const calls are
/// safe from many threads.
class Path {
 public:
  static constexpr double kMinSpacing = 1e-6;    ///< neighbours closer than this coincide [m]
  static constexpr double kMaxCoordinate = 1e7;  ///< |x|, |y| of a point [m]

  /// Holds no curve and no memory.
  Path() = default;
  /// Reserves memory for `capacity` points and holds no curve (length 0).
  static Path with_capacity(int capacity);
  /// Fails with kInvalidArgument naming the point, counted from 0: fewer than 2 points (3 when closed),
  /// non-finite or beyond kMaxCoordinate, coincident neighbours (when closed also last and first).
  [[nodiscard]] static Result<Path> create(std::span<const Vec2> points, bool closed);

  /// The same curve, `factor` > 0 times as large about the origin.
  [[nodiscard]] Path scaled(double factor) const;

  /// Replaces the curve without allocating. False, and no change, for data that create() would refuse or too
  /// many points.
  [[nodiscard]] bool rebuild(std::span<const Vec2> points, bool closed) noexcept;

  [[nodiscard]] int capacity() const noexcept { return static_cast<int>(cells_.size()); }
  [[nodiscard]] bool is_closed() const noexcept { return closed_; }
  [[nodiscard]] double length() const noexcept { return length_; }
  [[nodiscard]] bool is_empty() const noexcept { return length_ <= 0.0; }
  /// Arc length at point `i` of the given ones [m]. Pre: 0 <= i < their number.
  [[nodiscard]] double arc_length(int i) const noexcept {
    return i < count_ ? segments_[static_cast<std::size_t>(i)].s0 : length_;
  }
  /// Change of heading over a closed lap [rad]: 2π for a simple counter-clockwise loop, −2π for a clockwise
  /// one.
  [[nodiscard]] double turning() const noexcept { return turning_; }
  /// Point at any s: wrapped when closed, extended by a straight line beyond the ends when open. The heading
  /// is continuous beyond the first lap: at(s + length()).heading = at(s).heading + turning(). Zero for an
  /// empty path, NaN for NaN.
  [[nodiscard]] PathPoint at(double s) const noexcept;
  /// s in [0, length) for a closed path; clamped to [0, length] for an open one.
  [[nodiscard]] double wrap(double s) const noexcept;
  /// Signed distance along the path from s0 to s1: shortest way round when closed [m].
  [[nodiscard]] double difference(double s1, double s0) const noexcept;

  /// Nearest point of the whole curve. O(n).
  [[nodiscard]] Projection project(const Vec2& point) const noexcept;
  /// Projects a point of something that moves along `heading` [rad]. If the curve passes the point more than
  /// once, each time by less than `reach` [m] farther than the nearest time, the pass whose direction fits
  /// best: on a road that crosses itself, the driven one. O(n).
  [[nodiscard]] Projection project_along(const Vec2& point, double heading, double reach) const noexcept;
  /// Nearest point within `window` [m] of arc length before and after s_guess. O(window).
  [[nodiscard]] Projection project(const Vec2& point, double s_guess, double window) const noexcept;

 private:
  /// Piece between two given points: r(t) = a + b t + c t² + e t³ for t in [0, h], s = s0 + t.
  struct Segment {
    double s0 = 0.0;
    double h = 0.0;
    double heading = 0.0;  ///< heading at t = 0, unwrapped
    double bulge = 0.0;    ///< the curve stays within this of its chord [m]
    Vec2 a{};
    Vec2 b{};
    Vec2 c{};
    Vec2 e{};
  };
  /// Rows of the tridiagonal system for the second derivatives.
  struct Row {
    double factor = 0.0;
    double corner = 0.0;  ///< solution of the system for the corner entries of a closed path
    Vec2 second{};
  };

  void fit(std::span<const Vec2> points) noexcept;
  void solve_natural(std::span<const Vec2> points) noexcept;
  void solve_periodic(std::span<const Vec2> points) noexcept;
  void index() noexcept;
  [[nodiscard]] int segment_at(double s) const noexcept;
  [[nodiscard]] Projection search(const Vec2& point, double s_low, double s_high) const noexcept;
  template <class Visit>
  void for_each_segment(double s_low, double s_high, Visit&& visit) const noexcept;

  bool closed_ = false;
  int count_ = 0;  ///< segments in use
  double length_ = 0.0;
  double turning_ = 0.0;
  std::vector<Segment> segments_;
  std::vector<Row> rows_;
  std::vector<int> cells_;  ///< segment at the start of each of count_ equal cells of s
};

}  // namespace chicane::road
