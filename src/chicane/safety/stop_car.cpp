// SPDX-License-Identifier: MIT
#include "chicane/safety/stop_car.hpp"

#include <cstddef>

#include "chicane/base/math.hpp"
#include "chicane/model/actuator.hpp"

namespace chicane::safety {
namespace {

// Origins (chosen: by trial, see Guard):
// - Derived: kLoadLag (bmw-320i's; other plants have 9 to 80 ms), kLocks (the plant's:
//   sim/double_track.hpp), kMostAlong (a planned lap uses no more, docs/racing.md), kLeastSquare (a
//   divisor above 0).
// - Chosen: kRelaxation (docs/guard.md, eq. 3a), kLeastLoad (a wheel that is nearly in the air).
constexpr double kLoadLag = 0.06;          // [s] of the loads behind the accelerations: springs and dampers
constexpr double kLeastLoad = 0.05;        // share of a wheel's load at rest
constexpr double kMostAlong = 0.95;        // share of a tyre's peak, for a wheel that does not lock
constexpr double kLocks[] = {0.10, 0.18};  // slips between which anti-lock takes the torque away
constexpr double kLeastSquare = 1e-8;      // of a slip: the curve's secant has a kink at 0
constexpr double kRelaxation = 0.4;  // [m] rolled while a tyre's slip angle follows: about a wheel's radius

}  // namespace

void StopCar::set_vehicle(const model::VehicleParams& vehicle) noexcept {
  model_.set_vehicle(vehicle);
  const model::VehicleParams& p = vehicle;
  has_wheels_ = p.friction_coupling > 0.0 && p.tire_shape > 0.0 && !(p.steer_helper > 0.0);
  axles_ = p.axles();
  for (std::size_t i = 0; i < EachWheel::kLanes; ++i) {
    const bool is_front = i < 2;
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    const model::Axle& axle = axles_[i / 2];
    wheels_.x.set(i, axle.x);
    wheels_.y.set(i, side * axle.half_track);
    wheels_.is_front.set(i, is_front ? 1.0 : 0.0);
    wheels_.pitches.set(i, is_front ? -1.0 : 1.0);
    wheels_.rolls.set(i, side * axle.roll_share);
    wheels_.rest.set(i, axle.rest * p.load_constant);
    wheels_.down.set(i, 2.0 * (axle.rest + (is_front ? 0.5 : -0.5) * p.load_balance));
    wheels_.drive.set(i, axle.drive_share);
    wheels_.brake.set(i, axle.brake_share);
    wheels_.cornering.set(i, (is_front ? p.cornering_front : p.cornering_rear) / p.friction);
  }
}

StopCar::Change StopCar::change(const StopMotion& at) const noexcept {
  const model::VehicleParams& p = vehicle();
  const model::BodyMotion<double>& m = at.body;
  const double drag = -longitudinal_acceleration(p, 0.0, m.vx);
  const double pedal = m.acceleration + drag;
  const double driven = std::min(p.drag_driven, p.drag_constant);
  const double rolling = (p.drag_constant - driven) / p.load_constant;
  const double down = 0.5 * (p.load(m.vx) - p.load_constant);
  const double pitch = 0.5 * p.height / p.wheelbase() * at.load_along;
  const double roll = p.height / p.track_width * at.load_across;
  const auto secant = [&p](const EachWheel& square) {
    return model::magic_secant(p.tire_shape, EachWheel(square + kLeastSquare));
  };
  const Wheels& w = wheels_;
  const EachWheel asked = 0.5 * (pedal * (pedal > 0.0 ? w.drive : w.brake) - driven * w.drive);
  const EachWheel moved = max(w.pitches * pitch - w.rolls * roll, (kLeastLoad - 1.0) * w.rest);
  const EachWheel load = w.rest + moved + w.down * down;
  const EachWheel most = p.friction * (1.0 - p.load_sensitivity * moved / w.rest) * load;
  const EachWheel forward = max(m.vx - m.r * w.y, EachWheel(0.25 * m.vx));  // of a car that spins, too
  const EachWheel behind = at.behind_rear + (at.behind_front - at.behind_rear) * w.is_front;
  const auto [sine, cosine] = sine_cosine(m.steer);
  const EachWheel course = (m.vy + m.r * w.x) / forward, turned = (sine / cosine) * w.is_front;
  const EachWheel slip = (turned - course) / (1.0 + turned * course) - behind;
  // The slip along that gives the force asked for beside the slip across, by similarity: a fixed point, from
  // that without slip across, by two steps and Aitken's.
  const EachWheel wanted = (asked - rolling * load) / most;
  const EachWheel use = min(max(wanted, EachWheel(-kMostAlong)), EachWheel(kMostAlong));
  const EachWheel z = w.cornering * slip, across_square = z * z, use_square = use * use;
  const EachWheel alone = use / sqrt(sqrt(1.0 - use_square * use_square));
  const EachWheel next = use / secant(across_square + alone * alone);
  const EachWheel after = use / secant(across_square + next * next);
  const EachWheel step = next - alone;
  const EachWheel shrinks = min((after - next) * step / (step * step + kLeastSquare), EachWheel(0.9));
  EachWheel z_along = alone + step / (1.0 - shrinks);
  // Anti-lock or traction control holds a wheel that locks or spins at a larger slip (3b): between `from` and
  // `to` the torque falls to nothing.
  const EachWheel from = kLocks[0] * w.cornering, to = kLocks[1] * w.cornering;
  const EachWheel over = abs(wanted) - from * secant(from * from + across_square);
  const auto locks = over > 0.0;
  if (any(locks)) {
    const EachWheel held = to * secant(to * to + across_square);
    z_along = select(locks, copysign(from + (to - from) * over / (over + held), wanted), z_along);
  }
  const EachWheel stiffness = most * secant(across_square + z_along * z_along);
  const EachWheel along = select(locks, stiffness * z_along, most * use), across = stiffness * z;
  const auto force_of = [&](std::size_t i, const model::Axle&, const model::Planar<double>&) {
    return model::Planar<double>{along[i], across[i]};
  };
  const double air = p.drag_constant - drag;
  const auto sum =
      model::wheel_forces<double>(axles_, {m.vx, m.vy}, m.r, cosine, sine, {air, 0.0, 0.0}, force_of);
  return {sum.x + m.r * m.vy, sum.y - m.r * m.vx, p.mass / p.yaw_inertia * sum.moment, sum.x, sum.y};
}

std::array<double, 2> StopCar::slips(const model::BodyMotion<double>& m) const noexcept {
  const auto course = [&m](const model::Axle& axle) { return (m.vy + m.r * axle.x) / m.vx; };
  return {m.steer - course(axles_[0]), -course(axles_[1])};
}

StopCar::Step StopCar::step(double dt) const noexcept {
  const model::VehicleParams& p = vehicle();
  const auto left = [&](double h) {
    return Left{model::left_by_lag(kLoadLag, h), model::left_by_lag(p.steer_lag, h),
                model::left_by_lag(p.drive_lag, h)};
  };
  return {dt, model_.lags(dt), left(0.5 * dt), left(dt)};
}

StopMotion StopCar::advance(const StopMotion& from, double steer_command, double acceleration_command,
                            const Step& step) const noexcept {
  const model::BodyMotion<double>& m = from.body;
  if (!has_wheels_ || !(m.vx > kByWheels)) {
    StopMotion to{.body = model_.advance(m, steer_command, acceleration_command, step.dt, step.lags)};
    to.load_along = to.body.acceleration;
    to.load_across = to.body.vx * to.body.r;
    return to;
  }
  // The midpoint rule, with the lags' exact solutions.
  const std::array<double, 2> slip = slips(m);
  const double rolled = 0.5 * step.dt * m.vx / kRelaxation;
  const double left_half = exp(-rolled);
  const auto later = [&](double h, const Left& left, double slip_left, const Change& change) {
    StopMotion to{.body = {m.vx + h * change.vx, m.vy + h * change.vy, m.r + h * change.r,
                           steer_command + (m.steer - steer_command) * left.steer,
                           acceleration_command + (m.acceleration - acceleration_command) * left.drive},
                  .load_along = change.along + (from.load_along - change.along) * left.load,
                  .load_across = change.across + (from.load_across - change.across) * left.load};
    const std::array<double, 2> now = slips(to.body);
    const double gain = (1.0 - slip_left) * 0.5 * step.dt / (rolled * h);
    to.behind_front = slip_left * from.behind_front + gain * (now[0] - slip[0]);
    to.behind_rear = slip_left * from.behind_rear + gain * (now[1] - slip[1]);
    return to;
  };
  const StopMotion middle = later(0.5 * step.dt, step.middle, left_half, change(from));
  return later(step.dt, step.end, left_half * left_half, change(middle));
}

}  // namespace chicane::safety
