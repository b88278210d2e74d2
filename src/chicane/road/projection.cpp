// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include "chicane/base/angle.hpp"
#include "chicane/road/path.hpp"

namespace chicane::road {
namespace {

constexpr double kBetterFit = 0.1;  // by which another pass has to fit better than the nearest [rad]
constexpr int kSamples = 4;         // intervals scanned for the start of the refinement
constexpr int kIterations = 30;     // of Newton's method with bisection as safeguard; 3 or 4 are typical

struct Foot {
  double distance_squared = std::numeric_limits<double>::infinity();
  double s = 0.0;
  Vec2 gap{};      // point minus foot
  Vec2 tangent{};  // not normalised
};

template <class Segment>
double chord_distance(const Segment& segment, const Vec2& point) noexcept {
  const Vec2 chord = segment.h * (segment.b + segment.h * (segment.c + segment.h * segment.e));
  const Vec2 gap = point - segment.a;
  return (gap - std::clamp(gap.dot(chord) / chord.squared_norm(), 0.0, 1.0) * chord).norm();
}

/// Nearest point of a segment for t in [low, high]: best of a few samples, then the root of gap · tangent
/// around it.
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
    const double ahead = gap.dot(tangent);  // positive: the foot lies further on
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
  // The parts of segments within [s_low, s_high]: s_low in [0, length], at most one lap.
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
  // A segment stays within `bulge` of its chord: after the one with the nearest chord, only segments that can
  // still hold a nearer point are looked at closely.
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
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
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
  const double left = (foot.tangent.x() * foot.gap.y() - foot.tangent.y() * foot.gap.x()) / speed;
  return {wrap(foot.s), left, std::sqrt(foot.distance_squared)};
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
  // A pass: the nearest of neighbouring segments that come near enough.
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
