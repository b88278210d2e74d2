// SPDX-License-Identifier: MIT
#include "chicane/safety/predictive_filter.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>

#include "chicane/base/angle.hpp"
#include "chicane/base/math.hpp"

namespace chicane::safety {
namespace {

constexpr double kAssumedCycle = 0.04;  // [s] between commands where that is not known
constexpr double kShortestHold = 0.09;  // [s] a command is held where the next one comes late
constexpr double kLongestHold = 0.5;    // [s]
constexpr double kRecovery = 0.5;       // [s] after a silence until the car is controlled again
constexpr double kDrivenOpen = 2.0;     // [s] of silence for which a backup that is being driven is verified
constexpr double kLawUse = 0.75;        // tyre use up to which the stop law's model holds; 1: peak slip
constexpr double kRacedUse = 1.0;       // the same along a planned lap, which the stop drives more slowly
constexpr double kLawUseUnplanned = 0.65;  // the same without a published plan: no reserve for its error
constexpr double kMostUse = 1.2;           // tyre use beyond which no command is sent: the car slides
constexpr double kTurnReserve = 1.5;       // times the room in which a car that stood turns back to the road
constexpr double kLedShare = 0.5;          // of the margin that turning back leaves at least
constexpr double kWalkingPace = 3.0;       // [m/s] below it slip angles say little
constexpr double kDriveOn[] = {0.5, 1.0, 1.5, 2.0, 2.5};  // [s] along the controller's plan before the stop

// The tube of the stored backup: deviations that its feedback takes back within the margin.
constexpr double kTubeOffset = 0.1;    // [m]
constexpr double kTubeAcross = 0.6;    // [m/s]
constexpr double kTubeFaster = 0.5;    // [m/s]
constexpr double kTubeSlower = 2.0;    // [m/s]
constexpr double kTubeYawRate = 0.08;  // [rad/s]

// The tube of a planned lap: deviations from which the car comes back to it, measured in laps of `race`.
constexpr double kLapOffset = 0.5;  // [m]
constexpr double kLapAcross = 2.5;  // [m/s]
constexpr double kLapFaster = 1.0;  // [m/s]
constexpr double kWideLap = 4.0;    // times as much where no verified backup is in store
// A lap that slides is cut by its driver: by up to 0.9 m and 2.8 m/s in laps of `race` on hairpins.
constexpr double kSlidingLap = 2.0;  // times as much where the plan comes back to the lap within kReturn
constexpr double kReturn = 1.5;      // [s]

// By how much the beginning of a published plan may be off the car's estimated place and speed.
constexpr double kPlanBegins = 0.2;  // [s] of it that are looked at
constexpr double kPlanLate = 0.02;   // [s]
constexpr double kPlanOffset = 0.4;  // of the car's width
constexpr double kPlanFaster = 1.5;  // [m/s]

// What a stop brakes with, tried in turn: gently and stable without feedback, hard, hard with less and less
// static stability left (docs/safety_derivation.md, eq. 5).
constexpr double kGentle = 0.8;
constexpr double kOpenStability = 1.6;
constexpr double kBarelyStable = 1.1;
constexpr double kHeldByFeedback = 0.7;
constexpr Braking kStops[] = {{kGentle, kOpenStability, kHeldByFeedback},
                              {1.0, kOpenStability, kHeldByFeedback},
                              {1.0, kBarelyStable},
                              {1.0, kHeldByFeedback},
                              {1.0, 0.0}};
constexpr int kStopCount = static_cast<int>(std::size(kStops));
constexpr int kKinds = kStopCount + static_cast<int>(std::size(kDriveOn));
constexpr int kTriedFirst = 2;    // kinds of stop tried in a cycle before the planned lap will do
constexpr double kFar = 10.0;     // [m] beside a line: of another road
constexpr double kUnfit = 200.0;  // [m] worse than any candidate that fits

}  // namespace

const StopPlan PredictiveFilter::kNoStop{};

PredictiveFilter::Candidate PredictiveFilter::judge(const road::KnownRoad& road, const StopStart& from,
                                                    const StopCheck& check, const Goal& goal) const noexcept {
  Candidate candidate{.check = check};
  candidate.check.least_edge = std::min(check.least_edge, goal.edge_before);
  candidate.worth = candidate.check.least_edge - kUnfit - check.spins_at;
  if (!check.stands || !(candidate.check.least_edge >= goal.margin)) return candidate;
  if (goal.drives_on) {
    const StopStart& end = tried_->places[static_cast<std::size_t>(tried_->stop.size - 1)];
    const double room = kTurnReserve * planner_.turning_room(road, end);
    if (!(planner_.edge(road, end) - room >= goal.margin)) return candidate;
  }

  candidate.fit = Fit::kOpen;
  candidate.worth = candidate.check.least_edge;
  if (!(goal.open_time > 0.0)) return candidate;
  const BlindCheck open = planner_.played_edge(road, from, tried_->stop, goal.open_time + kRecovery);
  if (!(open.edge_for >= 0.0)) {
    // Without a published plan the backup has to hold for cars a little other than modelled, too.
    const bool holds = goal.is_planned || planner_.followed_edge(road, from, *tried_) >= 0.0;
    candidate.fit = holds ? Fit::kSeen : Fit::kNone;
  }
  candidate.worth = open.edge >= 0.0 ? open.edge : -open.speed;
  return candidate;
}

/// The candidate that was simulated last becomes the backup.
void PredictiveFilter::store(const Candidate& candidate, GuardReport& report) noexcept {
  std::swap(backup_, tried_);
  is_current_ = true;
  backup_fit_ = candidate.fit;
  report.stop_edge = candidate.check.least_edge;
  report.stop_distance = candidate.check.distance;
}

/// Whether a kind of stop is for a car like this one: at once below a use of its tyres, later along a plan.
bool PredictiveFilter::may_be(int kind, const Goal& goal) noexcept {
  return kind < kStopCount ? goal.may_brake_now : goal.is_planned;
}

Fit PredictiveFilter::verify(const Request& request, GuardReport& report) noexcept {
  const road::KnownRoad& road = request.road;
  const double cycle = request.interval > 0.0 ? request.interval : kAssumedCycle;
  const double held = std::clamp(cycle, kShortestHold, kLongestHold);
  const double edge_now = planner_.edge(road, request.start);
  Goal goal{.edge_before = edge_now, .margin = terms_.margin, .open_time = terms_.open_time};
  const StopStart next = planner_.advance(road, request.start, request.command, held, goal.edge_before);
  // A car that is led back from within the margin comes no nearer to the edge than it takes to turn.
  if (request.is_led && next.body.vx < 2.0 * kWalkingPace) {
    const double turned = edge_now - kTurnReserve * planner_.turning_room(road, request.start);
    const double least = std::min(edge_now, kLedShare * terms_.margin);
    goal.margin = std::min(terms_.margin, std::max({turned, least, terms_.least_edge}));
  }

  model::BodyMotion<double> undriven = next.body;  // a stop does not ask for its drive
  undriven.acceleration = std::min(undriven.acceleration, 0.0);
  const auto tires = model_.tire_use(undriven);
  const double use = next.body.vx > kWalkingPace ? std::max(tires.front, tires.rear) : 0.0;
  const bool plans = goal.is_planned = intends(request);
  goal.drives_on = !request.is_led;

  goal.may_brake_now = use < (!plans ? kLawUseUnplanned : road.is_raced() ? kRacedUse : kLawUse);
  const bool may_stop = use < kMostUse && goal.edge_before >= goal.margin;
  if (plans) read_plan(request, StopPlanner::kLongestDriveOn);

  // Any backup will do that need not be held blindly. A planned lap is itself a way to drive on: near it
  // a cycle tries few of them, and the next cycle others.
  const bool any_does = plans && !(goal.open_time > 0.0);
  Fit fit = Fit::kNone;
  if (may_stop)
    fit =
        any_does ? stop_in_turn(kTriedFirst, road, next, goal, report) : best_stop(road, next, goal, report);
  if (fit == Fit::kNone && plans) fit = go_on_along_lap(road, next);
  if (fit == Fit::kNone && may_stop && any_does)
    fit = stop_in_turn(kKinds - kTriedFirst, road, next, goal, report);
  if (fit != Fit::kNone || !plans) return fit;
  if (!road.is_raced()) return may_stop ? stop_searched(road, next, goal, report) : fit;
  return go_back_to_lap(road, next);
}

/// Fit without a stop: that of the stored backup for a car in its tube, kOpen near the planned lap.
Fit PredictiveFilter::go_on_along_lap(const road::KnownRoad& road, const StopStart& at) noexcept {
  if (!road.is_raced()) return Fit::kNone;
  if (is_in_tube(road, at)) {
    shift_to_place(road, at);
    return backup_fit_;
  }
  if (!drives_planned_lap(road, at, 1.0) && !returns_to_lap(road, at)) return Fit::kNone;
  forget();
  return Fit::kOpen;
}

/// Without a verified backup to drive there is nothing better than the planned lap.
Fit PredictiveFilter::go_back_to_lap(const road::KnownRoad& road, const StopStart& at) noexcept {
  const bool has_backup = backup_fit_ != Fit::kNone && backup_->stop.size > 0;
  return !has_backup && drives_planned_lap(road, at, kWideLap) ? Fit::kOpen : Fit::kNone;
}

/// The first `longest` [s] of the published plan, in coordinates along the line.
void PredictiveFilter::read_plan(const Request& request, double longest) noexcept {
  planner_.course_of(request.road, request.start, *request.intended, longest, *intended_);
}

/// Whether the published plan begins where the car is, so that a backup may go on along it.
bool PredictiveFilter::intends(const Request& request) noexcept {
  if (request.intended == nullptr) return false;
  read_plan(request, kPlanBegins);
  if (intended_->stop.size < 2) return false;
  const StopStart& first = intended_->places[0];
  const StopStart& car = request.start;
  const double near = kPlanOffset * model_.vehicle().width;
  return std::fabs(first.time - car.time) < kPlanLate && std::fabs(first.d - car.d) < near &&
         std::fabs(first.s - car.s) < near && std::fabs(first.body.vx - car.body.vx) < kPlanFaster;
}

/// Whether the car drives a planned lap: near its line, along it, no faster than planned. The lap itself is a
/// way to drive on; in fast changes of direction the stop law does not find one to stop.
bool PredictiveFilter::drives_planned_lap(const road::KnownRoad& road, const StopStart& at,
                                          double wide) const noexcept {
  if (!road.is_raced()) return false;
  const double course = at.e + at.body.vy / std::max(at.body.vx, 1.0);
  return std::fabs(at.d) < wide * kLapOffset && std::fabs(course) * at.body.vx < wide * kLapAcross &&
         at.body.vx < road.line().demand(at.s).speed + wide * kLapFaster &&
         planner_.edge(road, at) >= terms_.margin / wide;
}

/// Whether a lap that slides is driven so that the published plan comes back to it, inside the edges.
bool PredictiveFilter::returns_to_lap(const road::KnownRoad& road, const StopStart& at) const noexcept {
  if (!road.slides() || !drives_planned_lap(road, at, kSlidingLap)) return false;
  for (std::size_t i = 0; i < static_cast<std::size_t>(intended_->stop.size); ++i) {
    const StopStart& place = intended_->places[i];
    if (place.time > at.time + kReturn) break;
    if (place.time < at.time) continue;
    if (planner_.edge(road, place) < terms_.margin) return false;
    if (drives_planned_lap(road, place, 1.0)) return true;
  }
  return false;
}

/// One kind of backup, stored where it fits better than `best`: kStops at once, then, numbered on, kDriveOn
/// along the controller's plan before the stop. Returns the better fit.
Fit PredictiveFilter::stop_by(int kind, const road::KnownRoad& road, const StopStart& from, const Goal& goal,
                              Fit best, GuardReport& report) noexcept {
  const auto i = static_cast<std::size_t>(kind);
  const StopCheck check = kind < kStopCount
                              ? planner_.plan(road, from, kStops[i], *tried_, goal.margin)
                              : planner_.plan_later(road, from, *intended_, kDriveOn[i - kStopCount],
                                                    kStops[1], *tried_, goal.margin);
  const Candidate candidate = judge(road, from, check, goal);
  if (candidate.fit <= best) return best;
  store(candidate, report);
  next_kind_ = kind;
  return candidate.fit;
}

/// The first of `count` kinds of stop that fits at all, beginning with the one that held last, going on with
/// those that were tried longest ago.
Fit PredictiveFilter::stop_in_turn(int count, const road::KnownRoad& road, const StopStart& from,
                                   const Goal& goal, GuardReport& report) noexcept {
  for (int seen = 0; seen < kKinds && count > 0; ++seen) {
    if (may_be(next_kind_, goal)) {
      const Fit fit = stop_by(next_kind_, road, from, goal, Fit::kNone, report);
      if (fit != Fit::kNone) return fit;
      --count;
    }
    next_kind_ = (next_kind_ + 1) % kKinds;
  }
  return Fit::kNone;
}

/// The first stop at once that fits open loop, else the first of any kind that fits.
Fit PredictiveFilter::best_stop(const road::KnownRoad& road, const StopStart& from, const Goal& goal,
                                GuardReport& report) noexcept {
  Fit best = Fit::kNone;
  for (int kind = 0; kind < kKinds; ++kind) {
    if (best == Fit::kOpen || (best != Fit::kNone && kind >= kStopCount)) break;
    if (may_be(kind, goal)) best = stop_by(kind, road, from, goal, best, report);
  }
  return best;
}

Fit PredictiveFilter::stop_searched(const road::KnownRoad& road, const StopStart& from, const Goal& goal,
                                    GuardReport& report) noexcept {
  const StopCheck check = search_.plan(road, from, goal.margin, planner_, *tried_);
  if (tried_->stop.size == 0) return Fit::kNone;
  const Candidate candidate = judge(road, from, check, goal);
  if (candidate.fit != Fit::kNone) store(candidate, report);
  return candidate.fit;
}

bool PredictiveFilter::drive(const road::KnownRoad& road, const StopStart& start, bool is_open,
                             GuardReport& report) noexcept {
  // Open loop the estimate's model is less accurate than the backup's: nothing is planned anew.
  if (is_open && planner_.has_wheels() && shift_to(start.time)) return true;

  Candidate best{.check = {}, .fit = Fit::kNone, .worth = -std::numeric_limits<double>::infinity()};
  StopCourse before = *backup_;
  const Goal goal{.edge_before = std::numeric_limits<double>::infinity(),
                  .margin = terms_.margin,
                  .open_time = std::min(kDrivenOpen, terms_.open_time)};
  const auto consider = [&](const StopCheck& check) {
    const Candidate candidate = judge(road, start, check, goal);
    const bool is_better =
        candidate.fit > best.fit || (candidate.fit == best.fit && candidate.worth > best.worth);
    if (!is_better) return;
    best = candidate;
    store(candidate, report);
  };
  // The stored backup goes on while it holds: candidates that take turns drive none of them.
  const bool can_follow = before.stop.size > 0;
  if (can_follow && road.is_raced()) consider(planner_.follow(road, start, before, *tried_));
  if (best.fit != Fit::kNone) return true;
  for (const Braking& braking : kStops) {
    if (best.fit == Fit::kOpen) break;
    if (is_open && braking.share < 1.0) continue;
    consider(planner_.plan(road, start, braking, *tried_));
  }
  if (can_follow && !road.is_raced() && best.fit < Fit::kOpen)
    consider(planner_.follow(road, start, before, *tried_));
  if (best.fit == Fit::kNone) {
    const StopCheck found = search_.plan(road, start, terms_.margin, planner_, *tried_);
    if (tried_->stop.size > 0) consider(found);
  }
  return is_current_ && backup_->stop.size > 0;
}

void PredictiveFilter::leave_line(const road::ReferenceLine& line) noexcept {
  const auto size = static_cast<std::size_t>(backup_->stop.size);
  for (std::size_t i = 0; i < size; ++i) {
    const StopStart& place = backup_->places[i];
    const road::CurvePoint here = line.at(place.s);
    poses_[i] = {here.position + place.d * Vec2{-here.tangent.y(), here.tangent.x()}, here.heading + place.e};
  }
}

void PredictiveFilter::join_line(const road::ReferenceLine& line) noexcept {
  const auto size = static_cast<std::size_t>(backup_->stop.size);
  search_.forget();
  if (line.is_empty()) return forget();
  double guess = 0.0, s = 0.0;
  for (std::size_t i = 0; i < size; ++i) {
    const Pose& pose = poses_[i];
    const road::ReferenceLine::Projection found =
        line.find(pose.position, pose.heading, 2.0 * model_.vehicle().width, i > 0 ? &guess : nullptr, kFar);
    if (!(found.distance < kFar)) return forget();
    const double driven = found.s - guess;
    s += i > 0 && line.is_closed() ? std::remainder(driven, line.length()) : driven;
    guess = found.s;
    StopStart& place = backup_->places[i];
    place.s = s;
    place.d = found.d;
    place.e = angle_difference(pose.heading, line.at(found.s).heading);
  }
}

/// Whether the car is where the backup is at that place, and as fast.
bool PredictiveFilter::is_in_tube(const road::KnownRoad& road, const StopStart& at) const noexcept {
  const auto size = static_cast<std::size_t>(backup_->stop.size);
  if (size < 2) return false;
  const double length = road.line().length();
  const double lap =
      road.line().is_closed() ? length * std::round((at.s - backup_->places[0].s) / length) : 0.0;
  std::size_t i = 0;
  while (i + 2 < size && backup_->places[i + 1].s <= at.s - lap) ++i;
  const StopStart& from = backup_->places[i];
  const StopStart& to = backup_->places[i + 1];
  const double share = (at.s - lap - from.s) / std::max(to.s - from.s, 1e-3);
  if (!(share > -1.0 && share <= 1.0)) return false;
  const auto off = [share](double value, double a, double b) { return value - (a + share * (b - a)); };
  const double course = at.e + at.body.vy / std::max(at.body.vx, 1.0);
  const auto course_of = [](const StopStart& p) { return p.e + p.body.vy / std::max(p.body.vx, 1.0); };
  const double faster = off(at.body.vx, from.body.vx, to.body.vx);
  return std::fabs(off(at.d, from.d, to.d)) < kTubeOffset &&
         std::fabs(off(course, course_of(from), course_of(to))) * std::max(at.body.vx, 1.0) < kTubeAcross &&
         std::fabs(off(at.body.r, from.body.r, to.body.r)) < kTubeYawRate && faster < kTubeFaster &&
         faster > -kTubeSlower;
}

/// The backup begins at the car's place from now on.
void PredictiveFilter::shift_to_place(const road::KnownRoad& road, const StopStart& at) noexcept {
  const double length = road.line().length();
  const double lap =
      road.line().is_closed() ? length * std::round((at.s - backup_->places[0].s) / length) : 0.0;
  const auto size = static_cast<std::size_t>(backup_->stop.size);
  std::size_t i = 0;
  while (i + 2 < size && backup_->places[i + 1].s <= at.s - lap) ++i;
  const StopPoint& from = backup_->stop.points[i];
  const StopPoint& to = backup_->stop.points[i + 1];
  const double share = std::clamp(
      (at.s - lap - backup_->places[i].s) / std::max(backup_->places[i + 1].s - backup_->places[i].s, 1e-3),
      0.0, 1.0);
  const double late = at.time - (from.time + share * (to.time - from.time));
  const double driven = from.distance + share * (to.distance - from.distance);
  tried_->stop.size = 0;
  StopStart here = at;
  here.s -= lap;
  tried_->add(here, 0.0, at.body.vx, from.command);
  for (++i; i < size; ++i) {
    const StopPoint& point = backup_->stop.points[i];
    StopStart place = backup_->places[i];
    place.time += late;
    tried_->add(place, point.distance - driven, point.speed, point.command);
  }
  std::swap(backup_, tried_);
  is_current_ = true;
}

/// The backup begins at `time` [s] from now on; false where it is over.
bool PredictiveFilter::shift_to(double time) noexcept {
  const auto size = static_cast<std::size_t>(backup_->stop.size);
  std::size_t i = 0;
  while (i + 1 < size && backup_->stop.points[i + 1].time <= time) ++i;
  if (i + 1 >= size) return false;
  const StopPoint& here = backup_->stop.points[i];
  const StopPoint& next = backup_->stop.points[i + 1];
  const double share = std::max(time - here.time, 0.0) / (next.time - here.time);
  const double driven = here.distance + share * (next.distance - here.distance);
  const double speed = here.speed + share * (next.speed - here.speed);
  tried_->stop.size = 0;
  StopStart place = backup_->places[i];
  place.time = std::max(time, here.time);
  tried_->add(place, 0.0, speed, here.command);
  for (++i; i < size; ++i) {
    const StopPoint& point = backup_->stop.points[i];
    tried_->add(backup_->places[i], point.distance - driven, point.speed, point.command);
  }
  std::swap(backup_, tried_);
  is_current_ = true;
  return true;
}

}  // namespace chicane::safety
