// SPDX-License-Identifier: MIT
#include "chicane/safety/predictive_filter.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

#include "chicane/base/math.hpp"

namespace chicane::safety {
namespace {

// Origins (chosen: by trial, see Guard):
// - Derived: kDeviations (95 % of a normal distribution), kWalkingPace (pace of tracking::way_back), kCrawl
//   (Guard::kStandingSpeed), kUnfit (farther than any edge).
// - Measured: kMostLoss (eq. 5d: f1tenth loses 0.3 m), kFirstHold (after a check of one cycle a led car comes
//   over the edge, cycle by cycle).
// - Chosen, docs/guard.md: kTurnReserve, kLedShare, kMostSlip, kMostSlipOfSlides (eq. 6, 6a),
//   kRecovery ("Open loop"), kDrivenOpen ("Driven"), kKeptLoss (eq. 5d), kMemory (eq. 5c), kDwell,
//   kCalmSlip ("Given back").
// - Chosen: kAssumedCycle (above each answer of the original), kShortestHold (just below Policy::hold),
//   kNearer (what a stop may lose by its steps).
constexpr double kAssumedCycle = 0.25;  // [s] between commands where that is not known: after the first one
constexpr double kShortestHold = 0.09;  // [s] a command is held where the next one comes at once
constexpr double kFirstHold = 0.5;      // [s] the command by which a led car begins to move is held
constexpr double kRecovery = 0.5;       // [s] after a silence until the car is controlled again
constexpr double kDrivenOpen = 2.0;     // [s] of silence for which a stop that is being driven is verified
constexpr double kTurnReserve = 1.2;    // times the room in which a car that stood turns back to the road
constexpr double kLedShare = 0.5;       // of the margin that turning back leaves at least
constexpr double kCrawl = 0.5;          // [m/s]
constexpr double kWalkingPace = 3.0;    // [m/s] below it slip angles say little
constexpr double kNearer = 0.02;        // [m] that a stop may come nearer to an edge than the car is
constexpr double kKeptLoss = 0.95;      // share of earlier losses that counts when a stop begins
constexpr double kMostLoss = 0.5;       // [m] of it that counts
constexpr double kMemory = 3.0;         // [s] of residuals
constexpr double kDeviations = 2.0;     // standard deviations of residuals, withstood by a verified stop
constexpr double kMostSlip = 1.2;       // over the slip at the peak: beyond it the car spins
constexpr double kMostSlipOfSlides = 1.6;  // the same on a lap that slides
constexpr double kDwell = 0.5;     // [s] after a stop was driven, in which only a calm car is given back
constexpr double kCalmSlip = 0.5;  // of a calm car
// Deviations from a planned lap that its controller takes back, measured in laps of `race`; the factors are
// chosen.
constexpr double kLapOffset = 0.5;   // [m]
constexpr double kLapAcross = 2.5;   // [m/s]
constexpr double kLapFaster = 1.0;   // [m/s]
constexpr double kSlidingLap = 2.0;  // times as much on a lap that slides
constexpr double kWideLap = 4.0;     // times as much where no law is stored
constexpr double kUnfit = 200.0;     // [m] worse than any candidate that fits

// Braking of a stop: gentle, hard, hard with less and less static stability left (eq. 5). Chosen: below 1 the
// car diverges without feedback.
constexpr Braking kGentle = PredictiveFilter::kGentle, kHard{1.0, 1.6, 0.7}, kBarelyStable{1.0, 1.1},
                  kHeld{1.0, 0.7}, kUnstable{1.0, 0.0};

/// One law of the family, in the order in which they are tried: the calm ones, those with the feedback for a
/// car that crosses its road, those for a planned lap. Chosen: no single law stops all cars (docs/guard.md).
struct Law {
  Braking braking;
  double bandwidth = 1.0;  // [rad/s]
  double grip_share = 0.4;
  double room = 0.6;      // [m]
  double races_on = 0.0;  // [s] along the planned lap before
};
constexpr Law kLaws[] = {{kGentle},
                         {kHard},
                         {kBarelyStable},
                         {kHeld},
                         {kUnstable},
                         {kGentle, 2.0},
                         {kGentle, 3.0, 0.8},
                         {kHard, 3.0, 0.8},
                         {kHard, 2.0},
                         {kHard, 4.0, 0.8},
                         {kHeld, 4.0, 0.8},
                         {kHeld, 2.0},
                         {kHeld, 3.0, 0.8},
                         {kHard, 3.0, 0.8, 1.0},
                         {kHeld, 3.0, 0.8, 1.0},
                         {kHeld, 4.0, 0.8, 1.0},
                         {kHard, 1.0, 0.4, 1.0},
                         {kHard, 1.0, 0.4, 0.6, 0.5},
                         {kHard, 3.0, 0.8, 0.6, 0.5},
                         {kHard, 1.0, 0.4, 0.6, 1.0},
                         {kHard, 3.0, 0.8, 0.6, 1.0},
                         {kHard, 2.0, 0.4, 0.6, 1.5},
                         {kHard, 1.0, 0.4, 0.6, 2.0},
                         {kHard, 3.0, 0.8, 0.6, 2.0},
                         {kHard, 1.0, 0.4, 0.6, 3.0},
                         {kHard, 3.0, 0.8, 0.6, 3.0}};
/// Driven where no other law holds a car that slides on its road: brakes that let go leave the tyres to the
/// wheel. A car whose road ends has to brake. Chosen.
constexpr Law kReleased{{0.3, 3.0}, 2.0, 0.8};
constexpr int kLawCount = static_cast<int>(std::size(kLaws));
constexpr int kOffLap = 13;     // of them on a road without a planned lap
constexpr int kSlowWheels = 5;  // of them there for cars with four wheels: more feedback makes them weave
constexpr int kInTurn = 3;      // of them in a cycle near a planned lap: all of them took 22 ms
constexpr int kCalm = 2;        // of them for a car that is given back
constexpr int kDriven = 5;      // of them to replace a driven stop that holds no more
// Laws by which the guard itself stays on a planned lap, and kCalm and kDriven: chosen, so that a cycle stays
// short.
constexpr Law kRaceOn[] = {{kHard, 1.0, 0.4, 0.6, 2.0},
                           {kHard, 3.0, 0.8, 0.6, 2.0},
                           {kHard, 1.0, 0.4, 0.6, 1.0},
                           {kHard, 3.0, 0.8, 0.6, 1.0},
                           {kHard, 2.0, 0.4, 0.6, 0.5}};

Policy policy_of(const Law& law, double time, double hold) noexcept {
  const double until = law.races_on > 0.0 ? time + law.races_on : Policy{}.until;
  return {until, law.braking, law.bandwidth, law.grip_share, law.room, hold};
}

/// Size of the region around a planned lap in which it may be driven on.
double width_of(const road::KnownRoad& road) noexcept { return road.slides() ? kSlidingLap : 1.0; }

/// Whether a car is near a planned lap, along it, and no faster than planned: where no law stops it, as in
/// fast changes of direction, the lap itself is the way to drive on.
bool drives_lap(const road::KnownRoad& road, const StopStart& at, double wide) noexcept {
  const double course = at.e + at.body.vy / std::max(at.body.vx, 1.0);
  return std::fabs(at.d) < wide * kLapOffset && std::fabs(course) * at.body.vx < wide * kLapAcross &&
         at.body.vx < road.line().demand(at.s).speed + wide * kLapFaster;
}

}  // namespace

const StopPlan PredictiveFilter::kNoStop{};

void PredictiveFilter::forget() noexcept {
  stop_->size = 0;
  has_stored_ = false;
  residual_ = {};
  residual_at_ = 0.0;
  refused_at_ = driven_at_ = -std::numeric_limits<double>::infinity();
  lost_ = 0.0;
  law_ = 0;
}

/// A stop is verified with commands that last as long as the latest ones did. One late command does not make
/// lateness usual: of the last two intervals the shorter counts.
void PredictiveFilter::begin_cycle(double interval, double longest) noexcept {
  is_current_ = false;
  const double before = std::exchange(interval_, interval);
  usual_ = before > 0.0 ? std::min(interval, before) : interval;
  hold_ = std::clamp(longest, Policy{}.hold, kLongestHold);
}

/// Mean squares that fade (eq. 5c). What exceeds four deviations counts by a tenth, a long gap as a tenth of
/// kMemory: chosen, so that one jump does not stop the car.
void PredictiveFilter::note_residual(const Doubt& residual, double time) noexcept {
  const double share = std::clamp((time - std::exchange(residual_at_, time)) / kMemory, 0.0, 0.1);
  const auto take_in = [share](double& root, double value) {
    const double most = 4.0 * root + 1e-3;
    const double r = std::min(std::fabs(value), most + 0.1 * std::fabs(value));
    root = std::sqrt((1.0 - share) * root * root + share * r * r);
  };
  take_in(residual_.beside, residual.beside);
  take_in(residual_.course, residual.course);
  take_in(residual_.yaw_rate, residual.yaw_rate);
  take_in(residual_.speed, residual.speed);
}

/// The one judge. As modelled, the car keeps the margin, stands and can turn back; two cars that begin to
/// either side of it, with other tyres, stay on the road under the same feedback.
PredictiveFilter::Candidate PredictiveFilter::judge(const road::KnownRoad& road, const StopStart& from,
                                                    const Policy& policy, const Goal& goal) noexcept {
  const double least = goal.is_driven ? StopPlanner::kToTheEnd : goal.margin;
  Candidate candidate{.check = planner_.plan(road, from, policy, *tried_, least)};
  const StopCheck& check = candidate.check;
  candidate.worth = check.least_edge - kUnfit - check.spins_at;
  if (!check.stands || !(check.least_edge >= goal.margin)) return candidate;
  if (goal.turns_back) {
    const double room = kTurnReserve * planner_.turning_room(road, check.end);
    if (!(planner_.edge(road, check.end) - room >= goal.margin)) return candidate;
  }
  if (!goal.is_driven) {
    const Doubt doubt{kDeviations * residual_.beside, kDeviations * residual_.course,
                      kDeviations * residual_.yaw_rate, kDeviations * residual_.speed};
    // A place that is uncertain by more than the margin would leave no stop at all.
    const double least_in_doubt = std::min(0.0, goal.margin - doubt.beside);
    if (!planner_.plan_in_doubt(road, from, policy, doubt, least_in_doubt).stands) return candidate;
  }
  candidate.fit = Fit::kOpen;
  candidate.worth = check.least_edge;
  if (!(goal.open_time > 0.0)) return candidate;
  // Of a command only whether both cars stay on the road counts; of driven stops the better one is chosen.
  const double enough = goal.is_driven ? std::numeric_limits<double>::infinity() : 0.0;
  const DoubtCheck open = planner_.played(road, from, *tried_, goal.open_time + kRecovery, enough);
  if (!(open.edge_for >= 0.0)) candidate.fit = Fit::kSeen;
  candidate.worth = open.edge >= 0.0 ? open.edge : -open.speed;
  return candidate;
}

/// Stores `policy` where it is better than `best`.
bool PredictiveFilter::consider(const road::KnownRoad& road, const StopStart& from, const Policy& policy,
                                const Goal& goal, Candidate& best, GuardReport& report) noexcept {
  const Candidate candidate = judge(road, from, policy, goal);
  const bool is_better = candidate.fit > best.fit ||
                         (goal.is_driven && candidate.fit == best.fit && candidate.worth > best.worth);
  if (!is_better) return false;
  best = candidate;
  std::swap(stop_, tried_);
  is_current_ = has_stored_ = true;
  stored_ = policy;
  report.stop_edge = candidate.check.least_edge;
  report.stop_distance = candidate.check.distance;
  return true;
}

/// What the modelled car keeps from the edge [m]. A car that is led from within the margin comes no nearer
/// than it takes to turn.
double PredictiveFilter::margin_for(const Request& request, const StopStart& next,
                                    double edge_now) const noexcept {
  if (!request.is_led || !(next.body.vx < 2.0 * kWalkingPace))
    return std::clamp(edge_now - kNearer, terms_.margin, terms_.margin + lost_);
  const double turned = edge_now - kTurnReserve * planner_.turning_room(request.road, request.start);
  const double least = std::min(edge_now, kLedShare * terms_.margin);
  return std::min(terms_.margin, std::max({turned, least, terms_.least_edge}));
}

/// Slip divided by the slip at the peak force, the larger of both axles. Of cars whose tyres share nothing
/// between the directions, the rear axle alone: their front axle brakes as well when it slides. Drive does
/// not count, because a stop asks for none.
double PredictiveFilter::slip(const StopStart& at) const noexcept {
  if (!(at.body.vx > kWalkingPace)) return 0.0;
  model::BodyMotion<double> undriven = at.body;
  undriven.acceleration = std::min(undriven.acceleration, 0.0);
  const auto use = model_.tire_use(undriven);
  return planner_.has_wheels() ? std::max(use.front, use.rear) : use.rear;
}

/// Whether there is a stop after the command also if it is held as usual, and if it begins late: on a link
/// whose commands are sometimes much later than usual, wheels that stay turned lead elsewhere. Stores none.
bool PredictiveFilter::holds_as_usual(const Request& request, double longest, GuardReport& report) noexcept {
  if (!(usual_ > 0.0) || !(longest > usual_ + kLateness)) return true;
  const Policy before = stored_;
  const bool had_stored = has_stored_;
  const double usual = std::max(usual_, kShortestHold);
  const double late = std::min(longest, kLongestHold) - usual;
  double edge = 0.0;
  const StopStart late_start = planner_.advance(request.road, request.start, request.acting, late, edge);
  const Request delayed{
      .road = request.road, .start = late_start, .command = request.command, .is_led = request.is_led};
  const bool holds =
      verify_held(request, usual, report) != Fit::kNone && verify_held(delayed, usual, report) != Fit::kNone;
  stored_ = before;
  has_stored_ = had_stored;
  is_current_ = false;
  return holds;
}

double PredictiveFilter::late_hold(double interval, double longest) noexcept {
  const double cycle = interval > 0.0 ? interval : kAssumedCycle;
  return std::min(std::max(cycle + kLateness, longest), kLongestHold);
}

/// The command is held, in this order, (1) as usual, at once and late, where lateness varies; (2) until a
/// late next command, at least the latest of the last ones; (3) until one in time, off a planned lap. On a
/// lap (4) the lap itself is the way on. A led car that begins to move has (2) alone.
Fit PredictiveFilter::verify(const Request& request, GuardReport& report) noexcept {
  const double cycle = request.interval > 0.0 ? request.interval : kAssumedCycle;
  const double longest = std::max(cycle, request.longest);
  const double held = std::clamp(longest, kShortestHold, kLongestHold);
  // How far a car goes that begins to move shows only once its drive acts.
  const bool begins = request.is_led && request.start.body.vx < kCrawl;
  const double late = late_hold(cycle, longest);
  if (!begins && !holds_as_usual(request, longest, report)) return Fit::kNone;
  const Fit fit = verify_held(request, begins ? std::max(kFirstHold, held) : late, report);
  if (fit != Fit::kNone || begins) return fit;
  if (!request.road.is_raced() || request.is_led) return verify_held(request, held, report);
  double edge = planner_.edge(request.road, request.start);
  const StopStart next = planner_.advance(request.road, request.start, request.command, held, edge);
  // Without a stored law there is nothing better than the way back to the lap.
  const double wide = has_stored_ ? width_of(request.road) : kWideLap;
  const bool goes_on = edge >= terms_.margin && drives_lap(request.road, next, wide);
  return goes_on ? Fit::kOpen : Fit::kNone;
}

/// The check of a command that acts for `held` [s].
Fit PredictiveFilter::verify_held(const Request& request, double held, GuardReport& report) noexcept {
  const road::KnownRoad& road = request.road;
  const double edge_now = planner_.edge(road, request.start);
  double edge_until = edge_now;
  const StopStart next = planner_.advance(road, request.start, request.command, held, edge_until);
  const Goal goal{.margin = margin_for(request, next, edge_now),
                  .open_time = terms_.open_time,
                  .turns_back = !request.is_led || request.start.body.vx > kCrawl};
  const double slip = this->slip(next);
  if (!(slip < (road.slides() ? kMostSlipOfSlides : kMostSlip)) || !(edge_until >= goal.margin))
    return Fit::kNone;

  Candidate best;
  const auto try_law = [&](int i) {
    const Policy policy = policy_of(kLaws[i], next.time, hold_);
    if (consider(road, next, policy, goal, best, report)) law_ = i;
  };
  // A controller that is given the car back at the edge of what can be stopped, cycle by cycle, pumps a
  // weave.
  if (!road.is_raced() && !(next.time - refused_at_ > kDwell)) {
    for (int i = 0; i < kCalm && slip < kCalmSlip && best.fit < Fit::kOpen; ++i) try_law(i);
    return best.fit;
  }
  const Policy before = stored_;
  const bool has_before = has_stored_;
  // The lap itself is a way to drive on: a cycle tries few laws, and the next one others.
  if (!(goal.open_time > 0.0) && road.is_raced() && !request.is_led &&
      drives_lap(road, next, width_of(road))) {
    for (int n = 0; n < kInTurn && best.fit == Fit::kNone; ++n) {
      const int law = law_;
      try_law(law);
      if (best.fit == Fit::kNone) law_ = (law + 1) % kLawCount;
    }
    if (has_before && best.fit == Fit::kNone) has_stored_ = consider(road, next, before, goal, best, report);
    return Fit::kOpen;
  }
  const int first = goal.open_time > 0.0 ? -1 : law_;  // whichever holds will do
  if (first >= 0) try_law(first);
  const int open = planner_.has_wheels() ? kSlowWheels : kOffLap;
  const int count = road.is_raced() ? kLawCount : open;
  for (int i = 0; i < count && best.fit < Fit::kOpen; ++i) {
    if (best.fit == Fit::kSeen && i >= open) break;
    if (i != first) try_law(i);
  }
  if (best.fit == Fit::kNone && has_before)
    static_cast<void>(consider(road, next, before, goal, best, report));
  return best.fit;
}

bool PredictiveFilter::drive(const road::KnownRoad& road, const StopStart& start, bool is_open,
                             bool is_measured, GuardReport& report) noexcept {
  // Open loop the estimate's model is less accurate than the stop's own: the stored stop goes on by time.
  if (is_open && planner_.has_wheels() && shift_to(start.time)) return true;
  refused_at_ = start.time;
  Candidate best;
  // A refused answer is no reason to stop where the guard can drive the lap itself, and stop later.
  if (is_measured && road.is_raced()) {
    const Goal goal{.margin = terms_.margin};
    for (const Law& law : kRaceOn)
      if (consider(road, start, policy_of(law, start.time, hold_), goal, best, report)) return true;
  }
  // A stop verified with a margin is driven to its end; a fresh policy replaces it where it holds no more. Of
  // those that do not hold the least bad one is stored. Off the road by more than 0.5 m (chosen) none holds.
  const Goal goal{.margin = std::min(terms_.margin, std::max(planner_.edge(road, start) - kNearer, -0.5)),
                  .open_time = std::min(kDrivenOpen, terms_.open_time),
                  .is_driven = true};
  if (has_stored_) static_cast<void>(consider(road, start, Policy{stored_}, goal, best, report));
  const bool holds = best.fit != Fit::kNone;
  if (holds && is_measured) {  // eq. 5d: with a true model and state it loses nothing of its edge
    const double edge = best.check.least_edge;
    const bool goes_on = start.time - std::exchange(driven_at_, start.time) < kAssumedCycle;
    promised_ = goes_on ? std::max(promised_, edge) : edge;
    lost_ = std::max((goes_on ? 1.0 : kKeptLoss) * lost_, std::min(promised_ - edge, kMostLoss));
  }
  for (int i = 0; i <= kDriven && best.fit < Fit::kOpen; ++i) {
    const bool slides = best.check.spins_at > 0.0 || best.check.least_edge < 0.0;
    if (i == kDriven && (best.fit != Fit::kNone || !slides || planner_.edge(road, start) < 0.0)) break;
    const Law& law = i == kDriven ? kReleased : kLaws[i];
    if (is_open && law.braking.share < 1.0) continue;
    const Candidate before = best;
    // One that also holds blindly comes before the stored one, one that is only as good does not.
    if (holds) best.worth = std::numeric_limits<double>::infinity();
    if (consider(road, start, policy_of(law, start.time, hold_), goal, best, report))
      promised_ = best.check.least_edge;
    else
      best = before;
  }
  return is_current_ && stop_->size > 0;
}

/// The stored stop begins at `time` [s] from now on; false where it is over.
bool PredictiveFilter::shift_to(double time) noexcept {
  int i = 0;
  const auto point = [this](int k) -> const StopPoint& { return stop_->points[static_cast<std::size_t>(k)]; };
  while (i + 1 < stop_->size && point(i + 1).time <= time) ++i;
  if (i + 1 >= stop_->size) return false;
  const double share = std::max(time - point(i).time, 0.0) / (point(i + 1).time - point(i).time);
  const double driven = point(i).distance + share * (point(i + 1).distance - point(i).distance);
  const double speed = point(i).speed + share * (point(i + 1).speed - point(i).speed);
  tried_->size = 0;
  tried_->add({std::max(time, point(i).time), 0.0, speed, point(i).command});
  for (++i; i < stop_->size; ++i)
    tried_->add({point(i).time, point(i).distance - driven, point(i).speed, point(i).command});
  std::swap(stop_, tried_);
  is_current_ = true;
  return true;
}

}  // namespace chicane::safety
