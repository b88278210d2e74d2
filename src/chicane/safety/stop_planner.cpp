// SPDX-License-Identifier: MIT
#include "chicane/safety/stop_planner.hpp"

#include <array>
#include <cstddef>

#include "chicane/base/math.hpp"
#include "chicane/base/pack.hpp"
#include "chicane/model/stability.hpp"

namespace chicane::safety {
namespace {

// Origins (chosen: by trial, see Guard):
// - Derived: kDamping (5 % of overshoot), kLapDamping (none), kSpeedTime (the receiver's), kSlipShift (a
//   central difference far below any peak), kMostOffset (Guard's kFarFromRoad), kGravity, kRounded,
//   kCreepStop (model::kRestTime and the lag of the drive), kLongestRound (2π times udacity's radius of 6.4 m
//   at kCreep).
// - Measured: kFrictionDoubt (eq. 5b), kStiffnessDoubt (of the size that `identify` leaves: 1.3 and 1.8 %,
//   docs/identification.md), kYawRateDoubt, kHeadingDoubt (two deviations of the residuals of `default` on
//   lakeside, seven cars: 0.006 rad/s and 0.0017 rad at most).
// - Chosen, docs/guard.md: kPreview, kYawBandwidth, kMostPerMetre (eq. 3), kGripShare (eq. 4: a reserve of
//   15 %), kBeyond, kKept (eq. 4a), kForeseenUse, kHorizon (eq. 5: braking from 60 m/s), kDoubtWithWheels
//   (eq. 5b), kSlow (eq. 3b), kMostSlide, kSlideGrows ("A spin is no stop"), kLongestCreep, kCreepNearer
//   (eq. 6c).
// - Chosen: kStanding (below Guard's), kLeastBraking (a car in a bend has to stop, too), kStride (two
//   cars), kTurns, kLeastShrink, kLeastTurning (divisors above 0).
constexpr double kStanding = 0.3;  // [m/s] slower than that the car counts as standing
constexpr double kSlow = 3.0;      // [m/s] below which its turning is corrected
constexpr double kDamping = 0.7;
constexpr double kLapDamping = 1.0;        // the same to a planned lap: no room to overshoot it
constexpr double kYawBandwidth = 6.0;      // [rad/s] of the feedback to the yaw rate
constexpr double kPreview = 0.15;          // [s] the car answers the wheel about so late
constexpr double kGripShare = 0.85;        // of the assumed tyre force of the rear axle, used sideways
constexpr double kGravity = 9.81;          // [m/s²]
constexpr double kBeyond = 0.3;            // share of grip asked beyond kGripShare: no car follows the bend
constexpr double kKept = 0.5;              // share of that grip kept sideways in such a bend
constexpr double kLeastBraking = 0.15;     // of the useful one, in any curve
constexpr double kMostPerMetre = 0.25;     // [1/m] of the feedback: ω/v of a slow car
constexpr int kTurns = 3;                  // of the search for a stable deceleration
constexpr double kSlipShift = 2e-3;        // [rad] to either side, for slopes of the axles' forces
constexpr double kStiffnessDoubt = 0.015;  // of the rear axle's
constexpr double kFrictionDoubt = 0.02;    // of the friction
constexpr double kYawRateDoubt = 0.007;    // [rad/s]
constexpr double kHeadingDoubt = 0.002;    // [rad]
constexpr double kDoubtWithWheels = 0.6;   // of these, where the car is simulated with its four wheels
constexpr double kForeseenUse = 0.55;      // of the grip, in the bends ahead
constexpr double kStride = 10.0;           // [m] between the places ahead
constexpr double kHorizon = 200.0;         // [m]
constexpr double kSpeedTime = 0.4;         // [s] in which a planned speed is met again
constexpr double kMostSlide = 0.35;        // [rad] of slip: a car that slides more spins, by no model known
constexpr double kSlideGrows = 0.1;        // [rad] by which one that slides more already may slide further
constexpr double kLeastShrink = 0.2;       // of 1 − κ d, near the centre of a bend
constexpr double kLeastTurning = 0.02;     // [1/m] of a car that turns back along the road
constexpr double kCreepStep = 0.2;         // [s] of creeping that are simulated at once
constexpr double kCreepStop = 0.6;         // [s] of creeping: more than the way of a stop from that pace
constexpr double kLongestCreep = 6.0;      // [s]
constexpr double kLongestRound = 40.0;     // [s] a turn at full lock
constexpr double kCreepNearer = 5e-3;      // [m] by which a car may come nearer to the edge, or over it
constexpr double kRounded = 1e-6;          // [m] more than the rounding of a bound
constexpr double kMostOffset = 20.0;       // [m] beside the line the stop is given up

/// Where the known road ends for a stop from `start` on [m]: a closed road after a lap.
double end_of(const road::KnownRoad& road, const StopStart& start) noexcept {
  return road.line().is_closed() ? start.s + road.line().length() : road.end();
}

/// Below kSpeedFloor that of the wheels: the model moves a car that stands with its wheels turned aside.
double speed_of(const model::BodyMotion<double>& body) noexcept {
  const double speed = hypot(body.vx, body.vy);
  return speed < model::PredictionModel::kSpeedFloor ? body.vx : speed;
}

/// How far the car's course is off its heading [rad], where slip angles say something.
double slide(const model::BodyMotion<double>& body) noexcept {
  return hypot(body.vx, body.vy) > kSlow ? std::fabs(atan2(body.vy, body.vx)) : 0.0;
}

/// Whether slide() is more than `most` >= kMostSlide; atan x <= x spares most cars the angle itself.
bool slides_more(const model::BodyMotion<double>& body, double most) noexcept {
  return !(std::fabs(body.vy) < 0.99 * kMostSlide * body.vx) && slide(body) > most;
}

}  // namespace

void StopPlanner::set_vehicle(const model::VehicleParams& vehicle) noexcept {
  model_.set_vehicle(vehicle);
  car_.set_vehicle(vehicle);
  friction_ = vehicle.cornering_friction();
  model::VehicleParams other = vehicle;
  doubt_ = car_.has_wheels() ? kDoubtWithWheels : 1.0;
  other.friction = (1.0 - kFrictionDoubt) * vehicle.friction;
  other.cornering_rear = (1.0 - doubt_ * kStiffnessDoubt) * vehicle.cornering_rear;
  softer_.set_vehicle(other);
  other.cornering_rear = (1.0 + doubt_ * kStiffnessDoubt) * vehicle.cornering_rear;
  stiffer_.set_vehicle(other);
}

/// Two cars that begin to either side of `start`, each driven by what `command_at` returns for a car, a step,
/// a place, the distance driven [m] and the speed [m/s]. Step by step in turn: the processor computes one
/// while the other waits.
template <class Law>
DoubtCheck StopPlanner::in_doubt(const road::KnownRoad& road, const StopStart& start, const Doubt& doubt,
                                 double time, double least, double enough,
                                 const Law& command_at) const noexcept {
  const double reach = steer_reach(kStep);
  const StopCar::Step step = car_.step(kStep);
  const double end = end_of(road, start);
  // Open loop nobody sees what comes behind the line: (6b).
  const double seen = time > 0.0 && !road.line().is_closed() ? road.line().length() : end;
  const double most_slide = std::max(kMostSlide, slide(start.body) + kSlideGrows);
  struct Car {
    const StopCar& car;
    StopStart at;
    Here here;
    double speed = 0.0, driven = 0.0;
    bool drives = true;
  };
  DoubtCheck check{.edge_for = enough, .edge = enough};
  const Here here = road.here(start.s);
  std::array<Car, 2> cars{{{softer_, start, here}, {stiffer_, start, here}}};
  for (std::size_t k = 0; k < cars.size(); ++k) {
    const double inwards = std::copysign(k == 0 ? 1.0 : -1.0, start.body.r);
    StopStart& at = cars[k].at;
    at.d += inwards * doubt.beside;
    at.e += inwards * (doubt_ * kHeadingDoubt + doubt.course);
    at.body.r += inwards * (doubt_ * kYawRateDoubt + doubt.yaw_rate);
    at.body.vx += doubt.speed;
    cars[k].speed = speed_of(at.body);
    cars[k].drives = cars[k].speed >= kStanding;
  }
  for (int i = 0; i < kStepsPerPoint * StopPlan::kCapacity && (cars[0].drives || cars[1].drives); ++i) {
    for (std::size_t k = 0; k < cars.size(); ++k) {
      Car& each = cars[k];
      if (!each.drives) continue;
      const double before = each.speed;
      move(each.car, each.here, each.at, command_at(k, i, each.at, each.here, each.driven, before), step,
           reach);
      each.here = road.here(each.at.s);
      each.speed = speed_of(each.at.body);
      each.driven += 0.5 * kStep * (before + each.speed);
      const double now = least_edge(road, each.at, each.here, std::min(enough, seen - each.at.s));
      check.edge = std::min(check.edge, now);
      if (each.at.time < start.time + time + 0.5 * kStep) check.edge_for = std::min(check.edge_for, now);
      if (now < least) check.speed = std::max(check.speed, each.speed);
      check.stands &= now >= least && !slides_more(each.at.body, most_slide) && each.at.s < end;
      each.drives = now >= least && each.speed >= kStanding;
    }
    if (!check.stands && !(time > 0.0)) break;  // nothing more is asked
  }
  check.stands &= !cars[0].drives && !cars[1].drives;
  return check;
}

DoubtCheck StopPlanner::plan_in_doubt(const road::KnownRoad& road, const StopStart& start,
                                      const Policy& policy, const Doubt& doubt, double least) const noexcept {
  std::array<model::Command, 2> held;
  const int steps = held_steps(policy);
  return in_doubt(road, start, doubt, 0.0, least, least,
                  [&](std::size_t k, int i, const StopStart& at, const Here& here, double, double) {
                    if (i % steps == 0) held[k] = command(road, at, here, policy);
                    return held[k];
                  });
}

DoubtCheck StopPlanner::played(const road::KnownRoad& road, const StopStart& start, const StopPlan& stop,
                               double time, double enough) const noexcept {
  std::array<int, 2> point{};
  return in_doubt(road, start, {}, time, 0.0, enough,
                  [&](std::size_t k, int, const StopStart&, const Here&, double driven, double speed) {
                    return safety::played(stop, driven, speed, model_.vehicle(), &point[k]);
                  });
}

/// The lesser of `least` and the distance of the outermost contact patch to the edge, on a road that is an
/// arc between the axles (eq. 1a). A car that is far enough from the edge by a bound of (1a) needs no more:
/// by |sin e| <= |e|, and with axles no farther along the road than twice their distance, where |κ y| <= 1/2.
double StopPlanner::least_edge(const road::KnownRoad& road, const StopStart& at, const Here& here,
                               double least) const noexcept {
  const model::VehicleParams& car = model_.vehicle();
  const double half_track = 0.5 * (car.track_width + car.tire_width), curvature = here.curvature;
  const double axle = std::max(car.front_axle, car.rear_axle), bend = std::fabs(curvature);
  if (bend * (std::fabs(at.d) + axle) <= 0.5 && 2.0 * axle <= road::KnownRoad::kReach) {
    const double nearer = std::fabs(at.e) * axle + bend * axle * axle + half_track;
    const double room = std::min(here.narrowest.left - at.d, here.narrowest.right + at.d);
    if (room - nearer > least + kRounded) return least;
  }
  const auto [sine, cosine] = sine_cosine(at.e);
  const double beside = half_track * cosine;
  for (const double x : {car.front_axle, -car.rear_axle}) {
    const double across = at.d + x * sine;
    const double along = x * cosine / std::max(1.0 - curvature * across, kLeastShrink);
    const double middle = across - 0.5 * curvature * along * x * cosine;
    const road::KnownRoad::Edges edges = road.edges(at.s + along);
    least = std::min({least, edges.left - middle - beside, edges.right + middle - beside});
  }
  return least;
}

double StopPlanner::turning_room(const road::KnownRoad& road, const StopStart& at) const noexcept {
  const model::VehicleParams& car = model_.vehicle();
  const double length = car.wheelbase();
  const double side = at.e < 0.0 ? -1.0 : 1.0;
  const double bend = side * road.line().demand(at.s).curvature;  // the road turns away, or after the car
  const double radius = 1.0 / std::max(car.steer_limit / length + bend, kLeastTurning);
  const double outside = radius + 0.5 * (car.track_width + car.tire_width);
  const double now = outside * cos(at.e) + length * side * sin(at.e);  // the front wheel, from the centre
  const road::KnownRoad::Edges edges = road.edges(at.s);
  const double farther = side * (edges.left - edges.right - 2.0 * at.d);  // the edge that it turns along
  if (!(std::fabs(at.e) > atan2(length, outside))) return 0.0;
  return std::max(hypot(outside, length) - now - std::max(farther, 0.0), 0.0);
}

/// That of a car that moves like `m` and brakes, with the slopes of the axles' forces at their slip angles.
double StopPlanner::instability(const model::BodyMotion<double>& m, double deceleration) const noexcept {
  using Both = Pack<arch::Baseline, 2>;  // slip angles more and less by kSlipShift, together
  const model::VehicleParams& car = model_.vehicle();
  const double v = std::max(m.vx, 1.0);
  Both vy = m.vy + kSlipShift * v;
  vy.set(1, m.vy - kSlipShift * v);
  const model::PredictionModel::Change<Both> change =
      model_.change(model::BodyMotion<Both>{m.vx, vy, m.r, m.steer, -deceleration});
  const double force = (change.vy[1] - change.vy[0]) / (2.0 * kSlipShift);
  const double moment = car.yaw_inertia / car.mass * (change.r[1] - change.r[0]) / (2.0 * kSlipShift);
  const double front = (car.rear_axle * force + moment) / car.wheelbase();
  const double rear = (car.front_axle * force - moment) / car.wheelbase();
  return model::static_instability(car, v, {front, rear});
}

/// Share of a deceleration that leaves the car as stable as asked (5). `at_all`: instability() with all of
/// it.
double StopPlanner::stable_share(const model::BodyMotion<double>& m, double deceleration, double stability,
                                 double at_all) const noexcept {
  const double most = 1.0 / stability;
  if (!(stability > 0.0) || at_all <= most) return 1.0;
  double high = 1.0, at_high = at_all;
  double low = kLeastBraking, at_low = instability(m, low * deceleration);
  if (at_low >= most) return low;
  // It rises nearly in a line with the deceleration, but for where the rear axle begins to slide.
  for (int i = 0; i < kTurns; ++i) {
    const double along = (most - at_low) / (at_high - at_low);
    const double middle = low + (std::isfinite(at_high) ? std::clamp(along, 0.1, 0.9) : 0.5) * (high - low);
    const double at_middle = instability(m, middle * deceleration);
    (at_middle <= most ? low : high) = middle;
    (at_middle <= most ? at_low : at_high) = at_middle;
  }
  return low;
}

/// The acceleration sideways [m/s²] that braking leaves where the bend asks for `bend` and the yaw rate for
/// `turning`: the larger, up to the force of the rear axle. In a bend that no car follows the brakes take
/// half of that force at most, but nothing of what turns the car faster than the bend (eq. 4a).
double StopPlanner::left_sideways(double bend, double turning, double v) const noexcept {
  const double most = kGripShare * friction_ * model_.load(v);
  const double beyond = std::clamp((bend / most - 1.0) / kBeyond, 0.0, 1.0);
  const double given_up = bend - std::min(bend, (1.0 - (1.0 - kKept) * beyond) * most);
  return std::min(std::max(bend, turning) - given_up, most);
}

/// Share of a deceleration that leaves the rear axle, unloaded by it, the force that holds the car sideways:
/// equation 4.
double StopPlanner::braking_share(double sideways, double deceleration, double v) const noexcept {
  const model::VehicleParams& car = model_.vehicle();
  const double grip = friction_ * model_.load(v);
  const double drag = -longitudinal_acceleration(car, 0.0, v);  // as if it took nothing of the tyres
  const auto holds = [&](double a) {
    const double along = std::clamp((a - drag) / grip, 0.0, 1.0);
    const double ellipse = std::sqrt(std::max(1.0 - car.friction_coupling * along * along, 0.0));
    const double load = std::max(1.0 - car.height * a / (kGravity * car.front_axle), 0.0);
    return kGripShare * grip * ellipse * load >= sideways;
  };
  if (holds(deceleration)) return 1.0;
  double low = kLeastBraking, high = 1.0;
  for (int i = 0; i < 6; ++i) {
    const double middle = 0.5 * (low + high);
    (holds(middle * deceleration) ? low : high) = middle;
  }
  return low;
}

model::Command StopPlanner::command(const road::KnownRoad& road, const StopStart& at, const Here& here,
                                    const Policy& policy) const noexcept {
  const model::VehicleParams& car = model_.vehicle();
  const double v = std::max(at.body.vx, 1.0);
  const Curvatures curvatures = curvatures_of(road, at, here, policy);
  // The wheel that gives the yaw rate this asks for, by the model: a braking car oversteers.
  const double yaw_acceleration = kYawBandwidth * (v * curvatures.wanted - at.body.r);
  const double steer =
      std::clamp(model_.steer_for(at.body, yaw_acceleration), -car.steer_limit, car.steer_limit);
  if (!(at.time < policy.until) || !road.is_raced()) {
    const double most = at.body.vx / policy.hold;  // held beyond standstill it would be the reverse gear
    const double braking = std::max(slowing(road, at, policy.braking, curvatures), -most);
    return {steer, throttle_to_rest(car, braking, at.body.vx)};
  }
  return {steer, std::max(throttle_for(car, raced_slowing(road, at), v), lowest_throttle(car, v))};
}

/// What is wanted brings the car towards the middle of the road, where there is most room on both sides, or
/// to the line that is raced by.
StopPlanner::Curvatures StopPlanner::curvatures_of(const road::KnownRoad& road, const StopStart& at,
                                                   const Here& here, const Policy& policy) const noexcept {
  const model::VehicleParams& car = model_.vehicle();
  const double v = std::max(at.body.vx, 1.0);
  const double ahead = road.line().demand(at.s + (kPreview + 0.5 * policy.hold) * v).curvature;
  const double course = at.e + at.body.vy / v;
  const double beside =
      at.d - road.target(road.edges(at.s), 0.5 * (car.track_width + car.tire_width) + policy.room);
  const double damping = road.is_raced() ? kLapDamping : kDamping;
  return {
      .here = here.curvature, .ahead = ahead, .wanted = ahead + back_to(beside, course, v, policy, damping)};
}

double StopPlanner::slowing(const road::KnownRoad& road, const StopStart& at, const Braking& braking,
                            const Curvatures& curvatures) const noexcept {
  const model::VehicleParams& car = model_.vehicle();
  const double v = std::max(at.body.vx, 1.0);
  const double bend =
      std::max({std::fabs(curvatures.ahead), std::fabs(curvatures.wanted), std::fabs(curvatures.here)});
  const double by_tyres = 1.0 - car.steer_helper;
  const double sideways = left_sideways(by_tyres * (bend * v * v), by_tyres * (std::fabs(at.body.r) * v), v);
  const double raced = raced_slowing(road, at);
  const double useful = longitudinal_acceleration(car, lowest_throttle(car, v), v);
  const double asked = useful * braking.share;
  const double held = braking_share(sideways, -asked, v);
  const double at_all = braking.stability > 0.0 ? instability(at.body, -asked) : 0.0;
  const double stable = std::min(held, stable_share(at.body, -asked, braking.stability, at_all));
  if (!(braking.foreseen < braking.stability) || stable >= held) return std::min(asked * stable, raced);
  const double wanted = foreseen(road, at, -asked) / -asked;
  if (wanted <= stable) return std::min(asked * stable, raced);
  return std::min(asked * std::clamp(wanted, stable,
                                     std::min(held, stable_share(at.body, -asked, braking.foreseen, at_all))),
                  raced);
}

/// The acceleration [m/s²] that brings the car to the planned lap's speed: a car that drives its line more
/// slowly needs less grip everywhere. Infinite where no lap is raced by.
double StopPlanner::raced_slowing(const road::KnownRoad& road, const StopStart& at) const noexcept {
  if (!road.is_raced()) return std::numeric_limits<double>::infinity();
  const road::ReferenceLine::Demand demand = road.line().demand(at.s);
  return demand.speed * demand.speed_slope + (demand.speed - at.body.vx) / kSpeedTime;
}

/// The deceleration [m/s²], no more than `most`, that brings the car to the bends ahead at a speed at which
/// they use no more than kForeseenUse of its grip.
double StopPlanner::foreseen(const road::KnownRoad& road, const StopStart& at, double most) const noexcept {
  const double v = std::max(at.body.vx, 1.0);
  const double grip = kForeseenUse * friction_ * model_.load(v) / (1.0 - model_.vehicle().steer_helper);
  double wanted = 0.0;
  for (double x = kStride; x < kHorizon && wanted < most; x += kStride) {
    const double curvature = std::fabs(road.line().demand(at.s + x).curvature);
    wanted = std::max(wanted, (v * v - grip / std::max(curvature, 1e-6)) / (2.0 * x));
  }
  return std::min(wanted, most);
}

/// Moves a car by `step` where the line has the curvature `here` [1/m].
void StopPlanner::move(const StopCar& car, const Here& here, StopStart& at, const model::Command& command,
                       const StopCar::Step& step, double steer_reach) noexcept {
  const double dt = step.dt;
  const double steer = std::clamp(command.steer, at.body.steer - steer_reach, at.body.steer + steer_reach);
  const double asked = longitudinal_acceleration(car.vehicle(), command.throttle, at.body.vx);
  StopMotion moved = car.advance({at.body, at.load_along, at.load_across, at.behind_front, at.behind_rear},
                                 steer, asked, step);
  model::BodyMotion<double>& to = moved.body;
  to.vx = std::max(to.vx, 0.0);
  const double vx = 0.5 * (at.body.vx + to.vx);
  // The model turns a car that stands with its wheels turned as if it rolled with kSpeedFloor.
  const double rolls = vx < kSlow ? vx / hypot(vx, model::PredictionModel::kSpeedFloor) : 1.0;
  const double vy = rolls * 0.5 * (at.body.vy + to.vy);
  const double turned = rolls * 0.5 * dt * (at.body.r + to.r);
  const double shrink = std::max(1.0 - here.curvature * at.d, kLeastShrink);
  const double e = at.e + 0.5 * turned - 0.5 * dt * here.curvature * vx / shrink;
  const auto [sine, cosine] = sine_cosine(e);
  const double along = dt * (vx * cosine - vy * sine) / shrink;
  at.s += along;
  at.d += dt * (vx * sine + vy * cosine);
  at.e += turned - here.curvature * along;
  at.body = to;
  at.load_along = moved.load_along;
  at.load_across = moved.load_across;
  at.behind_front = moved.behind_front;
  at.behind_rear = moved.behind_rear;
  at.time += dt;
}

/// How far the wheel asked for may be from the wheel in a step of dt [s], behind its lag [rad].
double StopPlanner::steer_reach(double dt) const noexcept {
  return model_.vehicle().steer_rate_limit * dt / (1.0 - model_.lags(dt).steer.end);
}

StopStart StopPlanner::advance(const road::KnownRoad& road, const StopStart& from,
                               const model::Command& command, double time,
                               double& least_edge) const noexcept {
  const int steps = std::max(1, static_cast<int>(std::ceil(time / kStep)));
  const double dt = time / steps;
  const double reach = steer_reach(dt);
  const StopCar::Step step = car_.step(dt);
  StopStart at = from;
  Here here = road.here(at.s);
  for (int i = 0; i < steps; ++i) {
    move(car_, here, at, command, step, reach);
    here = road.here(at.s);
    least_edge = this->least_edge(road, at, here, least_edge);
  }
  return at;
}

bool StopPlanner::creeps_inside(const road::KnownRoad& road, StopStart at, const Arc& arc) const noexcept {
  at.body.steer = arc.steer;
  const double from = edge(road, at), kept = std::min(from, kCreepNearer) - kCreepNearer;
  const double stops = at.time + arc.hold + kCreepStop;
  const double ends = at.time + (arc.goes_round ? kLongestRound : kLongestCreep);
  const double side = std::copysign(1.0, arc.steer), off = side * angle_difference(at.e, 0.0);
  double least = from, later = from, to_turn = off < 0.0 ? -off : arc.goes_round ? kTwoPi - off : 0.0;
  do {
    const double before = at.e;
    at = advance(road, at, creep(arc.steer, at.body.vx), kCreepStep, at.time < stops ? least : later);
    to_turn -= side * angle_difference(at.e, before);
  } while (at.time < ends && to_turn > 0.0 && (arc.goes_round || !(edge(road, at) > from)));
  return (!arc.goes_round || to_turn <= 0.0) && std::min(least, later + arc.doubt) > kept;
}

/// The curvature that brings a car back that is `beside` its place [m] and has another `course` [rad]. The
/// feedback is one of distance below kMostPerMetre: a slow car is not turned across the road.
double StopPlanner::back_to(double beside, double course, double v, const Policy& policy,
                            double damping) const noexcept {
  const double grip = kGripShare * friction_ * model_.load(v);
  const double most = policy.grip_share * grip / ((1.0 - model_.vehicle().steer_helper) * v * v);
  const double k = std::min(policy.bandwidth / v, kMostPerMetre);
  return std::clamp(-k * k * beside - 2.0 * damping * k * course, -most, most);
}

StopCheck StopPlanner::plan(const road::KnownRoad& road, const StopStart& start, const Policy& policy,
                            StopPlan& out, double least) const noexcept {
  const double reach = steer_reach(kStep);
  const StopCar::Step step = car_.step(kStep);
  const double end = end_of(road, start);
  const double most_slide = std::max(kMostSlide, slide(start.body) + kSlideGrows);
  const int held_for = held_steps(policy);
  StopStart at = start;
  Here here = road.here(at.s);
  StopCheck check{.least_edge = edge(road, start)};
  double driven = 0.0;
  double speed = speed_of(at.body);
  out.size = 0;
  model::Command held;
  for (int i = 0; i < kStepsPerPoint * StopPlan::kCapacity; ++i) {
    if (i % held_for == 0) held = command(road, at, here, policy);
    const bool has_ended =
        speed < kStanding || !(std::fabs(at.d) < kMostOffset) || !(at.s < end) || check.least_edge < least;
    if (i % kStepsPerPoint == 0 || has_ended) out.add({at.time, driven, speed, held});
    if (has_ended) break;
    const double before = speed;
    move(car_, here, at, held, step, reach);
    here = road.here(at.s);
    speed = speed_of(at.body);
    driven += 0.5 * kStep * (before + speed);
    check.least_edge = least_edge(road, at, here, check.least_edge);
    if (!(check.spins_at > 0.0) && slides_more(at.body, most_slide)) check.spins_at = speed;
  }
  check.stands = speed < kStanding && at.s < end && !(check.least_edge < least) && !(check.spins_at > 0.0);
  check.distance = driven;
  check.end = at;
  return check;
}

}  // namespace chicane::safety
