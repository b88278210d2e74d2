// SPDX-License-Identifier: MIT
#include "chicane/safety/stop_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "chicane/base/math.hpp"

namespace chicane::safety {
namespace {

constexpr double kStage = 0.08;       // [s]
constexpr double kBraking = 0.9;      // of the useful one, that is aimed at on a straight
constexpr double kLeastShare = 0.2;   // of it, in any bend
constexpr double kSlow = 2.0;         // [m/s] slower than that the law ends the stop
constexpr double kWantedEdge = 0.4;   // [m] from the edges
constexpr int kTurns = 6;             // of the solver, from what the last search found
constexpr int kMostTurns = 8;         // from a new guess
constexpr double kMostDefect = 0.05;  // of a motion that can be driven [m, rad, m/s]
constexpr double kMostAge = 0.5;      // [s] of a stop that a search can begin with
constexpr double kJoining = 0.5;      // [s] in which a guess joins the line
constexpr double kMostSlip = 0.12;    // [rad] of a guess
constexpr int kLeastStages = 8;

/// What a search begins with: the last stop, or the line and a braking that is aimed at.
enum class Begin : signed char { kLast, kLine, kLineCarefully };

}  // namespace

StopSearch::StopSearch(const model::VehicleParams& vehicle)
    : model_{vehicle}, stability_{vehicle}, solver_{tracking::make_tracking_solver(kMostTurns)} {
  set_vehicle(vehicle);
}

void StopSearch::set_vehicle(const model::VehicleParams& vehicle) noexcept {
  model_.set_vehicle(vehicle);
  if (!(vehicle == stability_.vehicle())) stability_ = model::BrakingStability(vehicle);
  problem_.others = Problem::Step::of(model_, kStage);
  problem_.first = problem_.others;
  problem_.weight = {.lateral = 1.0,
                     .heading = std::sqrt(5.0),
                     .speed = std::sqrt(0.5),
                     .steer_rate = std::sqrt(30.0),
                     .jerk = std::sqrt(5e-4),
                     .edge = std::sqrt(200.0),
                     .slip = 10.0,
                     .excess_steer_rate = 10.0,
                     .friction = 10.0};
  problem_.nose = vehicle.front_axle;
  problem_.tail = vehicle.rear_axle;
  forget();
}

void StopSearch::ask_road(const road::KnownRoad& road, double s0, int k) noexcept {
  const auto i = static_cast<std::size_t>(k);
  const Problem::State& x = now_.x[i];
  const double s = s0 + x[Problem::kS];
  const model::VehicleParams& car = model_.vehicle();
  const double taken = 0.5 * (car.track_width + car.tire_width) + kWantedEdge;
  const auto room = [&](double at, double& left, double& right) {
    const road::KnownRoad::Edges edges = road.edges(at);
    left = edges.left - taken;
    right = edges.right - taken;
  };
  const road::ReferenceLine::Demand demand = road.line().demand(s);
  Problem::Road& to = problem_.road;
  to.s[i] = x[Problem::kS];
  to.curvature[i] = demand.curvature;
  to.curvature_slope[i] = demand.curvature_slope;
  to.sideslip[i] = 0.0;
  room(s + problem_.nose, to.left[i], to.right[i]);
  room(s - problem_.tail, to.tail_left[i], to.tail_right[i]);
  const double v = std::max(x[Problem::kVx], 0.0);
  const double useful = longitudinal_acceleration(car, lowest_throttle(car, v), v);
  to.speed_slope[i] = 0.0;
  to.speed[i] = k == 0 ? v : std::max(to.speed[i - 1] - aimed(road, s0, now_.x[i - 1]) * kStage, 0.0);
  to.acceleration_min[i] = v > 1.0 ? useful : 0.0;
  to.acceleration_max[i] = std::max(0.0, useful);
  to.pushed_vy[i] = to.pushed_r[i] = 0.0;
}

void StopSearch::guess_from_last(const road::KnownRoad& road, const StopStart& start) noexcept {
  const tracking::TrackingTrajectory& old = last_;
  double offset = start.s - s_;
  if (road.line().is_closed()) offset -= road.line().length() * std::round(offset / road.line().length());
  std::size_t j = 0;
  const auto last = static_cast<std::size_t>(old.horizon);
  for (int k = 0;; ++k) {
    const auto i = static_cast<std::size_t>(k);
    Problem::State& x = now_.x[i];
    const double at = x[Problem::kS] + offset;  // on the old one
    while (j + 1 < last && old.x[j + 1][Problem::kS] <= at) ++j;
    const double length = std::max(old.x[j + 1][Problem::kS] - old.x[j][Problem::kS], 1e-3);
    const double share = std::clamp((at - old.x[j][Problem::kS]) / length, 0.0, 1.0);
    if (k > 0) {
      for (const int n : {+Problem::kD, +Problem::kE, +Problem::kVy, +Problem::kR, +Problem::kSteer,
                          +Problem::kAcceleration}) {
        const auto q = static_cast<std::size_t>(n);
        x[q] = old.x[j][q] + share * (old.x[j + 1][q] - old.x[j][q]);
      }
    }
    ask_road(road, start.s, k);
    if (k == now_.horizon) break;
    now_.u[i] = problem_.within_bounds(k, old.u[j]);
    Problem::State& next = now_.x[i + 1];
    next[Problem::kVx] = std::max(x[Problem::kVx] + kStage * now_.u[i][1], 0.5);
    next[Problem::kS] = x[Problem::kS] + 0.5 * kStage * (x[Problem::kVx] + next[Problem::kVx]);
  }
}

void StopSearch::guess_from_line(const road::KnownRoad& road, const StopStart& start) noexcept {
  const model::VehicleParams& car = model_.vehicle();
  Problem::State first{};
  for (int k = 0;; ++k) {
    const auto i = static_cast<std::size_t>(k);
    Problem::State& x = now_.x[i];
    const double v = std::max(x[Problem::kVx], 1.0);
    const double curvature = road.line().demand(start.s + x[Problem::kS]).curvature;
    const double per_load = (1.0 - car.steer_helper) * v * v * curvature / model_.load(v);
    const double rear = std::clamp(per_load / car.cornering_rear, -kMostSlip, kMostSlip);
    const double front = std::clamp(per_load / car.cornering_front, -kMostSlip, kMostSlip);
    const double vy = (car.rear_axle * curvature - rear) * v;
    const Problem::State line{
        0.0, 0.0, -vy / v, 0.0, vy, curvature * v, car.wheelbase() * curvature + front - rear, 0.0};
    if (k == 0) {
      for (std::size_t q = 0; q < line.size(); ++q) first[q] = x[q] - line[q];
    } else {
      const double faded = exp(-k * kStage / kJoining);
      for (const int n : {+Problem::kE, +Problem::kVy, +Problem::kR, +Problem::kSteer}) {
        const auto q = static_cast<std::size_t>(n);
        x[q] = line[q] + faded * first[q];
      }
      x[Problem::kD] = exp(-0.5 * k * kStage / kJoining) * first[Problem::kD];
    }
    ask_road(road, start.s, k);
    if (k == now_.horizon) break;
    const double a = -aimed(road, start.s, x);
    now_.u[i] = problem_.within_bounds(k, {x[Problem::kSteer], a});
    Problem::State& next = now_.x[i + 1];
    next[Problem::kAcceleration] = a;
    next[Problem::kVx] = std::max(x[Problem::kVx] + kStage * a, 0.5);
    next[Problem::kS] = x[Problem::kS] + 0.5 * kStage * (x[Problem::kVx] + next[Problem::kVx]);
  }
}

/// The deceleration that is aimed at: what the bend leaves of the braking, and a car that feedback can catch.
double StopSearch::aimed(const road::KnownRoad& road, double s0, const Problem::State& x) const noexcept {
  const model::VehicleParams& car = model_.vehicle();
  const double v = std::max(x[Problem::kVx], 0.0);
  const double useful = -longitudinal_acceleration(car, lowest_throttle(car, v), v);
  const double curvature = road.line().demand(s0 + x[Problem::kS]).curvature;
  const double use =
      (1.0 - car.steer_helper) * v * v * curvature / (car.cornering_friction() * model_.load(v));
  const double left =
      car.friction_coupling > 0.0 ? std::sqrt(std::max(1.0 - use * use, kLeastShare * kLeastShare)) : 1.0;
  const double most = kBraking * useful * left;
  return is_careful_ ? std::min(most, stability_.most_braking(v, std::fabs(use))) : most;
}

/// Until the car is slow.
int StopSearch::stages(const road::KnownRoad& road, const StopStart& start) const noexcept {
  Problem::State x{};
  x[Problem::kVx] = start.body.vx;
  int k = 0;
  for (; k < Problem::kCapacity && x[Problem::kVx] > kSlow; ++k) {
    x[Problem::kS] += kStage * x[Problem::kVx];
    x[Problem::kVx] -= kStage * aimed(road, start.s, x);
  }
  return std::max(k, kLeastStages);
}

StopCheck StopSearch::plan(const road::KnownRoad& road, const StopStart& start, double margin,
                           const StopPlanner& planner, StopCourse& out) noexcept {
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  out.stop.size = 0;
  StopCheck check{.least_edge = kNone};
  if (!(start.body.vx > 2.0 * kSlow)) return check;
  problem_.model = &model_;  // here, so that a copy asks its own
  const double age = start.time - time_;
  const bool can_go_on = has_last_ && age >= 0.0 && age < kMostAge;
  has_last_ = false;
  for (const Begin begin : {Begin::kLast, Begin::kLine, Begin::kLineCarefully}) {
    const bool goes_on = begin == Begin::kLast;
    if (goes_on && !can_go_on) continue;
    if (!goes_on) is_careful_ = begin == Begin::kLineCarefully;
    problem_.horizon = now_.horizon = stages(road, start);
    now_.x[0] = {0.0,           start.d,      start.e,          start.body.vx,
                 start.body.vy, start.body.r, start.body.steer, start.body.acceleration};
    if (goes_on) {
      guess_from_last(road, start);
    } else {
      guess_from_line(road, start);
    }
    const Problem::State x0 = now_.x[0];
    const solver::SolveReport report =
        solver_->solve(problem_, x0, now_, goes_on ? kTurns : kMostTurns, Deadline::never());
    if (report.status == solver::SolveStatus::kNotFinite || !(report.defect < kMostDefect)) continue;
    check = tell(road, start, planner, out);
    if (!check.stands || !(check.least_edge >= margin)) continue;
    has_last_ = true;
    last_ = now_;
    s_ = start.s;
    time_ = start.time;
    break;
  }
  return check;
}

/// What was found: places and speeds of the search, the law from its end on.
StopCheck StopSearch::tell(const road::KnownRoad& road, const StopStart& start, const StopPlanner& planner,
                           StopCourse& out) const noexcept {
  const model::VehicleParams& car = model_.vehicle();
  StopCheck check{.least_edge = planner.edge(road, start)};
  out.stop.size = 0;
  StopStart at = start;
  double driven = 0.0;
  double speed = hypot(start.body.vx, start.body.vy);
  for (int k = 0;; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const Problem::State& x = now_.x[i];
    at = {.time = start.time + k * kStage,
          .s = start.s + x[Problem::kS],
          .d = x[Problem::kD],
          .e = x[Problem::kE],
          .body = {x[Problem::kVx], x[Problem::kVy], x[Problem::kR], x[Problem::kSteer],
                   x[Problem::kAcceleration]}};
    const double before = speed;
    speed = hypot(at.body.vx, at.body.vy);
    if (k > 0) driven += 0.5 * kStage * (before + speed);
    check.least_edge = std::min(check.least_edge, planner.edge(road, at));
    if (k == now_.horizon || at.body.vx < kSlow) break;
    // Inputs are constant in a stage, the receiver's are linear between two points.
    Problem::Input u = now_.u[i];
    if (k > 0)
      for (std::size_t q = 0; q < u.size(); ++q) u[q] = 0.5 * (u[q] + now_.u[i - 1][q]);
    out.add(at, driven, speed, {u[0], throttle_to_rest(car, u[1], at.body.vx)});
  }
  StopCourse tail;
  const StopCheck end = planner.plan(road, at, {}, tail);
  for (std::size_t q = 0; q < static_cast<std::size_t>(tail.stop.size); ++q) {
    const StopPoint& point = tail.stop.points[q];
    out.add(tail.places[q], driven + point.distance, point.speed, point.command);
  }
  check.least_edge = std::min(check.least_edge, end.least_edge);
  check.distance = driven + end.distance;
  check.stands = end.stands;
  return check;
}

}  // namespace chicane::safety
