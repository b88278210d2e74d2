// SPDX-License-Identifier: MIT
#include "chicane/road/line_planner.hpp"

#include <algorithm>
#include <cmath>

#include "chicane/base/angle.hpp"
#include "chicane/base/math.hpp"

namespace chicane::road {
namespace {

constexpr int kFewestIntervals = 5;  // the smoother needs six knots

enum Phase { kTake, kSmooth, kMove, kShape, kSample, kSpeed, kDone };

/// Eq. 9: what the curvature's slope costs relative to curvature is the yaw inertia against the tyres' share.
double slope_length(const model::VehicleParams& vehicle) noexcept {
  const double length = vehicle.yaw_inertia / (vehicle.mass * vehicle.rear_axle);
  return std::clamp(length / std::max(0.05, 1.0 - vehicle.steer_helper), 1.0, 10.0);
}

}  // namespace

LinePlanner::LinePlanner(int knots) : smoother_{knots + 2 * kOverlap}, speed_plan_{samples_for(knots)} {
  knots_.resize(static_cast<std::size_t>(knots));
  moved_.resize(static_cast<std::size_t>(knots));
}

void LinePlanner::configure(const LinePlannerOptions& options, const model::VehicleParams& vehicle) noexcept {
  options_ = options;
  vehicle_ = vehicle;
  smoother_.configure(options.smoothing_width, slope_length(vehicle));
}

bool LinePlanner::begin(double from, double to, bool is_lap) noexcept {
  from_ = from;
  length_ = to - from;
  is_lap_ = is_lap;
  const double wanted = std::ceil(length_ / WaypointLine::kSpacing);
  if (!(length_ > 0.0 && wanted < static_cast<double>(knots_.size()))) return false;
  intervals_ = std::max(static_cast<int>(wanted), kFewestIntervals);
  // A lap is divided evenly. A stretch keeps the knots of its source; its last one may lie beyond its end.
  spacing_ = is_lap ? length_ / intervals_ : WaypointLine::kSpacing;
  extra_ = is_lap ? std::min(kOverlap, intervals_) : 0;
  smoother_.begin(is_lap ? intervals_ + 2 * extra_ : intervals_ + 1, spacing_, is_lap ? intervals_ : 0);
  instalments_.restart();
  return true;
}

bool LinePlanner::advance(int work, const WaypointLine& source, ReferenceLine& line) noexcept {
  while (work > 0) {
    switch (instalments_.phase()) {
      case kTake:
        instalments_.loop(intervals_ + 1, 3, work, [&](int k) { take(source, k); });
        break;
      case kSmooth:
        if (smoother_.advance(work)) instalments_.enter(kMove);
        break;
      case kMove:
        instalments_.loop(intervals_ + 1, 6, work, [&](int k) { move(k); });
        break;
      case kShape:
        if (!shape(line)) return true;
        instalments_.enter(kSample);
        break;
      case kSample:
        instalments_.loop(static_cast<int>(line.samples().size()), 3, work, [&](int i) { sample(line, i); });
        break;
      case kSpeed:
        if (speed_plan_.advance(work, line)) instalments_.enter(kDone);
        break;
      default:
        return true;
    }
  }
  return instalments_.phase() == kDone;
}

void LinePlanner::take(const WaypointLine& source, int k) noexcept {
  const auto i = static_cast<std::size_t>(k);
  knots_[i] = source.at(from_ + k * spacing_);
  const auto curvature = smoother_.curvature();
  curvature[static_cast<std::size_t>(k + extra_)] = knots_[i].curvature;
  if (!is_lap_) return;
  if (k == intervals_) {  // the first knot, a lap later
    const double turning = kTwoPi * std::round((knots_[i].heading - knots_[0].heading) / kTwoPi);
    knots_[i] = knots_[0];
    knots_[i].heading += turning;
    curvature[static_cast<std::size_t>(k + extra_)] = knots_[0].curvature;
    return;
  }
  if (k < extra_) curvature[static_cast<std::size_t>(k + extra_ + intervals_)] = knots_[i].curvature;
  if (k >= intervals_ - extra_)
    curvature[static_cast<std::size_t>(k + extra_ - intervals_)] = knots_[i].curvature;
}

double LinePlanner::offset(int k) const noexcept {
  if (!is_lap_) return smoother_.offset(k);
  k = (k + intervals_) % intervals_;
  const double n = smoother_.offset(k + extra_);
  if (k >= extra_) return n;
  // Behind the seam the line has been smoothed twice, once as the continuation of its own end: fade from one
  // to the other.
  const double share = static_cast<double>(k) / extra_;
  return share * n + (1.0 - share) * smoother_.offset(k + extra_ + intervals_);
}

/// Knot k of the line moved by its offset: position, tangent and curvature follow from n, n', n'' exactly.
void LinePlanner::move(int k) noexcept {
  const auto i = static_cast<std::size_t>(k);
  const CurvePoint& raw = knots_[i];
  const double n = offset(k);
  // The ends of a stretch bend as the knots beside them do.
  const int inner = is_lap_ ? k : std::clamp(k, 1, intervals_ - 1);
  const double before = offset(inner - 1);
  const double after = offset(inner + 1);
  const double n2 = (after - 2.0 * offset(inner) + before) / (spacing_ * spacing_);
  const double n1 = 0.5 * (after - before) / spacing_ + (k - inner) * spacing_ * n2;
  const auto curvature = [&](int at) {
    if (is_lap_) at = (at + intervals_) % intervals_;
    return knots_[static_cast<std::size_t>(at)].curvature;
  };
  const double slope = 0.5 * (curvature(inner + 1) - curvature(inner - 1)) / spacing_;
  const double along = std::max(0.1, 1.0 - raw.curvature * n);
  const double speed = std::sqrt(along * along + n1 * n1);
  const Vec2 normal{-raw.tangent.y(), raw.tangent.x()};
  Moved& to = moved_[i];
  to.offset = n;
  to.curve.position = raw.position + n * normal;
  to.curve.tangent = (along * raw.tangent + n1 * normal) / speed;
  to.curve.heading = raw.heading + atan(n1 / along);
  to.curve.curvature = (along * (n2 + raw.curvature * along) + n1 * (slope * n + 2.0 * raw.curvature * n1)) /
                       (speed * speed * speed);
  if (k == 0) {
    to.s = 0.0;
    return;
  }
  const Moved& from = moved_[i - 1];
  const double chord = (to.curve.position - from.curve.position).norm();
  const double bend = 0.5 * (from.curve.curvature + to.curve.curvature) * chord;
  to.s = from.s + chord * (1.0 + bend * bend / 24.0);
}

bool LinePlanner::shape(ReferenceLine& line) noexcept {
  // The end of the stretch lies between two knots.
  const int index = std::min(static_cast<int>(length_ / spacing_), intervals_ - 1);
  const double before = moved_[static_cast<std::size_t>(index)].s;
  const double after = moved_[static_cast<std::size_t>(index + 1)].s;
  const double length = before + (length_ / spacing_ - index) * (after - before);
  const int samples = static_cast<int>(std::ceil(length / kSampleSpacing));
  behind_ = 0;
  speed_plan_.begin(vehicle_, options_.speed);
  if (line.shape(length, samples, is_lap_)) return true;
  line.clear();
  return false;
}

void LinePlanner::sample(ReferenceLine& line, int i) noexcept {
  const double s = i * line.spacing();
  while (behind_ + 1 < intervals_ && moved_[static_cast<std::size_t>(behind_ + 1)].s <= s) ++behind_;
  const Moved& from = moved_[static_cast<std::size_t>(behind_)];
  const Moved& to = moved_[static_cast<std::size_t>(behind_ + 1)];
  const double length = to.s - from.s;
  const double share = std::min((s - from.s) / length, 1.0);
  ReferenceLine::Sample& at = line.samples()[static_cast<std::size_t>(i)];
  at.curve = between(from.curve, to.curve, length, share);
  at.offset = from.offset + share * (to.offset - from.offset);
}

}  // namespace chicane::road
