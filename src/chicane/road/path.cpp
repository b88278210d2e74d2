// SPDX-License-Identifier: MIT
// Cubic spline through given points: its linear system, look-up by arc length, and projection of points.
#include "chicane/road/path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "chicane/base/math.hpp"
#include "chicane/road/detail/point_text.hpp"

namespace chicane::road {
namespace {

constexpr int kArcLengthPasses =
    2;  // corrections of the parameter; measured: a third changes 1e-7 of the length
constexpr double kMinSpeedSquared = 1e-12;  // |r'|² below this is a cusp: keeps curvature finite
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Reason why points are no curve.
struct Fault {
  std::size_t point = 0;           // index of the point
  const char* expected = nullptr;  // null: too few points
};

/// First fault of the points; none if they are a curve.
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
  // System of solve_natural() with neighbours modulo n. The last unknown m* is set aside: m = u + w m*, where
  // `corner` is w; the last row then gives m*.
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
  const auto count = static_cast<std::size_t>(count_);
  length_ = 0.0;
  double heading = atan2(segments_[0].b.y(), segments_[0].b.x());
  for (std::size_t i = 0; i < count; ++i) {
    Segment& segment = segments_[i];
    segment.s0 = length_;
    segment.heading = heading;
    const Vec2 half = segment.b + segment.h * (segment.c + 0.75 * segment.h * segment.e);
    const Vec2 end = segment.b + segment.h * (2.0 * segment.c + 3.0 * segment.h * segment.e);
    if (segment.b.dot(half) > 0.0 && half.dot(end) > 0.0) {  // each half turns by less than a quarter turn
      heading += atan2(segment.b.cross(end), segment.b.dot(end));
    } else {
      heading += atan2(segment.b.cross(half), segment.b.dot(half)) + atan2(half.cross(end), half.dot(end));
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
  // Includes the neighbouring cells, as rounding can move s across the border of two cells.
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
  point.heading = segment.heading + atan2(segment.b.cross(first), segment.b.dot(first));
  const double beyond = s - inside;
  if (!closed_ && beyond != 0.0) {
    point.position += beyond / std::max(first.norm(), std::sqrt(kMinSpeedSquared)) * first;
    return point;
  }
  if (closed_ && beyond != 0.0) point.heading += turning_ * std::round(beyond / length_);
  const double speed_squared = std::max(first.squared_norm(), kMinSpeedSquared);
  const double speed = std::sqrt(speed_squared);
  point.curvature = first.cross(second) / (speed_squared * speed);
  point.curvature_slope = (first.cross(third) / (speed_squared * speed) -
                           3.0 * point.curvature * first.dot(second) / speed_squared) /
                          speed;
  return point;
}

namespace {

constexpr double kBetterFit =
    0.1;                         // least gain in heading fit of another pass over the nearest [rad]; chosen
constexpr int kSamples = 4;      // intervals scanned for the start of Newton's method; chosen
constexpr int kIterations = 30;  // limit of Newton's method, safeguarded by bisection; 3 or 4 are typical

/// Nearest point of a segment.
struct Foot {
  double distance_squared = std::numeric_limits<double>::infinity();
  double s = 0.0;
  Vec2 gap{};      // point minus foot
  Vec2 tangent{};  // tangent, not normalised
};

/// Distance of a point from the chord of a segment [m].
template <class Segment>
double chord_distance(const Segment& segment, const Vec2& point) noexcept {
  const Vec2 chord = segment.h * (segment.b + segment.h * (segment.c + segment.h * segment.e));
  const Vec2 gap = point - segment.a;
  return (gap - std::clamp(gap.dot(chord) / chord.squared_norm(), 0.0, 1.0) * chord).norm();
}

/// Nearest point of a segment for t in [low, high]: the best of a few samples, then the root of gap · tangent
/// around that sample by Newton's method.
template <class Segment>
Foot nearest_on(const Segment& segment, const Vec2& point, double low, double high) noexcept {
  const auto gap_at = [&](double t) -> Vec2 {
    return point - segment.a - t * (segment.b + t * (segment.c + t * segment.e));
  };
  const auto tangent_at = [&](double t) -> Vec2 {
    return segment.b + t * (2.0 * segment.c + 3.0 * t * segment.e);
  };
  const double interval = (high - low) / kSamples;
  double t = low;
  double nearest = gap_at(low).squared_norm();
  for (int k = 1; k <= kSamples; ++k) {
    const double candidate = k == kSamples ? high : low + interval * k;
    const double squared = gap_at(candidate).squared_norm();
    if (squared < nearest) {
      nearest = squared;
      t = candidate;
    }
  }
  low = std::max(low, t - interval);
  high = std::min(high, t + interval);
  for (int k = 0; k < kIterations; ++k) {
    const Vec2 gap = gap_at(t);
    const Vec2 tangent = tangent_at(t);
    const double ahead = gap.dot(tangent);  // positive: the foot lies at a larger t
    (ahead > 0.0 ? low : high) = t;
    const double newton =
        t + ahead / (tangent.squared_norm() - gap.dot(2.0 * segment.c + 6.0 * t * segment.e));
    const double moved = newton >= low && newton <= high ? newton : 0.5 * (low + high);
    const bool has_converged = std::fabs(moved - t) < 1e-13 * (1.0 + segment.s0);
    t = moved;
    if (has_converged) break;
  }
  const Vec2 gap = gap_at(t);
  return {gap.squared_norm(), segment.s0 + t, gap, tangent_at(t)};
}

}  // namespace

template <class Visit>
void Path::for_each_segment(double s_low, double s_high, Visit&& visit) const noexcept {
  double s = s_low;
  int i = segment_at(s_low);
  double low = s_low - segments_[static_cast<std::size_t>(i)].s0;
  for (int visited = 0; visited <= count_; ++visited) {
    const Segment& segment = segments_[static_cast<std::size_t>(i)];
    const double high = std::min(segment.h, low + (s_high - s));
    visit(segment, low, high);
    s += segment.h - low;
    low = 0.0;
    i = i + 1 == count_ ? 0 : i + 1;
    if (s >= s_high || (!closed_ && i == 0)) return;
  }
}

Projection Path::search(const Vec2& point, double s_low, double s_high) const noexcept {
  // Searches the segment with the nearest chord first. A segment stays within `bulge` of its chord, so that
  // of the others only those are searched that can have a nearer point.
  struct Part {
    const Segment* segment = nullptr;
    double low = 0.0;
    double high = 0.0;
  } first;
  double nearest_chord = std::numeric_limits<double>::infinity();
  for_each_segment(s_low, s_high, [&](const Segment& segment, double low, double high) {
    const double distance = chord_distance(segment, point);
    if (distance >= nearest_chord) return;
    nearest_chord = distance;
    first = {&segment, low, high};
  });
  if (first.segment == nullptr) {  // only for a point that is not finite
    return {wrap(s_low), kNan, kNan};
  }
  Foot foot = nearest_on(*first.segment, point, first.low, first.high);
  for_each_segment(s_low, s_high, [&](const Segment& segment, double low, double high) {
    if (&segment == first.segment && low == first.low) return;
    const double reach = std::max(chord_distance(segment, point) - segment.bulge, 0.0);
    if (reach * reach > foot.distance_squared) return;
    const Foot rival = nearest_on(segment, point, low, high);
    if (rival.distance_squared < foot.distance_squared) foot = rival;
  });
  const double speed = std::max(foot.tangent.norm(), 1e-12);
  return {wrap(foot.s), foot.tangent.cross(foot.gap) / speed, std::sqrt(foot.distance_squared)};
}

Projection Path::project(const Vec2& point) const noexcept {
  if (is_empty()) return {};
  return search(point, 0.0, length_);
}

Projection Path::project_along(const Vec2& point, double heading, double reach) const noexcept {
  if (is_empty()) return {};
  const Projection nearest = search(point, 0.0, length_);
  if (!std::isfinite(nearest.distance + heading)) return nearest;
  const auto misfit = [&](double s) { return std::fabs(angle_difference(at(s).heading, heading)); };
  const double most = nearest.distance + reach;
  Projection best = nearest;
  double least = misfit(nearest.s);
  // A pass: among consecutive segments near enough, the one with the nearest chord.
  const Segment* pass = nullptr;
  double pass_distance = 0.0;
  const auto end_pass = [&] {
    if (pass == nullptr) return;
    const Projection there = project(point, pass->s0 + 0.5 * pass->h, pass->h + reach);
    if (there.distance <= most && misfit(there.s) < least - kBetterFit) {
      least = misfit(there.s);
      best = there;
    }
    pass = nullptr;
  };
  for (int i = 0; i < count_; ++i) {
    const Segment& segment = segments_[static_cast<std::size_t>(i)];
    const double distance = chord_distance(segment, point);
    if (distance - segment.bulge > most) {
      end_pass();
    } else if (pass == nullptr || distance < pass_distance) {
      pass = &segment;
      pass_distance = distance;
    }
  }
  end_pass();
  return best;
}

Projection Path::project(const Vec2& point, double s_guess, double window) const noexcept {
  if (is_empty()) return {};
  const double half = std::max(window, 0.0);
  if (!std::isfinite(s_guess) || !(2.0 * half < length_)) return search(point, 0.0, length_);
  const double low = wrap(s_guess - half);
  return search(point, low, closed_ ? low + 2.0 * half : wrap(s_guess + half));
}

}  // namespace chicane::road
