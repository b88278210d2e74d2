// SPDX-License-Identifier: MIT
#include "chicane/safety/guard.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "chicane/base/angle.hpp"
#include "chicane/base/math.hpp"
#include "chicane/safety/stop_player.hpp"
#include "chicane/safety/stop_search.hpp"

namespace chicane::safety {
namespace {

using controller::Answer;
using controller::GuardReason;
using controller::Rung;

constexpr double kAssumedCycle = 0.04;           // [s] where the interval between commands is not known
constexpr double kShortestHold = 0.09;           // [s] a command is held for so long where no other one comes
constexpr double kSlowStop = 6.0;                // [m] a car that stops within this is slow
constexpr double kStandingSpeed = 0.6;           // [m/s]
constexpr int kShown = 64;                       // points of a stop that is drawn
constexpr double kShownStep = 0.1;               // [s]
constexpr double kWalkingPace = 3.0;             // [m/s]
constexpr double kFastestWayBack = 4.0;          // [m/s]
constexpr double kMostUse = 0.75;                // of the tyres sideways, after a command: the law's stops
constexpr double kMostUseUnplanned = 0.65;       // the same where the controller shows no plan
constexpr double kMostUseEver = 1.2;             // and those that are searched for
constexpr double kDrivesOn[] = {0.5, 1.0, 1.5};  // [s] as the controller plans, before a stop
constexpr double kRecovery = 0.5;                // [s] after a silence, until the car is in hand again
constexpr double kDrivenBlind = 2.0;             // [s] of a silence while the car is being stopped
constexpr double kUnfit = 200.0;                 // worse than any stop that fits, in m and m/s
constexpr double kGuessedWidth = 1.0;    // [m] that the assumed width may be too small by, for a slow car
constexpr double kLeastEdge = 0.1;       // [m] that a car on the road keeps in any case
constexpr double kNoFloor = -1e9;        // [m]
constexpr double kLeniency = 0.05;       // [m] nearer to the edge, for a slow car beyond the margin
constexpr double kLeniencyRate = 0.25;   // [m/s] more of it for one that stands
constexpr double kMostLeniency = 3.0;    // [m]
constexpr double kLongestHold = 0.5;     // [s]
constexpr double kFarFromRoad = 20.0;    // [m] beside its line there is no stop along the road
constexpr double kBlindStability = 1.6;  // of a car that is steered without feedback
constexpr double kGentleStop = 0.8;      // share of the useful braking; all of it when that is too little
constexpr double kBarelyStable = 1.1;    // where that is too little, too
constexpr double kHeldByHand = 0.7;      // of a car that is steered by what it does
// Of a car that is too fast for a silence.
constexpr Braking kHeldBack{kGentleStop, kBlindStability, kHeldByHand};
// What is tried in turn.
constexpr Braking kStops[] = {{kGentleStop, kBlindStability, kHeldByHand},
                              {1.0, kBlindStability, kHeldByHand},
                              {1.0, kBarelyStable},
                              {1.0, kHeldByHand},
                              {1.0, 0.0}};

bool is_finite(const model::Command& command) noexcept {
  return std::isfinite(command.steer) && std::isfinite(command.throttle);
}

/// When the command of this cycle acts [s], where the controller does not say.
double act_time(const model::Measurement& seen, const controller::StepReport& report) noexcept {
  return std::isnan(report.act_time) ? seen.time + seen.delay : report.act_time;
}

}  // namespace

static std::unique_ptr<StopSearch> copy_of(const StopSearch& search) {
  return std::make_unique<StopSearch>(search);
}

static std::unique_ptr<StopCourse> copy_of(const StopCourse& course) {
  return std::make_unique<StopCourse>(course);
}

road::KnownRoad known_road(const GuardOptions& options, const path::RoadData* road,
                           const model::VehicleParams& vehicle) {
  if (options.mode == GuardMode::kOff) return {};
  const bool knows_track = options.road == GuardRoad::kTrack && road != nullptr && road->points.size() > 1;
  return knows_track ? road::KnownRoad{*road, vehicle} : road::KnownRoad{options.half_width, vehicle};
}

Guard::Guard(std::unique_ptr<controller::Controller> controller, const model::VehicleParams& vehicle,
             const GuardOptions& options, const path::RoadData* road)
    : Guard(std::move(controller), vehicle, options, known_road(options, road, vehicle)) {}

Guard::Guard(std::unique_ptr<controller::Controller> controller, const model::VehicleParams& vehicle,
             const GuardOptions& options, road::KnownRoad road)
    : controller_{std::move(controller)},
      options_{options},
      fallback_{vehicle},
      gate_{vehicle},
      road_{std::move(road)},
      estimator_{model::PredictionModel{vehicle}},
      planner_{vehicle},
      search_{std::make_unique<StopSearch>(vehicle)},
      model_{vehicle},
      stop_{std::make_unique<StopCourse>()},
      tried_{std::make_unique<StopCourse>()},
      last_{std::make_unique<StopCourse>()} {
  estimator_.estimate_disturbance(planner_.has_wheels());
}

Guard::Guard(const Guard& other) = default;

Guard::~Guard() = default;

void Guard::reset() noexcept {
  controller_->reset();
  monitor_.reset();
  supervisor_.reset();
  fallback_.reset();
  gate_.reset();
  road_.reset();
  estimator_.reset();
  direction_.reset();
  sent_.clear();
  stop_->stop.size = last_->stop.size = 0;
  has_place_ = false;
  floor_ = kNoFloor;
  search_->forget();
}

void Guard::forget_road() {
  if (options_.road == GuardRoad::kWaypoints) return;
  options_.road = GuardRoad::kWaypoints;
  road_ = known_road(options_, nullptr, model_.vehicle());
  has_place_ = races_ = false;
  controller_->use_line(nullptr);
}

void Guard::use_line(std::shared_ptr<const road::RacingRoad> lap) {
  if (options_.road == GuardRoad::kTrack && lap && !lap->is_learned()) road_.use_line(lap.get());
  has_place_ = false;
  races_ = lap != nullptr;
  search_->forget();
  controller_->use_line(std::move(lap));
}

void Guard::set_vehicle(const model::VehicleParams& vehicle) noexcept {
  fallback_.set_vehicle(vehicle);
  model_.set_vehicle(vehicle);
  planner_.set_vehicle(vehicle);
  search_->set_vehicle(vehicle);
  estimator_.set_model(model_);
}

model::Command Guard::step(const model::Measurement& measured, Deadline deadline, const Cycle& cycle,
                           controller::StepResult& result) noexcept {
  const bool is_off = options_.mode == GuardMode::kOff;
  const model::Measurement& seen = is_off ? measured : look(measured);
  result = controller_->step(seen, deadline);
  if (!is_finite(result.command)) result.answer = Answer::kNone;
  choose(seen, cycle, result);
  const model::Command asked = result.command;
  const GateResult gated = gate_.pass(cycle.manual.value_or(asked), cycle.interval);
  result.command = gated.command;
  result.report.gated = gated.reason != GateReason::kNone;
  controller_->note_sent(result.command);
  if (!is_off && std::isfinite(sent_from_)) sent_.add(sent_from_, result.command);
  return asked;
}

/// What of a measurement can be believed; estimate and road take it in.
const model::Measurement& Guard::look(const model::Measurement& measured) noexcept {
  std::optional<model::State> expected;
  const bool rolled_back = direction_.rolls_back();
  direction_.see(measured);
  // Nothing is expected of a car that rolls back: the estimate goes the other way.
  if (direction_.rolls_back() != rolled_back) {
    estimator_.reset();
    monitor_.reset();
  }
  if (estimator_.is_started() && std::isfinite(measured.time) && !direction_.rolls_back())
    expected = estimator_.predict(measured.time, sent_).state;
  const model::Measurement& seen = monitor_.check(measured, expected ? &*expected : nullptr);
  if (monitor_.findings().is_reset) {
    estimator_.reset();
    has_place_ = false;
  }
  road_.add(seen);
  estimator_.correct(seen, sent_);
  return options_.mode == GuardMode::kOn ? seen : measured;
}

void Guard::choose(const model::Measurement& seen, const Cycle& cycle,
                   controller::StepResult& result) noexcept {
  const double act = act_time(seen, result.report);
  sent_from_ = seen.time + seen.delay;
  std::swap(stop_, last_);
  stop_->stop.size = 0;
  if (options_.mode == GuardMode::kOff || cycle.manual) {
    if (cycle.manual) supervisor_.rearm();
    return result.answer == Answer::kNone ? fall_back(seen, result) : accept(seen, result);
  }
  const model::State& now = estimator_.state();
  const Supervisor::Verdict verdict = supervisor_.judge(monitor_.findings(), seen.time, now.vx);
  if (verdict.may_begin_anew) {
    monitor_.reset();
    estimator_.reset();
  }
  controller::StepReport& report = result.report;
  report.reason = verdict.reason;
  const std::optional<StopStart> start = place_on_road(act);
  const bool has_answer = result.answer != Answer::kNone;
  if (!has_answer && report.reason == GuardReason::kNone)
    report.reason = is_far_ ? GuardReason::kFarFromRoad : GuardReason::kNoAnswer;
  bool must_stop = verdict.must_stop || !has_answer;
  if (start && !must_stop) {
    const Fit fit = leaves_a_stop(*start, result.command, result.plan, cycle.interval, report);
    must_stop = fit == Fit::kNone && !is_way_back(*start, result);
    if (fit == Fit::kSeen) {
      report.reason = GuardReason::kTooFastForSilence;
      must_stop = options_.mode == GuardMode::kOn && !hold_back(*start, cycle.interval, result);
    }
    if (must_stop) report.reason = GuardReason::kNoWayToStop;
  }
  if (result.answer == Answer::kReturnToRoad) floor_ = kNoFloor;  // it may lead further away at first
  if (options_.mode == GuardMode::kObserve) must_stop = !has_answer;
  if (!must_stop) return accept(seen, result);
  if (start && options_.mode == GuardMode::kOn) {
    drive_stop(*start, result);
  } else {
    fall_back(seen, result);
  }
  // What brakes a car that goes forward may be the reverse gear of one that rolls back.
  if (direction_.rolls_back() && result.command.throttle < 0.0)
    result.command.throttle = controller::throttle_against_rolling_back(model_.vehicle(), now.vx);
}

/// The car could be stopped while it is seen, but not by a receiver that is left alone: steered by its
/// controller it is slowed down, as gently as it stays stable, until it could. False where that leaves no
/// stop at all.
bool Guard::hold_back(const StopStart& start, double interval, controller::StepResult& result) noexcept {
  model::Command slower = result.command;
  const double slowing = planner_.slowing(road_, start, kHeldBack);
  slower.throttle = std::min(slower.throttle, throttle_for(model_.vehicle(), slowing, start.body.vx));
  if (slower.throttle < result.command.throttle &&
      leaves_a_stop(start, slower, result.plan, interval, result.report) == Fit::kNone)
    return false;
  result.command = slower;
  return true;
}

/// A way back to the road begins where there may be none: slow as it is, it is planned for the receiver, and
/// not refused.
bool Guard::is_way_back(const StopStart& start, const controller::StepResult& result) const noexcept {
  if (result.answer == Answer::kDrive) return false;
  return result.command.throttle <= 0.0 || start.body.vx < kFastestWayBack || direction_.rolls_back();
}

/// The controller's answer is sent.
void Guard::accept(const model::Measurement& seen, controller::StepResult& result) noexcept {
  switch (result.answer) {
    case Answer::kStopOnRoad:
      result.report.rung = Rung::kStopOnRoad;
      return;
    case Answer::kReturnToRoad:
      result.report.rung = Rung::kReturnToRoad;
      return;
    case Answer::kDrive:
    case Answer::kNone:
      break;
  }
  result.report.rung = Rung::kController;
  if (result.plan.size > 0) {
    fallback_.accept(result.plan);
  } else {
    fallback_.accept(result.command, act_time(seen, result.report), seen.speed);
  }
}

void Guard::fall_back(const model::Measurement& seen, controller::StepResult& result) noexcept {
  const Fallback::Answer answer = fallback_.command(act_time(seen, result.report), seen);
  result.answer = Answer::kNone;
  result.command = answer.command;
  result.report.rung = answer.rung;
  result.plan.size = 0;
  result.plan.reference_size = 0;
}

/// The stop in the place of the controller's answer.
void Guard::drive_stop(const StopStart& start, controller::StepResult& result) noexcept {
  const bool is_blind = monitor_.findings().unmeasured || monitor_.findings().frozen;
  // Without measurements there is nothing to plan anew by that counts on better than the stop does.
  if (!is_blind || !planner_.has_wheels() || !keep_stop(start.time, result.report))
    static_cast<void>(plan_stop(start, std::numeric_limits<double>::infinity(),
                                {.is_driven = true, .is_hard = is_blind}, result.report));
  result.answer = Answer::kNone;
  result.command = stop_->stop.points[0].command;
  result.report.rung = Rung::kGuardStop;
  show_stop(start, result.plan);
}

/// The stop of the cycle before goes on from `time` [s] on; false where there is none.
bool Guard::keep_stop(double time, controller::StepReport& report) noexcept {
  const auto size = static_cast<std::size_t>(last_->stop.size);
  std::size_t i = 0;
  while (i + 1 < size && last_->stop.points[i + 1].time <= time) ++i;
  if (i + 1 >= size) return false;
  const StopPoint& here = last_->stop.points[i];
  const StopPoint& next = last_->stop.points[i + 1];
  const double share = std::max(time - here.time, 0.0) / (next.time - here.time);
  const double driven = here.distance + share * (next.distance - here.distance);
  const double speed = here.speed + share * (next.speed - here.speed);
  stop_->stop.size = 0;
  StopStart place = last_->places[i];
  place.time = std::max(time, here.time);
  stop_->add(place, 0.0, speed, here.command);
  for (++i; i < size; ++i) {
    const StopPoint& point = last_->stop.points[i];
    stop_->add(last_->places[i], point.distance - driven, point.speed, point.command);
  }
  report.stop_distance = last_->stop.points[size - 1].distance - driven;
  return true;
}

/// The stop as a plan, for viewers.
void Guard::show_stop(const StopStart& start, controller::Plan& plan) const noexcept {
  const road::ReferenceLine& line = road_.line();
  StopStart at = start;
  double edge = 0.0;
  double driven = 0.0;
  plan.size = plan.reference_size = 0;
  while (plan.size < kShown) {
    const double speed = hypot(at.body.vx, at.body.vy);
    const model::Command command = played(stop_->stop, driven, speed, model_.vehicle());
    driven += kShownStep * speed;
    const road::CurvePoint here = line.at(at.s);
    const auto i = static_cast<std::size_t>(plan.size++);
    plan.reference[i] = here.position;
    plan.points[i] = {.time = at.time,
                      .x = here.position.x() - at.d * here.tangent.y(),
                      .y = here.position.y() + at.d * here.tangent.x(),
                      .psi = here.heading + at.e,
                      .speed = at.body.vx,
                      .command = command};
    if (at.body.vx < kStandingSpeed) break;
    at = planner_.advance(road_, at, command, kShownStep, edge);
  }
  plan.reference_size = plan.size;
}

/// Where the car will be on the known road when the command acts; none when car or road are lost.
std::optional<StopStart> Guard::place_on_road(double act_time) noexcept {
  const road::ReferenceLine& line = road_.line();
  is_far_ = false;
  if (line.is_empty() || !estimator_.is_started() || !std::isfinite(act_time)) return std::nullopt;
  const controller::StateEstimator::Prediction at = estimator_.predict(act_time, sent_);
  const model::State& car = at.state;
  if (!std::isfinite(car.x + car.y + car.psi + car.vx + car.vy + car.r)) return std::nullopt;
  if (revision_ != road_.revision()) {
    has_place_ = false;
    last_->stop.size = 0;
  }
  revision_ = road_.revision();
  const Vec2 position{car.x, car.y};
  const double* last = has_place_ ? &s_ : nullptr;
  const road::ReferenceLine::Projection place =
      line.find(position, car.psi, 2.0 * model_.vehicle().width, last, 0.5 * kFarFromRoad);
  has_place_ = place.distance < kFarFromRoad;
  is_far_ = !has_place_;
  if (is_far_) return std::nullopt;
  s_ = place.s;
  const double e = angle_difference(car.psi, line.at(place.s).heading);
  return StopStart{.time = act_time,
                   .s = place.s,
                   .d = place.d,
                   .e = e,
                   .body = {car.vx, car.vy, car.r, car.steer, at.acceleration},
                   .load_along = at.acceleration,
                   .load_across = car.vx * car.r};
}

/// How the car can still be stopped on the road after `command` has acted for a cycle.
Guard::Fit Guard::leaves_a_stop(const StopStart& start, const model::Command& command,
                                const controller::Plan& intended, double interval,
                                controller::StepReport& report) noexcept {
  // The receiver holds the command until the stop begins: time enough for the next one to come late.
  const double cycle = interval > 0.0 ? interval : kAssumedCycle;
  const double held = std::clamp(cycle, kShortestHold, kLongestHold);
  double least_edge = planner_.edge(road_, start);
  const double edge_now = least_edge;
  const StopStart next = planner_.advance(road_, start, command, held, least_edge);
  model::BodyMotion<double> undriven = next.body;  // a stop does not ask for its drive
  undriven.acceleration = std::min(undriven.acceleration, 0.0);
  const auto use = model_.tire_use(undriven);
  const double most_use = start.body.vx > kWalkingPace ? std::max(use.front, use.rear) : 0.0;
  const bool slides = most_use > (intended.size > 1 ? kMostUse : kMostUseUnplanned);
  const Fit fit = plan_stop(next, least_edge, {.intended = &intended, .slides = slides}, report);
  if (fit != Fit::kNone && most_use < kMostUseEver) {
    floor_ = kNoFloor;
    return fit;
  }
  // A car that is beyond the margin already may move slowly, if it comes no nearer to the edge than it was.
  // One that stands and would wait for ever may use up the margin; one that is off the road may come further,
  // the more the longer it has stood.
  if (start.body.vx > kWalkingPace) floor_ = kNoFloor;  // it has not come to rest yet
  if (edge_now > floor_ + kLeniency) {
    floor_ = edge_now;
    leniency_ = kLeniency;
  }
  if (std::fabs(start.body.vx) < kStandingSpeed) leniency_ += kLeniencyRate * cycle;
  const double least = options_.road == GuardRoad::kWaypoints ? -kGuessedWidth : kLeastEdge;
  const double lowest = floor_ < 0.0 ? floor_ - kMostLeniency : least;
  const double allowed = std::max(std::min(floor_, options_.margin) - leniency_, lowest);
  const bool is_slow = !slides && report.stop_distance < kSlowStop && report.stop_edge >= allowed;
  return is_slow ? Fit::kBlind : Fit::kNone;
}

/// The first of the stops that keeps the margin, and the road when it is played blindly for as long as a
/// silence may last; else the best of them. A car that `slides` is no longer one that the law knows. A stop
/// for which the model has to be right to the last is enough for who shows that he plans, too: he stays away
/// from where it is needed (docs/safety.md, "The invariant").
Guard::Fit Guard::plan_stop(const StopStart& from, double edge_before, const StopWish& wish,
                            controller::StepReport& report) noexcept {
  const bool plans = wish.intended != nullptr && wish.intended->size > 1 && !wish.slides;
  double best = -std::numeric_limits<double>::infinity();
  Fit best_fit = Fit::kNone;
  // Takes `tried_` where it is better than what there is. True: no other one is needed.
  const auto suffices = [&](const StopCheck& check, bool is_known) {
    const double edge = std::min(check.least_edge, edge_before);
    double worth = edge - kUnfit;
    Fit fit = Fit::kNone;
    bool lasts = false;
    if (check.stands && edge >= options_.margin) {
      const BlindCheck blind = played_edge(from, wish.is_driven ? kDrivenBlind : options_.blind_time);
      lasts = blind.edge >= 0.0;
      if (blind.edge_for >= 0.0) {
        fit = Fit::kBlind;
        worth = lasts ? kUnfit + blind.edge : kUnfit - blind.speed;
      } else if (!wish.is_hard) {
        const double followed = std::min(planner_.followed_edge(road_, from, *tried_), 0.0);
        if (followed >= 0.0 || plans) fit = Fit::kSeen;
        worth = followed - blind.speed;
      }
    }
    if (worth >= best) {
      best = worth;
      best_fit = is_known ? fit : Fit::kNone;
      std::swap(stop_, tried_);
      report.stop_edge = edge;
      report.stop_distance = check.distance;
    }
    return is_known && fit == Fit::kBlind && (lasts || wish.is_driven);
  };
  const auto search = [&] {
    const StopCheck found = search_->plan(road_, from, options_.margin, planner_, *tried_);
    return tried_->stop.size > 0 && suffices(found, true);
  };
  const auto follow = [&] {
    return last_->stop.size > 0 && suffices(planner_.follow(road_, from, *last_, *tried_), !wish.slides);
  };
  if (races_ && search()) return best_fit;
  for (const Braking& braking : kStops) {
    if (wish.is_hard && braking.share < 1.0) continue;
    if (best_fit == Fit::kBlind && braking.stability < kBarelyStable) break;
    if (suffices(planner_.plan(road_, from, braking, *tried_), !wish.slides)) return best_fit;
  }
  if (wish.is_driven && follow()) return best_fit;
  for (const double time : kDrivesOn) {
    if (!plans || best_fit != Fit::kNone) break;
    if (suffices(planner_.plan_later(road_, from, *wish.intended, time, kStops[1], *tried_), true))
      return best_fit;
  }
  if (!races_ && best_fit == Fit::kNone && (wish.is_driven || plans)) static_cast<void>(search());
  return best_fit;
}

/// How near to the edge [m] the receiver comes with `tried_` in a silence of `time` [s], or of the length
/// that is planned for where that is shorter.
BlindCheck Guard::played_edge(const StopStart& from, double time) const noexcept {
  if (!(options_.blind_time > 0.0)) return {};
  return planner_.played_edge(road_, from, tried_->stop, std::min(time, options_.blind_time) + kRecovery);
}

}  // namespace chicane::safety
