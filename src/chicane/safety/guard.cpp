// SPDX-License-Identifier: MIT
// Guard: one control cycle, from the measurement to the command that is sent. The way back of a car that is
// off its road, or stuck, is in guard_way_back.cpp.
#include "chicane/safety/guard.hpp"

#include <algorithm>
#include <utility>

#include "chicane/base/math.hpp"

namespace chicane::safety {
namespace {

using controller::Answer;
using controller::GuardReason;
using controller::Rung;

constexpr int kShown = 64;          // points of a stop that is drawn: 6.4 s; chosen
constexpr double kShownStep = 0.1;  // [s] between two of them; chosen

bool is_finite(const model::Command& command) noexcept {
  return std::isfinite(command.steer) && std::isfinite(command.throttle);
}

/// Limits the sizes in the plan of a user's controller to the capacity: later readers need no check.
void clamp_sizes(controller::Plan& plan) noexcept {
  plan.size = std::clamp(plan.size, 0, controller::Plan::kCapacity);
  plan.reference_size = std::clamp(plan.reference_size, 0, controller::Plan::kCapacity);
}

/// Whether the controller has a model of the tyres, and so relies on commands that compensate the actuators'
/// deviation. One with bounds of its inputs alone has none: its commands are sent unchanged.
bool plans_with_car(const controller::Controller& controller) noexcept {
  return controller.constraints().size() > controller::kInputConstraintNames.size();
}

}  // namespace

Guard::Guard(std::unique_ptr<controller::Controller> controller, const model::VehicleParams& vehicle,
             const GuardOptions& options, const road::RoadData* road)
    : Guard(std::move(controller), vehicle, options, known_road(options, road, vehicle)) {}

Guard::Guard(std::unique_ptr<controller::Controller> controller, const model::VehicleParams& vehicle,
             const GuardOptions& options, road::KnownRoad road)
    : controller_{std::move(controller)},
      vehicle_{vehicle},
      options_{options},
      monitor_{vehicle.length, vehicle.wheelbase()},
      actuators_{vehicle},
      learned_{vehicle},
      fallback_{vehicle},
      gate_{vehicle},
      road_{std::move(road)},
      estimator_{model::PredictionModel{vehicle}},
      filter_{vehicle,
              {.margin = options.margin,
               .least_edge = options.road == GuardRoad::kWaypoints ? -kGuessedWidth : 0.0,
               .open_time = options.blind_time}},
      model_{vehicle} {
  estimator_.estimate_disturbance(filter_.planner().has_wheels());
}

void Guard::reset() noexcept {
  controller_->reset();
  monitor_.reset(/*forgets_lateness=*/true);
  reset_watch_.reset();
  actuators_.reset();
  learned_.reset();
  sent_.clear();
  commanded_.clear();
  update_answer();
  update_model_vehicle();
  supervisor_.reset();
  fallback_.reset();
  gate_.reset();
  road_.reset();
  estimator_.reset();
  direction_.reset();
  filter_.forget();
  run_ = {};
}

void Guard::set_vehicle(const model::VehicleParams& vehicle) noexcept {
  vehicle_ = vehicle;
  learned_.set_vehicle(vehicle);
  set_grip(grip_);
}

/// Sets the grip that stops assume: that of the planned lap, as a share of the configured one.
void Guard::set_grip(double share) noexcept {
  grip_ = share;
  actuators_.set_vehicle(model::with_grip(vehicle_, share));
  update_model_vehicle();
}

bool Guard::is_stopped_by_receiver(const model::Measurement& measured, double longest) const noexcept {
  const double newest = measured.time + std::max(learned_.answer().delay, 0.0);
  return measured.throttle <= 0.0 &&
         commanded_.lowest_throttle(measured.time - longest - PredictiveFilter::kLateness, newest) > kDrives;
}

/// Gives estimator, stops and fallback the parameters of the car with the braking that was observed.
void Guard::update_model_vehicle() noexcept {
  const model::VehicleParams vehicle =
      options_.mode == GuardMode::kOn ? actuators_.vehicle() : actuators_.usual_vehicle();
  fallback_.set_vehicle(vehicle);
  model_.set_vehicle(vehicle);
  filter_.set_vehicle(vehicle);
  estimator_.set_model(model_);
}

model::Command Guard::step(const model::Measurement& measured, Deadline deadline, const Cycle& cycle,
                           controller::StepResult& result) noexcept {
  adopt_learned_answer();
  if (commanded_.is_empty()) begin_with({measured.steer, measured.throttle}, measured.time);
  model::Measurement now = measured;
  now.delay = std::max(now.delay + learned_.answer().delay, 0.0);
  const bool is_off = options_.mode == GuardMode::kOff;
  // A guard that is on learns from what the monitor leaves, in watch_actuators(); any other from what its
  // controller gets.
  if (options_.mode != GuardMode::kOn) learned_.see(now, commanded_);
  // After a person has driven, doubts of before hold no more: the guard begins again at this place.
  const bool is_handed_back = std::exchange(run_.is_by_hand, cycle.manual.has_value()) && !cycle.manual;
  if (is_handed_back && Supervisor::wants_trial(monitor_.findings())) {
    begin_here();
    monitor_.reset(/*forgets_lateness=*/true);
  }
  const model::Measurement& seen = is_off ? now : take_in(now);
  result = controller_->step(seen, deadline);
  watch_answer(seen, result.answer != Answer::kNone);
  report_ = {};
  report_learned(result.report.learned);
  clamp_sizes(result.plan);
  if (!is_finite(result.command)) result.answer = Answer::kNone;
  choose(seen, cycle, result);
  const model::Command asked = result.command;
  if (options_.mode == GuardMode::kOn && !cycle.manual) {
    free_stuck_car(seen.time, cycle, result);
    watch_rest(seen.time, result.command.throttle);
    result.command = limited(result.command, cycle.interval);
  }
  send(cycle, asked, result);
  return asked;
}

/// Begins the history of commands with the one in the telemetry, which acts until the run's first one does.
void Guard::begin_with(const model::Command& acting, double time) noexcept {
  const bool is_plausible =
      std::fabs(acting.steer) <= vehicle_.steer_limit && std::fabs(acting.throttle) <= 1.0;
  if (!is_plausible || !std::isfinite(time)) return;
  commanded_.add(time, acting);
  sent_.add(time, answer_.effect_of(acting));
}

/// Compensates the actuators' deviation, limits range and rate, and notes what is sent.
void Guard::send(const Cycle& cycle, const model::Command& asked, controller::StepResult& result) noexcept {
  const model::Command commanded = answer_.command_for(result.command);
  result.command = gate_.pass(cycle.manual.value_or(commanded), cycle.interval);
  report_.gated = result.command != cycle.manual.value_or(commanded) ||
                  result.command != cycle.manual.value_or(answer_.command_for(asked));
  const model::Command effect = answer_.effect_of(result.command);
  controller_->note_sent(effect);
  if (!std::isfinite(sent_from_)) return;
  commanded_.add(sent_from_, result.command);
  sent_.add(sent_from_, effect);
  if (answer_.is_usual()) return;
  stop_ = filter_.stop();
  for (int i = 0; i < stop_.size; ++i) {
    StopPoint& point = stop_.points[static_cast<std::size_t>(i)];
    point.command = answer_.command_for(point.command);
    point.time -= std::min(answer_.delay, 0.0);  // a negative delay: the stop begins with the next command
  }
}

/// Updates the deviation that commands compensate, and the effects of past commands with it.
void Guard::update_answer() noexcept {
  constexpr ActuatorAnswer kUsual;
  const ActuatorAnswer& watched = options_.mode == GuardMode::kOn ? actuators_.answer() : kUsual;
  answer_ = watched.after(learned_.answer());
  sent_ = commanded_.changed([this](const model::Command& command) { return answer_.effect_of(command); });
}

/// Adopts the newly estimated deviation of the actuators, and begins to search for changes beyond it again.
/// Runs in each mode, so that GuardMode::kObserve reports what kOn would do.
void Guard::adopt_learned_answer() noexcept {
  if (!plans_with_car(*controller_)) return;
  const double delay = learned_.answer().delay;
  if (!learned_.take_up()) return;
  commanded_.delay(learned_.answer().delay - delay);
  actuators_.reset();
  update_answer();
  update_model_vehicle();
}

void Guard::report_learned(controller::LearnedCar& learned) const noexcept {
  const controller::Estimate grip = learned.grip;
  learned = learned_.learned();
  if (std::isfinite(grip.value)) learned.grip = grip;
}

/// Estimates how the actuators answer. Measurements with findings are left out.
void Guard::watch_actuators(const model::Measurement& seen) noexcept {
  if (monitor_.findings() != Findings{} || direction_.rolls_back()) return actuators_.skip();
  const ActuatorAnswer before = actuators_.answer();
  if (options_.mode == GuardMode::kOn) learned_.see(seen, commanded_);
  ActuatorWatch::AxleUse use;
  const model::State& car = estimator_.state();
  if (estimator_.is_started() && car.vx > kRollsBackAtMost) {
    const auto tires = model_.tire_use(model::BodyMotion<double>{car.vx, car.vy, car.r, car.steer, 0.0});
    use = {tires.front, tires.rear, car.vy / car.vx};
  }
  actuators_.see(
      seen, commanded_.changed([&](const auto& command) { return learned_.answer().effect_of(command); }),
      use);
  if (actuators_.answer() != before) update_answer();
  if (actuators_.answer().braking != before.braking) update_model_vehicle();
}

/// Gives the plausible part of a measurement to estimate and road, and returns it.
const model::Measurement& Guard::take_in(const model::Measurement& measured) noexcept {
  watch_for_reset(measured);
  std::optional<model::State> expected;
  const bool rolled_back = direction_.rolls_back();
  if (estimator_.is_started() && std::isfinite(measured.time) && !rolled_back)
    expected = estimator_.predict(measured.time, sent_).state;
  // A heading that jumped does not show the direction of travel.
  model::Measurement course = measured;
  if (expected && std::fabs(angle_difference(measured.psi, expected->psi)) > MeasurementMonitor::kHeadingJump)
    course.psi = std::numeric_limits<double>::quiet_NaN();
  // A car that surely drives forward does not roll back in the next cycle, and a frozen sensor does not show
  // it.
  const bool goes_on = expected && monitor_.is_sure() && expected->vx > kRollsBackAtMost;
  if (!goes_on && !monitor_.findings().frozen) direction_.see(course);
  // The estimator has no model of rolling back: it begins again when the direction changes.
  if (direction_.rolls_back() != rolled_back) {
    estimator_.reset();
    monitor_.reset();
    expected.reset();
  }
  const model::Measurement& seen = monitor_.check(measured, expected ? &*expected : nullptr);
  // The waypoints of a place in doubt are in doubt, too: the stop needs the road that was known.
  if (options_.mode != GuardMode::kOn || !monitor_.findings().position_jump) road_.add(seen);
  adopt_line();
  watch_actuators(seen);
  estimator_.correct(seen, sent_);
  if (expected) note_residual(*expected, seen.time);
  return options_.mode == GuardMode::kOn ? seen : measured;
}

/// Difference between the estimate and its prediction for this measurement (eq. 5c).
void Guard::note_residual(const model::State& expected, double time) noexcept {
  const model::State& now = estimator_.state();
  const auto [sine, cosine] = sine_cosine(now.psi);
  const double v = std::max(now.vx, kRollsBackAtMost);
  filter_.note_residual({.beside = (now.y - expected.y) * cosine - (now.x - expected.x) * sine,
                         .course = angle_difference(now.psi, expected.psi) + (now.vy - expected.vy) / v,
                         .yaw_rate = now.r - expected.r,
                         .speed = now.vx - expected.vx},
                        time);
}

void Guard::choose(const model::Measurement& seen, const Cycle& cycle,
                   controller::StepResult& result) noexcept {
  sent_from_ = seen.time + seen.delay;
  filter_.begin_cycle(cycle.interval, cycle.longest);
  const bool has_answer = result.answer != Answer::kNone;
  if (options_.mode == GuardMode::kOff || cycle.manual) {
    filter_.forget();
    return has_answer ? accept(seen, result) : fall_back(seen, result);
  }

  const Supervisor::Verdict verdict = supervisor_.judge(monitor_.findings(), seen.time);
  const std::optional<StopStart> start = place_on_road(sent_from_);
  watch_course(start);
  report_.reason = verdict.reason;
  if (!verdict.must_stop && actuators_.has_other_steering()) report_.reason = GuardReason::kOtherSteering;
  if (!verdict.must_stop && actuators_.has_weak_brakes()) report_.reason = GuardReason::kWeakBrakes;
  if (!has_answer && !verdict.must_stop) report_.reason = GuardReason::kNoAnswer;

  // Without a road, or an estimate, there is nothing to check against: the answer is sent.
  bool is_allowed = has_answer && !verdict.must_stop;
  if (is_allowed && start) is_allowed = may_send(*start, cycle, result);
  if (options_.mode == GuardMode::kObserve)
    return has_answer ? accept(seen, result) : fall_back(seen, result);
  // A controller that leaves a refused or led car standing does not get it back: the car is led on.
  run_.is_idle = has_answer && idles(result);
  const bool is_kept = run_.refused.lasts(seen.time) > kStuckTime || run_.is_led;
  if (is_allowed && !run_.is_astray && !(run_.is_idle && is_kept)) {
    // One accepted command does not move a car that stands.
    if (!run_.is_idle && !stands()) {
      run_.is_led = run_.creeps = run_.goes_round = false;
      run_.refused.at = seen.time;
    }
    return accept(seen, result);
  }
  if (verdict.must_stop && (start || run_.is_far) && try_reset(start, cycle, seen.time, result)) return;
  if (!verdict.must_stop && should_lead_back(seen.time, has_answer) && lead_back(sent_from_, cycle, result))
    return;
  if (run_.is_far && !verdict.must_stop) report_.reason = GuardReason::kFarFromRoad;
  if (!start || !drive_stop(*start, result)) fall_back(seen, result);
  // What brakes a car that goes forward may be the reverse gear of one that rolls back.
  if (direction_.rolls_back() && result.command.throttle < 0.0) {
    result.command.throttle = against_rolling_back();
    filter_.withdraw_stop();
  }
}

/// Whether the answer may be sent, after slow_down() where only a closed-loop stop follows it. Sets the
/// reason.
bool Guard::may_send(const StopStart& start, const Cycle& cycle, controller::StepResult& result) noexcept {
  const Fit fit = verify(start, cycle, result.command);
  if (fit == Fit::kOpen) return true;
  report_.reason = GuardReason::kTooFastForSilence;  // unless nothing can be sent, below
  if (fit == Fit::kSeen && (options_.mode == GuardMode::kObserve || slow_down(start, cycle, result)))
    return true;
  report_.reason = GuardReason::kNoWayToStop;
  return false;
}

/// Searches for a stop after the command that the gate would send.
Fit Guard::verify(const StopStart& start, const Cycle& cycle, const model::Command& command,
                  bool is_led) noexcept {
  return filter_.verify({.road = road_,
                         .start = start,
                         .command = limited(command, cycle.interval),
                         .interval = cycle.interval,
                         .is_led = is_led,
                         .longest = cycle.longest,
                         .acting = sent_.at(start.time)},
                        report_);
}

/// The controller steers; the pedal is limited to gentle braking. False where no stop follows that either.
bool Guard::slow_down(const StopStart& start, const Cycle& cycle, controller::StepResult& result) noexcept {
  model::Command slower = result.command;
  const double slowing = filter_.planner().slowing(road_, start, PredictiveFilter::kGentle);
  slower.throttle = std::min(slower.throttle, throttle_for(model_.vehicle(), slowing, start.body.vx));
  if (slower.throttle < result.command.throttle && verify(start, cycle, slower) == Fit::kNone) return false;
  result.command = slower;
  return true;
}

/// The command inside range and rate. It has no reverse gear, because a stop ends in standstill, and no drive
/// beyond the speed up to which the car's parameters hold, because no stop can be computed from there.
model::Command Guard::limited(const model::Command& command, double interval) const noexcept {
  const model::Command commanded = answer_.command_for(command);
  const model::Command gated = gate_.limited(commanded, interval);
  model::Command inside = gated == commanded ? command : answer_.effect_of(gated);
  const model::VehicleParams& car = model_.vehicle();
  const double v = act_speed_;
  if (inside.throttle > 0.0) {
    const double most = throttle_for(car, std::min(most_drive_, drive_to_valid_speed(car, v)), v);
    inside.throttle = std::min(inside.throttle, std::max(most, 0.0));
  }
  if (car.latches_brakes() && inside.throttle == car.brake_release_throttle) return inside;
  if (run_.rests && car.reverse_speed > 0.0) inside.throttle = std::max(inside.throttle, 0.0);
  if (v < car.reverse_speed && inside.throttle < 0.0) {
    const double most = std::min(car.reverse_acceleration, v / std::max(interval, model::kRestTime));
    inside.throttle = std::max(inside.throttle, throttle_to_rest(car, -most, v));
  }
  return inside;
}

/// Accepts the controller's answer, and gives its plan to the fallback.
void Guard::accept(const model::Measurement& seen, controller::StepResult& result) noexcept {
  const bool stops = result.answer == Answer::kStopOnRoad;
  report_.rung = stops ? Rung::kStopOnRoad : Rung::kReturnToRoad;
  if (stops || result.answer == Answer::kReturnToRoad) return;
  report_.rung = Rung::kController;
  if (result.plan.size > 0) {
    fallback_.accept(result.plan);
  } else {
    fallback_.accept(result.command, sent_from_, seen.speed);
  }
}

void Guard::fall_back(const model::Measurement& seen, controller::StepResult& result) noexcept {
  const Fallback::Answer answer = fallback_.command(sent_from_, seen);
  take_over(answer.command, answer.rung, result);
}

/// The guard's own command, without the controller's plan.
void Guard::take_over(const model::Command& command, Rung rung, controller::StepResult& result) noexcept {
  result.answer = Answer::kNone;
  result.command = command;
  result.plan.size = result.plan.reference_size = 0;
  report_.rung = rung;
}

/// Sends the stored stop; false where there is none.
bool Guard::drive_stop(const StopStart& start, controller::StepResult& result) noexcept {
  const bool is_open = monitor_.findings().is_blind();
  const bool is_measured = !is_open && report_.reason == GuardReason::kNoWayToStop;
  if (!filter_.drive(road_, start, is_open, is_measured, report_)) return false;
  take_over(filter_.stop().points[0].command, Rung::kGuardStop, result);
  show_stop(start, result.plan);
  return true;
}

/// Writes the stored stop as a plan, for viewers.
void Guard::show_stop(const StopStart& start, controller::Plan& plan) const noexcept {
  const road::ReferenceLine& line = road_.line();
  StopStart at = start;
  double edge = 0.0, driven = 0.0;
  while (plan.size < kShown) {
    const double speed = hypot(at.body.vx, at.body.vy);
    const model::Command command = played(filter_.stop(), driven, speed, model_.vehicle());
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
    at = filter_.planner().advance(road_, at, command, kShownStep, edge);
  }
  plan.reference_size = plan.size;
}

}  // namespace chicane::safety
