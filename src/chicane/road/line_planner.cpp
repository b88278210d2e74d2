// SPDX-License-Identifier: MIT
// Planning of a line in instalments: smoothing within a strip (LineSmoother), speeds by the limits of tyres,
// drive and brakes (SpeedPlan), and the steps from waypoint line to planned line (LinePlanner).
#include "chicane/road/line_planner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "chicane/base/math.hpp"

namespace chicane::road {
namespace {

constexpr int kPasses = 10;            // passes over the weights; chosen: bounds the work
constexpr double kLeastWeight = 1e-3;  // √w where there is room [1/m²]
constexpr double kFirstWeight = 2e-3;  // √w of the first pass [1/m²]
constexpr double kEndWeight = 5e-2;    // √w added at the ends of the line [1/m²]
constexpr double kLeastChange = 0.4;   // bounds of the factor of √w in one pass; chosen: converges without
constexpr double kMostChange = 2.5;    // oscillation

}  // namespace

LineSmoother::LineSmoother(int capacity) {
  curvature_.resize(static_cast<std::size_t>(capacity));
  offset_.resize(static_cast<std::size_t>(capacity + kMargin));
  rows_.resize(static_cast<std::size_t>(capacity + 2 * kMargin));
}

void LineSmoother::configure(double width, double slope_length) noexcept {
  width_ = width;
  slope_length_ = slope_length;
}

void LineSmoother::begin(int knots, double spacing, int period) noexcept {
  knots_ = knots;
  spacing_ = spacing;
  period_ = period;
  instalments_.restart();
}

bool LineSmoother::advance(int& work) noexcept {
  constexpr int kLastPhase = 2 + 3 * kPasses;
  if (instalments_.phase() == 0 && !(width_ > 0.0)) {
    std::fill(offset_.begin(), offset_.begin() + knots_, 0.0);
    instalments_.enter(kLastPhase);
  }
  while (work > 0 && instalments_.phase() < kLastPhase) {
    const int phase = instalments_.phase();
    if (phase == 0) {
      for (int k = 0; k < kMargin; ++k) {
        row(k - kMargin) = row(knots_ + k) = {};
        offset_[static_cast<std::size_t>(knots_ + k)] = 0.0;
      }
      instalments_.loop(knots_, 1, work, [&](int k) {
        row(k) = {};
        row(k).root_weight = kFirstWeight;
      });
    } else if (phase == 1) {
      instalments_.loop(knots_ - 2, 2, work, [&](int k) { assemble(k + 1); });
    } else if ((phase - 2) % 3 == 0) {
      instalments_.loop(knots_, 1, work, [&](int k) { eliminate(k); });
    } else if ((phase - 2) % 3 == 1) {
      instalments_.loop(knots_, 1, work, [&](int k) { substitute(knots_ - 1 - k); });
    } else {
      instalments_.loop(knots_, 1, work, [&](int k) { raise_weight(k); });
    }
  }
  return instalments_.phase() == kLastPhase;
}

void LineSmoother::assemble(int k) noexcept {
  add_bending(k);
  if (k + 2 < knots_) add_slope(k);
  if (k > 1 && k + 2 < knots_) return;
  // Weights of the ends of the line: on their offsets, and on the difference to their neighbours' offsets, so
  // that the new line begins and ends near the given one and almost parallel to it.
  const int end = k == 1 ? 0 : knots_ - 1;
  const double lean = 0.1 / spacing_;
  row(end).band[0] += kEndWeight * kEndWeight + lean * lean;
  row(k).band[0] += lean * lean;
  row(std::max(end, k)).band[1] -= lean * lean;
}

void LineSmoother::add_bending(int k) noexcept {
  const double q = 1.0 / (spacing_ * spacing_);
  const double kappa = curvature_[static_cast<std::size_t>(k)];
  const std::array<double, 3> c{q, kappa * kappa - 2.0 * q, q};
  for (int i = 0; i < 3; ++i) {
    Row& to = row(k - 1 + i);
    const double own = c[static_cast<std::size_t>(i)];
    for (int j = 0; j <= i; ++j)
      to.band[static_cast<std::size_t>(i - j)] += own * c[static_cast<std::size_t>(j)];
    to.right -= own * kappa;
  }
}

void LineSmoother::add_slope(int k) noexcept {
  const double q = 1.0 / (spacing_ * spacing_);
  const double per_meter = slope_length_ / spacing_;
  const double here = curvature_[static_cast<std::size_t>(k)];
  const double next = curvature_[static_cast<std::size_t>(k + 1)];
  const std::array<double, 4> c{-q * per_meter, (3.0 * q - here * here) * per_meter,
                                (next * next - 3.0 * q) * per_meter, q * per_meter};
  for (int i = 0; i < 4; ++i) {
    Row& to = row(k - 1 + i);
    const double own = c[static_cast<std::size_t>(i)];
    for (int j = 0; j <= i; ++j)
      to.band[static_cast<std::size_t>(i - j)] += own * c[static_cast<std::size_t>(j)];
    to.right -= own * per_meter * (next - here);
  }
}

void LineSmoother::eliminate(int k) noexcept {
  Row& now = row(k);
  const Row& one = row(k - 1);
  const Row& two = row(k - 2);
  const Row& three = row(k - 3);
  const double u3 = now.band[3];
  const double u2 = now.band[2] - u3 * two.factor[1];
  const double u1 = now.band[1] - u3 * one.factor[2] - u2 * one.factor[1];
  const double l3 = u3 * three.factor[0];
  const double l2 = u2 * two.factor[0];
  const double l1 = u1 * one.factor[0];
  const double pivot = now.band[0] + now.root_weight * now.root_weight - u3 * l3 - u2 * l2 - u1 * l1;
  now.factor = {1.0 / pivot, l1, l2, l3};
  now.forward = now.right - u3 * three.forward - u2 * two.forward - u1 * one.forward;
  now.forward *= now.factor[0];
}

void LineSmoother::substitute(int k) noexcept {
  const auto i = static_cast<std::size_t>(k);
  offset_[i] = row(k).forward - row(k + 1).factor[1] * offset_[i + 1] -
               row(k + 2).factor[2] * offset_[i + 2] - row(k + 3).factor[3] * offset_[i + 3];
}

void LineSmoother::raise_weight(int k) noexcept {
  // Knots in the overlap of a closed line take the offset of their twin in the lap's middle part, which is
  // the same point: both have the same weight then.
  const int extra = (knots_ - period_) / 2;
  int twin = k;
  if (period_ > 0 && k < extra) twin = k + period_;
  if (period_ > 0 && k >= extra + period_) twin = k - period_;
  const double ratio = std::fabs(offset_[static_cast<std::size_t>(twin)]) / width_;
  Row& now = row(k);
  now.root_weight = std::max(kLeastWeight, now.root_weight * std::clamp(ratio, kLeastChange, kMostChange));
}

namespace {

constexpr double kSlopeReach = 3.0;   // [m] each way of a curvature slope; chosen: about a car's length
constexpr double kLowestSpeed = 2.0;  // [m/s] lowest planned speed; chosen: the plan never stops the car
constexpr double kTraction =
    0.85;  // share of the grip; chosen: brakes do not share forces as the load is shared

/// Largest speed v [m/s] with v² demand <= share · friction · load(v).
double speed_for(double demand, const model::VehicleParams& p, double share) {
  const double grip = share * p.cornering_friction();
  const double g0 = grip * p.load_constant;
  const double g1 = grip * p.load_per_speed;
  const double d = std::max(demand - grip * p.load_quadratic, 1e-6);
  return (g1 + std::sqrt(g1 * g1 + 4.0 * d * g0)) / (2.0 * d);
}

/// Demand of lateral tyre force per v² by curvature and its slope, at the axle that needs more (eq. 11)
/// [1/m].
double demand_of(double curvature, double slope, const model::VehicleParams& p) {
  const double steady = (1.0 - p.steer_helper) * curvature;
  const double front = std::fabs(steady + p.yaw_inertia / (p.mass * p.rear_axle) * slope);
  const double rear = std::fabs(steady - p.yaw_inertia / (p.mass * p.front_axle) * slope);
  return std::max(front, rear);
}

/// Lateral tyre force as a share of the planned grip.
double use_of(double v, double demand, const model::VehicleParams& p, double grip) {
  return v * v * demand / (grip * p.cornering_friction() * p.load(v));
}

/// Share of the longitudinal force that the friction ellipse leaves (1 for uncoupled tyres).
double longitudinal_share(double use, const model::VehicleParams& p) {
  if (p.friction_coupling == 0.0) return 1.0;
  return std::sqrt(std::max(0.0, 1.0 - p.friction_coupling * std::min(1.0, use * use)));
}

/// Limit of the longitudinal force over mass [m/s²] by the tyres' grip on a straight road; infinite for
/// uncoupled tyres. Below the forces of drive and brakes on roads with less grip than the car is built for.
double traction(double v, const model::VehicleParams& p) {
  if (p.friction_coupling == 0.0) return std::numeric_limits<double>::infinity();
  return kTraction * p.cornering_friction() * p.load(v);
}

/// Lowers the speed of a sample to `limit`, if it is higher, and stores the reason.
void limit_to(double limit, SpeedLimiter reason, ReferenceLine::Sample& sample) {
  if (limit >= sample.speed) return;
  sample.speed = limit;
  sample.limiter = reason;
}

}  // namespace

void SpeedPlan::begin(const model::VehicleParams& vehicle, const SpeedPlanOptions& options) noexcept {
  vehicle_ = vehicle;
  if (!(vehicle == stability_.vehicle())) stability_ = model::BrakingStability(vehicle);
  options_ = options;
  instalments_.restart();
}

bool SpeedPlan::advance(int& work, ReferenceLine& line) noexcept {
  const int last = static_cast<int>(line.samples().size()) - 1;
  if (instalments_.phase() == 0) {
    instalments_.loop(last + 1, 4, work, [&](int i) { limit(line, i); });
    if (instalments_.phase() == 1) finish_limits(line);
  }
  if (instalments_.phase() == 1) {
    instalments_.loop(last, 4, work, [&](int turn) { accelerate(line, turn); });
  }
  if (instalments_.phase() == 2) {
    instalments_.loop(last, 4, work, [&](int turn) { brake(line, turn); });
  }
  if (instalments_.phase() < 3) return false;
  if (line.is_closed()) {
    line.samples()[static_cast<std::size_t>(last)].speed = line.samples()[0].speed;
    line.samples()[static_cast<std::size_t>(last)].limiter = line.samples()[0].limiter;
  }
  return true;
}

void SpeedPlan::limit(ReferenceLine& line, int i) noexcept {
  const auto samples = line.samples();
  const int last = static_cast<int>(samples.size()) - 1;
  const int reach = std::max(1, static_cast<int>(std::lround(kSlopeReach / line.spacing())));
  const auto curvature = [&](int at) {
    if (line.is_closed()) at = at < 0 ? at + last : (at > last ? at - last : at);
    return samples[static_cast<std::size_t>(std::clamp(at, 0, last))].curve.curvature;
  };
  const auto index = static_cast<std::size_t>(i);
  const double slope = (curvature(i + reach) - curvature(i - reach)) / (2.0 * reach * line.spacing());
  demand_[index] = demand_of(curvature(i), slope, vehicle_);
  ReferenceLine::Sample& sample = samples[index];
  sample.speed = std::min(options_.speed_limit, vehicle_.valid_speed);
  sample.limiter = SpeedLimiter::kAsked;
  limit_to(speed_for(demand_[index], vehicle_, options_.grip_share), SpeedLimiter::kCurvature, sample);
  sample.speed = std::max(sample.speed, kLowestSpeed);
  if (i == 0 || sample.speed < samples[static_cast<std::size_t>(slowest_)].speed) slowest_ = i;
}

void SpeedPlan::finish_limits(ReferenceLine& line) noexcept {
  if (line.is_closed()) return;
  slowest_ = 0;
  const double end =
      speed_for((1.0 - vehicle_.steer_helper) * options_.end_curvature, vehicle_, options_.grip_share);
  limit_to(std::max(end, kLowestSpeed), SpeedLimiter::kSight, line.samples().back());
}

/// Limits the speed behind a sample by the drive. The pass goes once round a closed line from its slowest
/// sample, whose speed is final; along an open line from its beginning.
void SpeedPlan::accelerate(ReferenceLine& line, int turn) noexcept {
  const int intervals = static_cast<int>(line.samples().size()) - 1;
  const int at = (slowest_ + turn) % intervals;
  const auto from = static_cast<std::size_t>(at);
  const std::size_t to = line.is_closed() && at + 1 == intervals ? 0 : from + 1;
  const double v = line.samples()[from].speed;
  const double share = longitudinal_share(use_of(v, demand_[from], vehicle_, options_.grip_share), vehicle_);
  const double drag = longitudinal_acceleration(vehicle_, 0.0, v);
  const double drive = std::min(longitudinal_acceleration(vehicle_, 1.0, v) - drag, traction(v, vehicle_));
  const double a = options_.drive_share * share * drive + drag;
  const double squared = std::max(kLowestSpeed * kLowestSpeed, v * v + 2.0 * a * line.spacing());
  limit_to(std::sqrt(squared), SpeedLimiter::kPower, line.samples()[to]);
}

/// Limits the speed before a sample by the brakes. The pass goes backwards, from the slowest sample of a
/// closed line or the end of an open one.
void SpeedPlan::brake(ReferenceLine& line, int turn) noexcept {
  const int intervals = static_cast<int>(line.samples().size()) - 1;
  const int at = line.is_closed() ? (slowest_ + intervals - turn) % intervals : intervals - turn;
  const auto from = static_cast<std::size_t>(at);
  const std::size_t to = at == 0 ? static_cast<std::size_t>(intervals - 1) : from - 1;
  const ReferenceLine::Sample& ahead = line.samples()[from];
  const double v = ahead.speed;
  const double use = use_of(v, demand_[from], vehicle_, options_.grip_share);
  const double share = longitudinal_share(use, vehicle_);
  const double drag = longitudinal_acceleration(vehicle_, 0.0, v);
  const double force = std::min(drag - longitudinal_acceleration(vehicle_, -vehicle_.brake_throttle_limit, v),
                                traction(v, vehicle_));
  const double a =
      std::min(options_.brake_share * share * force, stability_.most_braking(v, options_.grip_share * use)) -
      drag;
  // A speed before a sample limited by sight has the same reason.
  const bool is_blind = ahead.limiter == SpeedLimiter::kSight;
  limit_to(std::sqrt(v * v + 2.0 * a * line.spacing()),
           is_blind ? SpeedLimiter::kSight : SpeedLimiter::kBraking, line.samples()[to]);
}

namespace {

constexpr int kFewestIntervals = 5;  // the smoother needs six knots

/// Phases of the LinePlanner.
enum Phase { kTake, kSmooth, kMove, kShape, kSample, kSpeed, kDone };

/// ℓ of the LineSmoother [m] (eq. 9): the yaw inertia against the tyres' share of the lateral force. The
/// bounds keep it plausible for any parameters.
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
  // A lap is divided evenly. A stretch has the knots of the waypoint line; its last knot may lie beyond its
  // end.
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
  // The first knots of the lap were smoothed twice, the second time as the continuation of its end: fades
  // from the second offset to the first, so that the lap closes without a step.
  const double share = static_cast<double>(k) / extra_;
  return share * n + (1.0 - share) * smoother_.offset(k + extra_ + intervals_);
}

/// Position, tangent and curvature of the moved knot follow from n, n' and n'' exactly.
void LinePlanner::move(int k) noexcept {
  const auto i = static_cast<std::size_t>(k);
  const CurvePoint& raw = knots_[i];
  const double n = offset(k);
  // The ends of a stretch take n'' and the curvature slope of their neighbours.
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
  // Length of the new line: the end of a stretch lies between two knots.
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
