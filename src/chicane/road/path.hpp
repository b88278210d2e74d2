// SPDX-License-Identifier: MIT
// Path: a smooth plane curve through given points, by arc length, with projection of points onto it.
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

/// Nearest point of a path to a given point, and the given point's path coordinates s and d.
struct Projection {
  double s = 0.0;  ///< arc length of the nearest point [m]; in [0, length) when closed
  double d = 0.0;  ///< signed distance, left positive [m]
  /// |point − nearest point| [m]; differs from |d| beyond an open end or at the end of a search window.
  double distance = 0.0;
};

/// Smooth plane curve by arc length s: interpolating C² cubic spline through given points, periodic when
/// closed, natural (no curvature at the ends) when open. The parameter s is the arc length at the points;
/// between them |dr/ds| is within 1e-3 of 1 where the curve turns by less than 0.35 rad from point to point,
/// within 1e-2 below 0.6 rad. Heading and curvature are exact for the curve.
///
/// Memory is reserved once: rebuild() within capacity() allocates nothing, so a controller may renew its path
/// every step. at() takes O(1), also for unevenly spaced points. Copies keep the capacity. const calls are
/// safe from many threads.
class Path {
 public:
  static constexpr double kMinSpacing = 1e-6;    ///< neighbours closer than this coincide [m]
  static constexpr double kMaxCoordinate = 1e7;  ///< |x|, |y| of a point [m]

  /// Empty path without memory.
  Path() = default;
  /// Empty path (length 0) with memory for `capacity` points.
  static Path with_capacity(int capacity);
  /// Path through `points`. Fails with kInvalidArgument, which names the point counted from 0, for fewer than
  /// 2 points (3 when closed), coordinates that are not finite or beyond kMaxCoordinate, and coincident
  /// neighbours (when closed also last and first).
  [[nodiscard]] static Result<Path> create(std::span<const Vec2> points, bool closed);

  /// Curve enlarged `factor` > 0 times about the origin.
  [[nodiscard]] Path scaled(double factor) const;

  /// Replaces the curve without allocating. False, and no change, for more points than capacity() and for
  /// points that create() refuses.
  [[nodiscard]] bool rebuild(std::span<const Vec2> points, bool closed) noexcept;

  [[nodiscard]] int capacity() const noexcept { return static_cast<int>(cells_.size()); }
  [[nodiscard]] bool is_closed() const noexcept { return closed_; }
  [[nodiscard]] double length() const noexcept { return length_; }
  [[nodiscard]] bool is_empty() const noexcept { return length_ <= 0.0; }
  /// Arc length at the given point number `i` [m]. Pre: 0 <= i < number of given points.
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
  /// Arc length brought into [0, length) for a closed path, clamped to [0, length] for an open one.
  [[nodiscard]] double wrap(double s) const noexcept;
  /// Signed distance along the path from s0 to s1 [m]; the shorter way round when closed.
  [[nodiscard]] double difference(double s1, double s0) const noexcept;

  /// Nearest point of the whole curve. O(n).
  [[nodiscard]] Projection project(const Vec2& point) const noexcept;
  /// Projects the position of a car that moves along `heading` [rad]. Where the curve passes the point
  /// several times, as on a road that crosses itself, chooses the pass whose direction fits best among those
  /// less than `reach` [m] farther away than the nearest. O(n).
  [[nodiscard]] Projection project_along(const Vec2& point, double heading, double reach) const noexcept;
  /// Nearest point within `window` [m] of arc length before and after `s_guess`. O(window).
  [[nodiscard]] Projection project(const Vec2& point, double s_guess, double window) const noexcept;

 private:
  /// Piece between two given points: r(t) = a + b t + c t² + e t³ for t in [0, h], s = s0 + t.
  struct Segment {
    double s0 = 0.0;       ///< arc length at t = 0 [m]
    double h = 0.0;        ///< length [m]
    double heading = 0.0;  ///< heading at t = 0 [rad], unwrapped
    double bulge = 0.0;    ///< bound of the curve's distance from its chord [m]
    Vec2 a{};
    Vec2 b{};
    Vec2 c{};
    Vec2 e{};
  };
  /// Row of the tridiagonal system for the second derivatives at the points.
  struct Row {
    double factor = 0.0;  ///< entry beside the diagonal after elimination, whose diagonal is 1
    double corner = 0.0;  ///< solution of the system for the corner entries of a closed path
    Vec2 second{};        ///< second derivative
  };

  /// Computes all segments. Pre: closed_ is set, and the points are those that create() accepts.
  void fit(std::span<const Vec2> points) noexcept;
  void solve_natural(std::span<const Vec2> points) noexcept;   ///< second derivatives of an open path
  void solve_periodic(std::span<const Vec2> points) noexcept;  ///< second derivatives of a closed path
  /// Computes arc length and heading at the segments' starts, and cells_.
  void index() noexcept;
  /// Index of the segment at s in [0, length].
  [[nodiscard]] int segment_at(double s) const noexcept;
  /// Nearest point for s in [s_low, s_high].
  [[nodiscard]] Projection search(const Vec2& point, double s_low, double s_high) const noexcept;
  /// Calls visit(segment, low, high) for the parts t in [low, high] of segments within [s_low, s_high]: s_low
  /// in [0, length], at most one lap.
  template <class Visit>
  void for_each_segment(double s_low, double s_high, Visit&& visit) const noexcept;

  bool closed_ = false;
  int count_ = 0;         ///< segments in use
  double length_ = 0.0;   ///< [m]; 0: empty
  double turning_ = 0.0;  ///< change of heading over the whole path [rad]
  std::vector<Segment> segments_;
  std::vector<Row> rows_;
  std::vector<int> cells_;  ///< segment at the start of each of count_ equal cells of s
};

}  // namespace chicane::road
