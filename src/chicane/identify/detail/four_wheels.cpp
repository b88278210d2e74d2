// SPDX-License-Identifier: MIT
#include "chicane/identify/detail/four_wheels.hpp"

#include <algorithm>
#include <cmath>

#include "chicane/base/math.hpp"
#include "chicane/model/wheel_forces.hpp"

namespace chicane::identify {
namespace {

constexpr double kGravity = 9.81;      // [m/s²]
constexpr double kLeastLoad = 0.1;     // of the load at rest, as model::PredictionModel
constexpr double kLeastSpeed = 0.3;    // [m/s] of a wheel
constexpr double kLeastSquare = 1e-8;  // of a slip: the secant is 1 there
// A standing tyre springs; what damps it (docs/model.md, eq. 19).
constexpr double kCreepSpeed = 3.0, kCreepDamping = 0.12;  // [m/s], [s/m]

/// The slip x with `sign` · torque · b(x) + rest = stiffness · x. b is 1 up to the slip at which a controller
/// begins to take torque away, and 0 where it has taken all.
double slip_for(double torque, double sign, const SlipLimit& hold, double stiffness, double rest) noexcept {
  const double free = (sign * torque + rest) / stiffness;
  if (!(sign * free > hold.start)) return std::clamp(free, -1.0, 1.0);
  const double slope = torque / (hold.end - hold.start);
  const double held = (sign * slope * hold.end + rest) / (stiffness + slope);
  return std::clamp(sign * std::min(sign * held, hold.end), -1.0, 1.0);
}

/// e^(−x) for x >= 0, positive and within 1 % for all x: of the fourth order.
double decay(double x) noexcept {
  return 1.0 / (1.0 + x * (1.0 + x * (0.5 + x * ((1.0 / 6.0) + x * (1.0 / 24.0)))));
}

}  // namespace

FourWheels::FourWheels(const model::VehicleParams& vehicle, const Wheels& wheels, double dt) noexcept
    : vehicle_{vehicle},
      dt_{dt},
      per_relaxation_{1.0 / std::max(wheels.relaxation, 0.02)},
      load_share_{1.0 - decay(dt / std::max(wheels.load_lag - 0.5 * dt, 1e-3))},
      wheels_{wheels},
      rotating_{wheels.rotating},
      inertia_{0.25 * std::max(wheels.rotating - 1.0, 0.005)},
      turn_{vehicle.mass / vehicle.yaw_inertia},
      axles_{vehicle.axles()} {
  const double pitch = vehicle.height / kGravity;
  for (std::size_t i = 0; i < 2; ++i) {
    const model::Axle& axle = axles_[i];
    const double share = 2.0 * axle.rest;
    const double cornering = i == 0 ? vehicle.cornering_front : vehicle.cornering_rear;
    tires_[i] = {cornering / vehicle.friction, (i == 0 ? -pitch : pitch) / (share * vehicle.wheelbase()),
                 2.0 * pitch * axle.roll_share / (vehicle.track_width * share)};
  }
}

FourWheels::Motion FourWheels::steady(double vx, double vy, double r, double steer,
                                      double acceleration) const noexcept {
  Motion motion{.vx = vx, .vy = vy, .r = r};
  for (std::size_t i = 0; i < 4; ++i) {
    const model::Axle& axle = axles_[i / 2];
    const double y = i % 2 == 0 ? axle.half_track : -axle.half_track;
    const double angle = i < 2 ? steer : 0.0;
    const auto rolling =
        model::in_turned_axes(model::Planar<double>{vx - r * y, vy + r * axle.x}, cos(angle), sin(angle));
    motion.slip[i] = -rolling.y / std::max(std::fabs(rolling.x), kLeastSpeed);
    motion.rolling[i] = rolling.x - dt_ * acceleration;
    const double stiffness = vehicle_.friction * tires_[i / 2].cornering * axle.rest * kGravity;
    const double share = 0.5 * (acceleration >= 0.0 ? axle.drive_share : axle.brake_share);
    motion.slip_along[i] = std::clamp(share * acceleration / stiffness, -0.1, 0.1);
  }
  motion.along = motion.forward = acceleration;
  motion.across = motion.sideways = vx * r;
  return motion;
}

void FourWheels::advance(Motion& motion, double steer, double steer_middle, double force,
                         double drag) const noexcept {
  const double pressed = vehicle_.load(std::max(motion.vx, 0.0));
  // Downforce loads the wheels, and moves nothing from one to the other.
  const double rest = kGravity / pressed;
  // The lagged load half a step on.
  motion.along += load_share_ * (motion.forward - motion.along);
  motion.across += load_share_ * (motion.sideways - motion.across);
  const double c0 = cos(steer), s0 = sin(steer);
  const double cm = cos(steer_middle), sm = sin(steer_middle);
  motion.resistance = 0.0;
  const auto force_of = [&](std::size_t i, const model::Axle& axle, const model::Planar<double>& v) {
    const bool is_front = i < 2;
    const Tire& tire = tires_[i / 2];
    // Slip across, over the step whose middle the begin of this one is.
    const model::Planar<double> w = is_front ? model::in_turned_axes(v, c0, s0) : v;
    const double rolling = std::max(std::fabs(w.x), kLeastSpeed);
    const double keeps = decay(dt_ * rolling * per_relaxation_);
    motion.slip[i] = std::clamp(-w.y / rolling + (motion.slip[i] + w.y / rolling) * keeps, -1.0, 1.0);
    const double damping = kCreepDamping * std::max(1.0 - rolling / kCreepSpeed, 0.0);
    const double slip = motion.slip[i] - damping * w.y;

    const double side = i % 2 == 0 ? -1.0 : 1.0;  // in a bend to the left the right wheels get more
    const double part = std::max(
        kLeastLoad, 1.0 + rest * (tire.per_along * motion.along + side * tire.per_across * motion.across));
    const double load = axle.rest * pressed * part * (1.0 + vehicle_.load_sensitivity * (1.0 - part));
    const double most = vehicle_.friction * load;
    // The slip along the tyre at which the wheel's torque and force agree, the wheel's own inertia included;
    // the secant of the tyre curve is that of both slips together, by similarity.
    const double z = tire.cornering * slip;
    const double inertia = inertia_ * rolling / dt_;
    const double holds_back =
        rotating_ * vehicle_.drag_constant * axle.rest * part + inertia_ * (w.x - motion.rolling[i]) / dt_;
    motion.rolling[i] = w.x;
    double& along = motion.slip_along[i];
    const double before = along;
    const auto secant = [&] {
      const double square = z * z + tire.cornering * tire.cornering * along * along;
      return model::magic_secant(vehicle_.tire_shape, square + kLeastSquare);
    };
    const double share = 0.5 * (force >= 0.0 ? axle.drive_share : axle.brake_share);
    double of = secant();
    for (int step = 0; step < 2; ++step) {
      along = slip_for(rotating_ * share * std::fabs(force), force >= 0.0 ? 1.0 : -1.0,
                       force >= 0.0 ? wheels_.drive : wheels_.brakes, most * tire.cornering * of + inertia,
                       inertia * before - holds_back);
      of = secant();
    }
    const model::Planar<double> made{most * tire.cornering * along * of, most * z * of};
    if (is_front) motion.resistance += sm * made.y;
    return made;
  };
  const auto sum =
      model::wheel_forces<double>(axles_, {motion.vx, motion.vy}, motion.r, cm, sm, {}, force_of);
  motion.forward = sum.x - rotating_ * (drag - vehicle_.drag_constant);
  motion.sideways = sum.y;
  const double r = motion.r + dt_ * turn_ * sum.moment;
  const double turned = 0.5 * dt_ * (motion.r + r);
  motion.r = r;
  // Velocity keeps its direction in the plane; the axes turn, half of it before the forces act.
  const auto turn = [](double angle, double& x, double& y) {
    const double square = angle * angle;
    const double cosine = 1.0 - 0.5 * square * (1.0 - square * (1.0 / 12.0));
    const double sine = angle * (1.0 - square * (1.0 / 6.0));
    const double first = cosine * x + sine * y;
    y = cosine * y - sine * x;
    x = first;
  };
  turn(0.5 * turned, motion.vx, motion.vy);
  motion.vx += dt_ * motion.forward;
  motion.vy += dt_ * motion.sideways;
  turn(0.5 * turned, motion.vx, motion.vy);
}

}  // namespace chicane::identify
