// SPDX-License-Identifier: MIT
#include "chicane/road/path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "chicane/base/angle.hpp"
#include "chicane/base/math.hpp"
#include "chicane/road/detail/point_text.hpp"

namespace chicane::road {
namespace {

constexpr int kArcLengthPasses = 2;  // corrections of the parameter; a third changes 1e-7 of the length
constexpr double kMinSpeedSquared = 1e-12;  // |r'|² below this is a cusp: keeps curvature finite

struct Fault {
  std::size_t point = 0;
  const char* expected = nullptr;
};

/// The first thing that keeps the points from being a curve.
std::optional<Fault> find_fault(std::span<const Vec2> points, bool closed) noexcept {
  if (points.size() < (closed ? 3U : 2U)) return Fault{points.size(), nullptr};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool is_usable =
        std::fabs(points[i].x()) <= Path::kMaxCoordinate && std::fabs(points[i].y()) <= Path::kMaxCoordinate;
    if (!is_usable) return Fault{i, "finite coordinates within 1e7 m"};
    if (i > 0 && (points[i] - points[i - 1]).norm() < Path::kMinSpacing)
      return Fault{i, "a point apart from the one before"};
  }
  if (closed && (points.front() - points.back()).norm() < Path::kMinSpacing) {
    return Fault{points.size() - 1, "a last point apart from the first"};
  }
  return std::nullopt;
}

double cross(const Vec2& a, const Vec2& b) noexcept { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

Path Path::with_capacity(int capacity) {
  Path path;
  const auto size = static_cast<std::size_t>(std::max(capacity, 0));
  path.segments_.resize(size);
  path.rows_.resize(size);
  path.cells_.resize(size);
  return path;
}

Path Path::scaled(double factor) const {
  Path path = *this;
  path.length_ *= factor;
  for (Segment& segment : path.segments_) {
    segment.s0 *= factor;
    segment.h *= factor;
    segment.bulge *= factor;
    segment.a *= factor;
    segment.c *= 1.0 / factor;
    segment.e *= 1.0 / (factor * factor);
  }
  return path;
}

Result<Path> Path::create(std::span<const Vec2> points, bool closed) {
  if (const std::optional<Fault> fault = find_fault(points, closed)) {
    if (fault->expected == nullptr) {
      return fail(ErrorCode::kInvalidArgument, "points: got " + std::to_string(points.size()) +
                                                   ", expected at least " +
                                                   (closed ? "3 for a closed path" : "2"));
    }
    return fail(ErrorCode::kInvalidArgument, "points[" + std::to_string(fault->point) + "]: got " +
                                                 point_text(points[fault->point]) + ", expected " +
                                                 fault->expected);
  }
  Path path = with_capacity(static_cast<int>(points.size()));
  path.closed_ = closed;
  path.fit(points);
  return path;
}

bool Path::rebuild(std::span<const Vec2> points, bool closed) noexcept {
  if (points.size() > cells_.size() || find_fault(points, closed)) return false;
  closed_ = closed;
  fit(points);
  return true;
}

void Path::solve_natural(std::span<const Vec2> points) noexcept {
  // Thomas algorithm for h₋ m₋ + 2 (h₋ + h) m + h m₊ = 6 (Δ − Δ₋), with m = 0 at both ends.
  const std::size_t n = points.size();
  rows_[0] = Row{};
  Vec2 slope = (points[1] - points[0]) / segments_[0].h;
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = segments_[i - 1].h;
    const double after = segments_[i].h;
    const Vec2 next_slope = (points[i + 1] - points[i]) / after;
    const double pivot = 1.0 / (2.0 * (before + after) - before * rows_[i - 1].factor);
    rows_[i].factor = after * pivot;
    rows_[i].second = (6.0 * (next_slope - slope) - before * rows_[i - 1].second) * pivot;
    slope = next_slope;
  }
  rows_[n - 1] = Row{};
  for (std::size_t i = n - 1; i-- > 1;) rows_[i].second -= rows_[i].factor * rows_[i + 1].second;
}

void Path::solve_periodic(std::span<const Vec2> points) noexcept {
  // As above with neighbours modulo n. The last unknown m* is set aside: m = u + w m*, where `corner` carries
  // w; the last row then gives m*.
  const std::size_t n = points.size();
  const std::size_t last = n - 1;
  const double closing = segments_[last].h;
  const auto right_side = [&](std::size_t i) -> Vec2 {
    const std::size_t before = i == 0 ? last : i - 1;
    return 6.0 * ((points[i == last ? 0 : i + 1] - points[i]) / segments_[i].h -
                  (points[i] - points[before]) / segments_[before].h);
  };
  double pivot = 1.0 / (2.0 * (closing + segments_[0].h));
  rows_[0] = Row{segments_[0].h * pivot, -closing * pivot, right_side(0) * pivot};
  for (std::size_t i = 1; i < last; ++i) {
    const double before = segments_[i - 1].h;
    const double after = segments_[i].h;
    pivot = 1.0 / (2.0 * (before + after) - before * rows_[i - 1].factor);
    const double corner = i + 1 == last ? -after : 0.0;
    rows_[i].factor = after * pivot;
    rows_[i].corner = (corner - before * rows_[i - 1].corner) * pivot;
    rows_[i].second = (right_side(i) - before * rows_[i - 1].second) * pivot;
  }
  for (std::size_t i = last - 1; i-- > 0;) {
    rows_[i].second -= rows_[i].factor * rows_[i + 1].second;
    rows_[i].corner -= rows_[i].factor * rows_[i + 1].corner;
  }
  const double before = segments_[last - 1].h;
  rows_[last].second =
      (right_side(last) - before * rows_[last - 1].second - closing * rows_[0].second) /
      (2.0 * (before + closing) + before * rows_[last - 1].corner + closing * rows_[0].corner);
  for (std::size_t i = 0; i < last; ++i) rows_[i].second += rows_[i].corner * rows_[last].second;
}

void Path::fit(std::span<const Vec2> points) noexcept {
  const std::size_t n = points.size();
  const std::size_t count = closed_ ? n : n - 1;
  const auto next = [n](std::size_t i) { return i + 1 == n ? 0 : i + 1; };
  for (std::size_t i = 0; i < count; ++i) segments_[i].h = (points[next(i)] - points[i]).norm();
  for (int pass = 0; pass <= kArcLengthPasses; ++pass) {
    closed_ ? solve_periodic(points) : solve_natural(points);
    for (std::size_t i = 0; i < count; ++i) {
      Segment& segment = segments_[i];
      const double h = segment.h;
      const Vec2& m0 = rows_[i].second;
      const Vec2& m1 = rows_[next(i)].second;
      segment.a = points[i];
      segment.b = (points[next(i)] - points[i]) / h - h / 6.0 * (2.0 * m0 + m1);
      segment.c = 0.5 * m0;
      segment.e = (m1 - m0) / (6.0 * h);
      segment.bulge = h * h / 8.0 * std::max(m0.norm(), m1.norm());
      if (pass == kArcLengthPasses) continue;
      const auto speed = [&](double t) {
        return (segment.b + t * (2.0 * segment.c + 3.0 * t * segment.e)).norm();
      };
      constexpr double kNode = 0.3872983346207417;  // Gauss–Legendre, three points: sqrt(3/5)/2
      segment.h =
          h / 18.0 * (5.0 * speed((0.5 - kNode) * h) + 8.0 * speed(0.5 * h) + 5.0 * speed((0.5 + kNode) * h));
    }
  }
  count_ = static_cast<int>(count);
  index();
}

void Path::index() noexcept {
  // Arc length and heading of each segment's start; then the segment at the start of each of count_ equal
  // cells.
  const auto count = static_cast<std::size_t>(count_);
  length_ = 0.0;
  double heading = atan2(segments_[0].b.y(), segments_[0].b.x());
  for (std::size_t i = 0; i < count; ++i) {
    Segment& segment = segments_[i];
    segment.s0 = length_;
    segment.heading = heading;
    const Vec2 half = segment.b + segment.h * (segment.c + 0.75 * segment.h * segment.e);
    const Vec2 end = segment.b + segment.h * (2.0 * segment.c + 3.0 * segment.h * segment.e);
    if (segment.b.dot(half) > 0.0 && half.dot(end) > 0.0) {  // two quarter turns at most
      heading += atan2(cross(segment.b, end), segment.b.dot(end));
    } else {
      heading += atan2(cross(segment.b, half), segment.b.dot(half)) + atan2(cross(half, end), half.dot(end));
    }
    length_ += segment.h;
  }
  turning_ = closed_ ? kTwoPi * std::round((heading - segments_[0].heading) / kTwoPi)
                     : heading - segments_[0].heading;
  std::size_t i = 0;
  for (std::size_t cell = 0; cell < count; ++cell) {
    const double start = length_ * static_cast<double>(cell) / static_cast<double>(count);
    while (i + 1 < count && segments_[i + 1].s0 <= start) ++i;
    cells_[cell] = static_cast<int>(i);
  }
}

int Path::segment_at(double s) const noexcept {
  const int cell = std::clamp(static_cast<int>(s / length_ * count_), 0, count_ - 1);
  // One cell early and late, for s on the border of two cells after rounding.
  const auto first = segments_.begin() + cells_[static_cast<std::size_t>(std::max(cell - 1, 0))];
  const auto end =
      segments_.begin() + (cell + 2 < count_ ? cells_[static_cast<std::size_t>(cell + 2)] + 1 : count_);
  const auto after = std::upper_bound(
      first + 1, end, s, [](double value, const Segment& segment) { return value < segment.s0; });
  return static_cast<int>(after - segments_.begin()) - 1;
}

double Path::wrap(double s) const noexcept {
  if (!closed_) return std::clamp(s, 0.0, length_);
  if (s >= 0.0 && s < length_) return s;
  if (is_empty()) return 0.0;
  const double wrapped = s - length_ * std::floor(s / length_);
  return wrapped >= length_ || wrapped < 0.0 ? 0.0 : wrapped;
}

double Path::difference(double s1, double s0) const noexcept {
  if (!closed_) return s1 - s0;
  const double forward = wrap(s1 - s0);
  return forward > 0.5 * length_ ? forward - length_ : forward;
}

PathPoint Path::at(double s) const noexcept {
  if (is_empty()) return {};
  if (!std::isfinite(s)) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    return {Vec2{kNan, kNan}, kNan, kNan, kNan};
  }
  const double inside = wrap(s);
  const Segment& segment = segments_[static_cast<std::size_t>(segment_at(inside))];
  const double t = inside - segment.s0;
  const Vec2 first = segment.b + t * (2.0 * segment.c + 3.0 * t * segment.e);
  const Vec2 second = 2.0 * segment.c + 6.0 * t * segment.e;
  const Vec2 third = 6.0 * segment.e;

  PathPoint point;
  point.position = segment.a + t * (segment.b + t * (segment.c + t * segment.e));
  point.heading = segment.heading + atan2(cross(segment.b, first), segment.b.dot(first));
  const double beyond = s - inside;
  if (!closed_ && beyond != 0.0) {
    point.position += beyond / std::max(first.norm(), std::sqrt(kMinSpeedSquared)) * first;
    return point;
  }
  if (closed_ && beyond != 0.0) point.heading += turning_ * std::round(beyond / length_);
  const double speed_squared = std::max(first.squared_norm(), kMinSpeedSquared);
  const double speed = std::sqrt(speed_squared);
  point.curvature = cross(first, second) / (speed_squared * speed);
  point.curvature_slope = (cross(first, third) / (speed_squared * speed) -
                           3.0 * point.curvature * first.dot(second) / speed_squared) /
                          speed;
  return point;
}

}  // namespace chicane::road
