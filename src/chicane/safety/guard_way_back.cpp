// SPDX-License-Identifier: MIT
// Guard: its options and known road (docs/safety.md, "Settings"), and the recovery of a car that stands,
// rolls back, is off the road or was moved (docs/safety.md, "The way back").
#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "chicane/base/math.hpp"
#include "chicane/safety/guard.hpp"
#include "chicane/tracking/way_back.hpp"

namespace chicane::safety {
namespace {

// The first is where StopPlanner gives a stop up; the others are of eq. 14, and chosen.
constexpr double kFarFromRoad = 20.0;    // [m] beside its line there is no stop along the road
constexpr double kTraction = 0.9;        // of the grip of a driven axle: beyond it no prediction holds
constexpr double kLeastTraction = 0.04;  // square of what is left of an axle that slides

/// The acceleration [m/s²] that the driven axles can give beside the force that they carry sideways
/// (docs/guard.md, eq. 14). Infinite for cars whose tyres share nothing between the directions.
double traction(const model::PredictionModel& model, const model::BodyMotion<double>& body) noexcept {
  const model::VehicleParams& car = model.vehicle();
  if (!(car.friction_coupling > 0.0)) return std::numeric_limits<double>::infinity();
  const auto tires = model.tire_use(body);  // undriven
  const double grip = kTraction * car.friction * model.load(body.vx) / car.wheelbase();
  const auto left = [](double use) { return std::sqrt(std::max(1.0 - use * use, kLeastTraction)); };
  const double front = left(tires.front) * grip * car.rear_axle / std::max(car.drive_share_front, 1e-6);
  const double rear = left(tires.rear) * grip * car.front_axle / std::max(1.0 - car.drive_share_front, 1e-6);
  return std::min(front, rear) + longitudinal_acceleration(car, 0.0, body.vx);
}

using G = GuardOptions;
constexpr std::array<std::string_view, 3> kModes{"on", "observe", "off"};
constexpr std::array<std::string_view, 2> kRoads{"track", "waypoints"};
constexpr std::array<std::string_view, 3> kReceivers{"stop-plan", "brake", "hold"};
constexpr std::array kOptions{
    option<&G::mode>(
        "mode", kModes,
        "Mode. on: without a way to stop, or when sensors fail, the car is stopped on the road; observe: it "
        "is only reported; off: only range and rate of commands are limited."),
    option<&G::road>("road", kRoads,
                     "Source of the road for the guard and for racing: the track, or waypoints."),
    option<&G::half_width>("half_width", unit::kMetre, 0.2, 100,
                           "Assumed from waypoints to edge where the road is known from waypoints."),
    option<&G::receiver>(
        "receiver", kReceivers,
        "Action of the actuators when commands cease: the stop that came with the last one, all "
        "braking with the last steering, or the last command for ever, as the original game."),
    option<&G::margin>("margin", unit::kMetre, 0, 10, "Distance from the edge that the stop at hand keeps."),
    option<&G::blind_time>(
        "blind_time", unit::kSecond, 0, 60,
        "Duration that a silence may last: the stop at hand keeps the road for so long when it is played "
        "by a car that differs a little from the assumed one; 0: not checked."),
};

}  // namespace

std::span<const Option> guard_options() noexcept { return kOptions; }

road::KnownRoad known_road(const GuardOptions& options, const road::RoadData* road,
                           const model::VehicleParams& vehicle) {
  if (options.mode == GuardMode::kOff) return {};
  const bool knows_track = options.road == GuardRoad::kTrack && road != nullptr && road->points.size() > 1;
  return knows_track ? road::KnownRoad{*road, vehicle} : road::KnownRoad{options.half_width, vehicle};
}

void Guard::forget_road() {
  if (options_.road == GuardRoad::kWaypoints) return;
  options_.road = GuardRoad::kWaypoints;
  road_ = known_road(options_, nullptr, model_.vehicle());
  run_.has_place = false;
  filter_.forget();
  set_grip(1.0);
  controller_->use_line(nullptr);
}

void Guard::use_line(std::shared_ptr<const road::RacingRoad> lap) {
  // The road that the lap was planned for has to be the one that the guard knows.
  if (lap && lap->is_learned() == (options_.road == GuardRoad::kWaypoints)) {
    road_.use_line(lap.get());
    adopt_line();
  }
  estimator_.mind_helper_gap(lap != nullptr);
  set_grip(lap ? lap->terms().grip : 1.0);
  controller_->use_line(std::move(lap));
}

/// The road's line is another one. The stored policy is a law that holds on any line of the road: it stays.
void Guard::adopt_line() noexcept {
  if (revision_ == road_.revision()) return;
  revision_ = road_.revision();
  run_.has_place = false;
  if (road_.line().is_empty()) filter_.forget();
}

/// Place of the car on the known road when the command acts; none when car or road are lost. A fast car with
/// real tyres is simulated with its four wheels from the estimate on, as its stop is.
std::optional<StopStart> Guard::place_on_road(double act_time) noexcept {
  const road::ReferenceLine& line = road_.line();
  run_.is_far = false;
  most_drive_ = std::numeric_limits<double>::infinity();
  act_speed_ = estimator_.is_started() ? estimator_.state().vx : std::numeric_limits<double>::infinity();
  if (line.is_empty() || !estimator_.is_started() || !std::isfinite(act_time)) return std::nullopt;
  const tracking::StateEstimator::Prediction at = estimator_.predict(act_time, sent_);
  model::State car = at.state;
  if (!std::isfinite(car.x + car.y + car.psi + car.vx + car.vy + car.r)) return std::nullopt;
  if (car.vx < model::PredictionModel::kSpeedFloor)
    car.vx = std::max(car.vx, estimator_.rolling_speed(act_time, sent_));
  act_speed_ = car.vx;
  most_drive_ = traction(model_, {car.vx, car.vy, car.r, car.steer, 0.0});
  double time = act_time, acceleration = at.acceleration;
  const bool is_recent = time - estimator_.time() < tracking::StateEstimator::kLongestGap;
  if (filter_.planner().has_wheels() && car.vx > StopCar::kByWheels && is_recent) {
    time = estimator_.time();
    car = estimator_.state();
    acceleration = estimator_.acceleration();
  }
  const double* last = run_.has_place ? &s_ : nullptr;
  const road::ReferenceLine::Projection place =
      line.find({car.x, car.y}, car.psi, 2.0 * model_.vehicle().width, last, 0.5 * kFarFromRoad);
  const double e = angle_difference(car.psi, line.at(place.s).heading);
  const model::BodyMotion<double> body{car.vx, car.vy, car.r, car.steer, acceleration};
  StopStart start{time, place.s, place.d, e, body, acceleration, car.vx * car.r};
  run_.has_place = place.distance < kFarFromRoad;
  run_.is_far = !run_.has_place;
  if (run_.is_far) return std::nullopt;
  for (double until = time, edge = 0.0; time < act_time - 1e-9; time = until) {
    until = sent_.next_change(time + 1e-9, act_time);
    start = filter_.planner().advance(road_, start, sent_.at(time + 1e-9), until - time, edge);
  }
  start.time = act_time;
  s_ = start.s;
  d_ = start.d;
  return start;
}

namespace {

using controller::Answer;
using controller::Rung;

// Origins (chosen: by trial, see Guard):
// - Derived: kLedBackSpeed (twice the pace of tracking::way_back), kAcross (its course of 45°),
//   kTrialSpeed (ResetWatch's speed of a standing car), kLongestAskPause (ResetWatch::kLongest).
// - Chosen, docs/guard.md: kArcDoubt (eq. 6c), kSeenTurn, kLeastTurned.
// - Chosen, docs/safety.md: kLost, kAlong, kReleaseTime, kStillTime, kTrialWay, kTrialRoom, kMostAside,
//   kNoAnswerTime.
// - Chosen: kChord, kAlongWaypoints (waypoints 10 m apart in a bend of 18 m); for what their lines say:
//   kAtRest, kRestTime, kRefusedTime, kGain, kMostAgainstRolling, kTrialPedal, kStillCreeps,
//   kTurnedWheels.
constexpr double kAtRest = 0.05;       // [m/s]
constexpr double kRestTime = 0.3;      // [s] below it after which a car is at rest
constexpr double kLedBackSpeed = 6.0;  // [m/s] below which a car that is off the road is led back
constexpr double kLost = 100.0;        // [m] farther away the car is not led back
constexpr double kAcross = 0.8;        // [rad] off the road's direction the car is across it
constexpr double kAlong = 0.2;         // [rad] within which it is along it again
constexpr double kRefusedTime = 1.0;   // [s] of refused commands after which a standing car is led back
constexpr double kReleaseTime = 0.5;   // [s] a car that should move may stand before its brake is released
constexpr double kGain = 0.1;          // [m/s] by which a car gains speed that nothing holds
constexpr double kMostAgainstRolling = 0.7;  // pedal against rolling back
constexpr double kStillTime = 1.0;   // [s] a car stands before it is tried whether it was put elsewhere
constexpr double kTrialWay = 0.5;    // share of the car's length that is driven for that
constexpr double kTrialRoom = 1.0;   // to the edge [m], where no stop fits; half of it during the trial
constexpr double kTrialSpeed = 1.0;  // [m/s]
constexpr double kTrialPedal = 0.3;
constexpr double kStillCreeps = 1.2;       // times kCreep: leaves room for the drive to overshoot it
constexpr double kArcDoubt = 0.1;          // [m] by which an arc may be predicted too near the edge
constexpr double kSeenTurn = 0.06;         // [rad] of turning after which a car that is led is judged by it
constexpr double kLeastTurned = 0.5;       // share of it that shows that the wheels answer
constexpr double kTurnedWheels = 0.1;      // share of full lock that wheels may lack
constexpr double kLongestAskPause = 60.0;  // [s] between two trials
constexpr double kMostAside = 1.0;         // [m] by which a place may have jumped across the road
constexpr double kChord = 0.7;             // [m] by which waypoints cut a bend
constexpr double kAlongWaypoints = 0.35;   // [rad] off the line of waypoints that bends between them, or off
                                           // the course that the car has by its estimate
constexpr double kNoAnswerTime = 1.0;      // [s] after which a controller without an answer begins anew

}  // namespace

/// A car that was put elsewhere, or is measured right again, begins anew where it answers.
void Guard::watch_for_reset(const model::Measurement& measured) noexcept {
  reset_watch_.see(measured, sent_.at(measured.time).throttle);
  if (!Supervisor::wants_trial(monitor_.findings())) {
    run_.has_jumped_aside = false;
    run_.ask_at = 0.0;
    run_.ask_pause = kAskPause;
  }
  run_.has_jumped_aside |= reset_watch_.has_jumped() && !agrees_with_road(measured);
  if (may_ask(measured)) {
    reset_watch_.ask();
    run_.ask_at = measured.time + run_.ask_pause;
    run_.ask_pause = std::min(2.0 * run_.ask_pause, kLongestAskPause);
  }
  if (!reset_watch_.is_waiting()) run_.tried = 0.0;
  if (!reset_watch_.is_waiting() || !(stands() || run_.tried > 0.0)) run_.still.at = measured.time;
  if (reset_watch_.has_answered()) begin_here();
}

/// The car has stood while its measurements agreed with each other and with the road that they show. A place
/// that has jumped aside is left to a person: the car would be led off the road by it.
bool Guard::may_ask(const model::Measurement& measured) const noexcept {
  const Findings& found = monitor_.findings();
  if (!Supervisor::wants_trial(found) || found.is_blind() || !stands() || !reset_watch_.rests()) return false;
  if (reset_watch_.is_waiting() || !(measured.time >= run_.ask_at)) return false;
  return !run_.has_jumped_aside || agrees_with_road(measured);
}

bool Guard::agrees_with_road(const model::Measurement& measured) const noexcept {
  const Vec2 place{measured.x, measured.y};
  const road::ReferenceLine& line = road_.line();
  if (options_.road == GuardRoad::kTrack && !line.is_empty()) {
    const auto at = line.project_along(place, measured.psi, 2.0 * model_.vehicle().width);
    const double e = angle_difference(measured.psi, line.at(at.s).heading);
    // Of a car that counts as off its road, a place on it is the likelier one.
    const bool is_back =
        run_.is_astray && filter_.planner().edge(road_, {.s = at.s, .d = at.d, .e = e}) > 0.0;
    const double expected = angle_difference(estimator_.state().psi, line.at(s_).heading);
    const bool is_along = std::fabs(e) < kAlongWaypoints || std::fabs(e - expected) < kAlongWaypoints;
    const bool is_beside = std::fabs(at.d - d_) < kMostAside + monitor_.place_drift();
    return at.distance < kFarFromRoad && is_along && (is_beside || is_back);
  }
  const auto size = static_cast<std::size_t>(std::max(measured.waypoint_count, 0));
  for (std::size_t i = 0; i + 1 < size; ++i) {
    const Vec2 way = measured.waypoints[i + 1] - measured.waypoints[i], from = place - measured.waypoints[i];
    const double length = way.norm();
    const double along = length > 0.0 ? (from.x() * way.x() + from.y() * way.y()) / length : -1.0;
    if (along < 0.0 || along > length) continue;
    const double aside = (way.x() * from.y() - way.y() * from.x()) / length;
    const double course = angle_difference(measured.psi, atan2(way.y(), way.x()));
    if (std::fabs(aside - d_) < kMostAside + kChord && std::fabs(course) < kAlongWaypoints) return true;
  }
  return size < 2;
}

/// Resets all estimates. A road learned from waypoints is dropped, too: the car may be on another one.
void Guard::begin_here() noexcept {
  estimator_.reset();
  monitor_.reset();
  supervisor_.reset();
  direction_.reset();
  filter_.forget();
  if (options_.mode == GuardMode::kOn) controller_->reset();
  if (options_.road == GuardRoad::kWaypoints) road_.reset();
  run_.has_place = run_.is_astray = run_.is_led = run_.has_jumped_aside = false;
}

/// A controller without an answer to whole measurements begins anew now and then: the car may have been put
/// where its road, or its estimate, does not lead.
void Guard::watch_answer(const model::Measurement& seen, bool has_answer) noexcept {
  if (has_answer || !seen.is_finite()) run_.answered.at = seen.time;
  if (!(run_.answered.lasts(seen.time) > kNoAnswerTime)) return;
  controller_->reset();
  run_.answered.at = seen.time;
}

/// By the estimate the car stands, but it is measured elsewhere: at walking pace, within half a car's length,
/// it shows whether it answers there. False where it is not tried: ResetWatch does not wait (run_.still
/// starts again in each cycle then), or has waited too shortly.
bool Guard::try_reset(const std::optional<StopStart>& start, const Cycle& cycle, double time,
                      controller::StepResult& result) noexcept {
  if (monitor_.findings().late || !(run_.still.lasts(time) > kStillTime)) return false;
  if (run_.tried > kTrialWay * model_.vehicle().length) {
    reset_watch_.give_up();
    return false;
  }
  const double speed = std::fabs(estimator_.state().vx);
  model::Command command{0.0, speed < kTrialSpeed ? kTrialPedal : 0.0};
  // A car that stopped where the known road ends has no stop ahead of it, nor one that is across the road or
  // off it; the way of the trial does without there, and as far inside the edges as walking pace needs.
  // Nearer to one it is an arc that leads along the road inside the edges.
  const double edge = start ? filter_.planner().edge(road_, *start) : -kFarFromRoad;
  const bool has_room = edge < 0.0 || edge >= (run_.tried > 0.0 ? 0.5 : 1.0) * kTrialRoom;
  const bool has_stop = start && verify(*start, cycle, command, true) != Fit::kNone;
  if (!has_room && !has_stop) {
    const model::VehicleParams vehicle = led_vehicle();
    const double lock = std::copysign(vehicle.steer_limit, -start->e);
    const double hold = PredictiveFilter::late_hold(cycle.interval, cycle.longest);
    if (!filter_.planner().creeps_inside(road_, *start, {.steer = lock, .hold = hold})) {
      if (stands()) report_.reason = controller::GuardReason::kFacesEdge;
      return false;
    }
    const bool has_turned = std::fabs(lock - start->body.steer) < kTurnedWheels * vehicle.steer_limit;
    command = has_turned ? filter_.planner().creep(lock, speed) : model::Command{lock, 0.0};
    filter_.withdraw_stop();
    if (!has_turned) {
      take_over(command, Rung::kReturnToRoad, result);
      return true;
    }
  }
  if (run_.tried == 0.0) reset_watch_.ask();  // a car that still rolled has turned round since it was asked
  run_.tried += std::max(speed, kTrialSpeed) * std::max(cycle.interval, 0.0);
  take_over(command, Rung::kReturnToRoad, result);
  return true;
}

/// A car off the road or across it is astray until it is along the road again.
void Guard::watch_course(const std::optional<StopStart>& start) noexcept {
  const double least = options_.road == GuardRoad::kWaypoints ? -kGuessedWidth : 0.0;
  run_.has_stood_astray = run_.is_astray && (run_.has_stood_astray || stands());
  if (!start) {
    run_.is_astray = run_.is_far;
    return;
  }
  const bool is_on_road = filter_.planner().edge(road_, *start) >= least;
  const double off = std::fabs(start->e);
  if (!is_on_road || off > kAcross) run_.is_astray = true;
  if (is_on_road && off < kAlong) run_.is_astray = false;
}

bool Guard::should_lead_back(double time, bool has_answer) noexcept {
  if (!has_answer || !(stands() || run_.is_led)) run_.refused.at = time;
  if (run_.refused.lasts(time) > kRefusedTime) run_.is_led = true;
  return run_.is_astray || (run_.is_led && has_answer);
}

bool Guard::idles(const controller::StepResult& result) const noexcept {
  return (stands() || run_.is_led) && result.report.speed_reference > kTrialSpeed &&
         !(result.command.throttle > kDrives);
}

bool Guard::lead_back(double act, const Cycle& cycle, controller::StepResult& result) noexcept {
  const road::ReferenceLine& line = road_.line();
  if (line.is_empty() || !estimator_.is_started() || !std::isfinite(act)) return false;
  LedCar led{.state = estimator_.predict(act, sent_).state, .vehicle = led_vehicle()};
  const model::State& car = led.state;
  const bool rolls_back = direction_.rolls_back();
  const bool is_slow = rolls_back || std::fabs(car.vx) < kLedBackSpeed;
  if (!std::isfinite(car.x + car.y + car.psi + car.vx) || !is_slow) return false;
  const road::ReferenceLine::Projection place =
      line.project_along({car.x, car.y}, car.psi, 2.0 * model_.vehicle().width);
  if (!(place.distance < kLost)) return false;
  result.command = rolls_back ? model::Command{0.0, against_rolling_back()}
                              : tracking::way_back(line, place, car, led.vehicle);
  led.start = place_on_road(act);
  if (run_.is_astray) filter_.forget();
  const double edge = led.start ? filter_.planner().edge(road_, *led.start) : 0.0;
  led.stands = std::fabs(car.vx) < kStandingSpeed && !rolls_back;
  led.is_on_road = led.start && edge >= 0.0;
  led.may_creep = led.is_on_road &&
                  (led.stands || (std::fabs(car.vx) < kStillCreeps * StopPlanner::kCreep && !rolls_back));
  run_.creeps &= led.may_creep;
  led.hold = PredictiveFilter::late_hold(cycle.interval, cycle.longest);
  turn_beside_edge(led, result.command);
  // The wheels turn at standstill: driving meanwhile would use up the room to the edge.
  const bool has_turned =
      std::fabs(result.command.steer - car.steer) < kTurnedWheels * led.vehicle.steer_limit;
  const bool waits = led.stands && led.is_on_road && !(turns_as_asked(act, car) && has_turned);
  if (led.stands && result.command.throttle > 0.0)
    result.command = filter_.planner().creep(result.command.steer, car.vx);
  Fit fit = led.start && !waits ? verify(*led.start, cycle, result.command, true) : Fit::kNone;
  if (fit == Fit::kNone && led.may_creep && !waits && has_turned &&
      stays_on_road(led, car.steer, run_.goes_round)) {
    result.command = filter_.planner().creep(result.command.steer, car.vx);
    fit = Fit::kSeen;
    run_.creeps = true;
  }
  // Without a verified stop only a car that has stood astray, with a controller that cannot drive, may near
  // the edge. Any other keeps its stop and turns its wheels: with turned wheels it needs less room.
  const bool may_leave = run_.has_stood_astray && !waits && result.answer != Answer::kDrive;
  if (led.is_on_road && fit == Fit::kNone && !may_leave) return turn_wheels_only(led, waits, result);
  if (fit == Fit::kNone) filter_.forget();
  take_over(result.command, Rung::kReturnToRoad, result);
  return true;
}

bool Guard::stays_on_road(const LedCar& led, double angle, bool goes_round) const noexcept {
  return filter_.planner().creeps_inside(road_, *led.start, {angle, led.hold, led.doubt, goes_round});
}

void Guard::turn_beside_edge(LedCar& led, model::Command& command) noexcept {
  const bool goes_on_round = std::exchange(run_.goes_round, false);
  if (!led.may_creep) return;
  const double now = led.state.steer, asked = command.steer;
  const double lock = std::copysign(led.vehicle.steer_limit, -led.start->e);
  // An arc in doubt is the way of a car that has no other. A car that has stood astray has: off the road.
  for (const double doubt : {0.0, run_.has_stood_astray ? 0.0 : kArcDoubt}) {
    led.doubt = doubt;
    run_.goes_round = goes_on_round && stays_on_road(led, now, true);
    if (!run_.goes_round && stays_on_road(led, asked)) return;
    const bool goes_on = run_.goes_round || (run_.creeps && stays_on_road(led, now));
    const bool is_short = !goes_on && stays_on_road(led, lock);
    run_.goes_round |= !goes_on && !is_short && stays_on_road(led, -lock, true);
    const double steer = goes_on ? now : run_.goes_round ? -lock : lock;
    command = filter_.planner().creep(steer, led.state.vx);
    if (goes_on || is_short || run_.goes_round) return;
  }
}

bool Guard::turn_wheels_only(const LedCar& led, bool waits, controller::StepResult& result) noexcept {
  const double steer = result.command.steer;
  if (led.stands && !waits && !stays_on_road(led, steer, run_.goes_round))
    report_.reason = controller::GuardReason::kFacesEdge;
  const bool has_stop = led.may_creep && drive_stop(*led.start, result);
  if (!has_stop && !led.stands) return false;
  if (!has_stop) take_over({steer, 0.0}, Rung::kReturnToRoad, result);
  result.command.steer = steer;
  filter_.withdraw_stop();  // a receiver that plays the stop from now on would turn the wheels back
  return true;
}

model::VehicleParams Guard::led_vehicle() const noexcept {
  model::VehicleParams vehicle = model_.vehicle();
  const double lock = vehicle.steer_limit;
  vehicle.steer_limit = std::clamp(answer_.gain * lock - std::fabs(answer_.offset), 0.1 * lock, lock);
  return vehicle;
}

/// Whether the led car turns as its wheels' angle predicts. If not, it waits: it would leave the way that
/// verify() has checked.
bool Guard::turns_as_asked(double time, const model::State& car) noexcept {
  const model::State& now = estimator_.state();
  const model::Pose from = run_.led_from;
  const bool goes_on = time - std::exchange(run_.led_at, time) < kStillTime;
  const double way = (now.x - from.x) * cos(now.psi) + (now.y - from.y) * sin(now.psi);
  run_.led_asked += way * car.steer / model_.vehicle().wheelbase();
  const bool is_judged = goes_on && std::fabs(run_.led_asked) > kSeenTurn;
  if (is_judged && angle_difference(now.psi, run_.led_heading) / run_.led_asked < kLeastTurned)
    run_.stays_until = time + kAskPause;
  if (!goes_on || is_judged) {
    run_.led_heading = now.psi;
    run_.led_asked = 0.0;
  }
  run_.led_from = {now.x, now.y, now.psi};
  if (!(time < run_.stays_until)) return true;
  report_.reason = controller::GuardReason::kOtherSteering;
  return false;
}

double Guard::against_rolling_back() const noexcept {
  const double speed = std::fabs(estimator_.state().vx);
  const double pedal = tracking::throttle_against_rolling_back(model_.vehicle(), speed);
  return pedal > 0.0 && speed > kRollsBackAtMost ? 0.0 : std::min(pedal, kMostAgainstRolling);
}

/// The pedal that brought a car to rest is its reverse gear from then on: the speed is measured without a
/// sign, and a car that begins to roll back would be braked into going faster.
void Guard::watch_rest(double time, double throttle) noexcept {
  const double speed = std::fabs(estimator_.state().vx);
  if (!estimator_.is_started() || !(speed < kAtRest)) run_.moved.at = time;
  if (run_.moved.lasts(time) > kRestTime) run_.rests = true;
  if (speed > kStandingSpeed || throttle > kDrives) run_.rests = false;
}

/// A car that should move and stands is stuck after kStuckTime, where nothing worse is said of it. Its pedals
/// are released for a cycle now and then: a brake that stays on lets go then. It holds a slow car, too, that
/// gains no speed by its drive.
void Guard::free_stuck_car(double time, const Cycle& cycle, controller::StepResult& result) noexcept {
  model::Command& command = result.command;
  const model::VehicleParams& car = model_.vehicle();
  const double speed = std::fabs(estimator_.state().vx);
  const bool stands = speed < kStandingSpeed;
  const bool drives = command.throttle > kDrives;
  const bool is_held = drives && speed < std::min(car.brake_latch_speed, run_.held_speed + kGain);
  const bool should_move = is_held || (stands && (drives || run_.is_idle));
  if (!should_move) {
    run_.stuck.at = run_.released.at = time;
    run_.held_speed = speed;
  }
  controller::GuardReason& reason = report_.reason;
  const bool has_worse = controller::word_of(reason).severity == Severity::kError;
  if (stands && run_.stuck.lasts(time) > kStuckTime && !has_worse) reason = controller::GuardReason::kStuck;
  // Between two releases there is a cycle in which the car is driven.
  const double pause = std::max(car.latches_brakes() ? kReleaseTime : kStuckTime,
                                1.5 * std::max(cycle.interval, cycle.longest));
  if (!(run_.released.lasts(time) > pause)) return;
  command.throttle = car.latches_brakes() ? car.brake_release_throttle : 0.0;
  run_.released.at = time;
}

}  // namespace chicane::safety
