// SPDX-License-Identifier: MIT
#include "chicane/identify/detail/four_wheels.hpp"

#include <algorithm>
#include <cmath>

#include "chicane/base/math.hpp"

namespace chicane::identify {
namespace {

constexpr double kGravity = 9.81;      // [m/s²]
constexpr double kLeastLoad = 0.1;     // of the load at rest, as model::PredictionModel
constexpr double kLeastSpeed = 0.3;    // [m/s] of a wheel
constexpr double kLeastSquare = 1e-8;  // of a slip: the secant is 1 there
// A standing tyre springs; what damps it (docs/plants.md, eq. 5).
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
      turn_{vehicle.mass / vehicle.yaw_inertia} {
  const double a = vehicle.front_axle, b = vehicle.rear_axle;
  const double half = 0.5 * vehicle.track_width;
  const auto across = [&](double other, double share) {
    return 2.0 * vehicle.height * share * vehicle.wheelbase() / (vehicle.track_width * kGravity * other);
  };
  axles_[0] = {a,
               half,
               vehicle.cornering_front / vehicle.friction,
               0.5 * b / vehicle.wheelbase(),
               -vehicle.height / (kGravity * b),
               across(b, vehicle.roll_share_front),
               0.5 * vehicle.drive_share_front,
               0.5 * vehicle.brake_share_front};
  axles_[1] = {-b,
               half,
               vehicle.cornering_rear / vehicle.friction,
               0.5 * a / vehicle.wheelbase(),
               vehicle.height / (kGravity * a),
               across(a, 1.0 - vehicle.roll_share_front),
               0.5 * (1.0 - vehicle.drive_share_front),
               0.5 * (1.0 - vehicle.brake_share_front)};
}

FourWheels::Motion FourWheels::steady(double vx, double vy, double r, double steer,
                                      double acceleration) const noexcept {
  Motion motion{.vx = vx, .vy = vy, .r = r};
  for (std::size_t i = 0; i < 4; ++i) {
    const Axle& axle = axles_[i / 2];
    const double y = i % 2 == 0 ? axle.width_half : -axle.width_half;
    const double angle = i < 2 ? steer : 0.0;
    const double c = cos(angle), s = sin(angle);
    const double wx = vx - r * y, wy = vy + r * axle.x;
    motion.slip[i] = -(c * wy - s * wx) / std::max(std::fabs(c * wx + s * wy), kLeastSpeed);
    motion.rolling[i] = c * wx + s * wy - dt_ * acceleration;
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const Axle& axle = axles_[i / 2];
    const double stiffness = vehicle_.friction * axle.cornering * axle.rest * kGravity;
    motion.slip_along[i] =
        std::clamp((acceleration >= 0.0 ? axle.drive : axle.brake) * acceleration / stiffness, -0.1, 0.1);
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
  double forward = 0.0, sideways = 0.0, moment = 0.0, lost = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const bool is_front = i < 2;
    const Axle& axle = axles_[i / 2];
    const double y = i % 2 == 0 ? axle.width_half : -axle.width_half;
    // Slip across, over the step whose middle the begin of this one is.
    const double bx = motion.vx - motion.r * y, by = motion.vy + motion.r * axle.x;
    const double wx = is_front ? c0 * bx + s0 * by : bx;
    const double wy = is_front ? c0 * by - s0 * bx : by;
    const double rolling = std::max(std::fabs(wx), kLeastSpeed);
    const double keeps = decay(dt_ * rolling * per_relaxation_);
    motion.slip[i] = std::clamp(-wy / rolling + (motion.slip[i] + wy / rolling) * keeps, -1.0, 1.0);
    const double damping = kCreepDamping * std::max(1.0 - rolling / kCreepSpeed, 0.0);
    const double slip = motion.slip[i] - damping * wy;

    const double side = i % 2 == 0 ? -1.0 : 1.0;  // in a bend to the left the right wheels get more
    const double part = std::max(
        kLeastLoad, 1.0 + rest * (axle.per_along * motion.along + side * axle.per_across * motion.across));
    const double load = axle.rest * pressed * part * (1.0 + vehicle_.load_sensitivity * (1.0 - part));
    const double most = vehicle_.friction * load;
    // The slip along the tyre at which the wheel's torque and force agree, the wheel's own inertia included;
    // the secant of the tyre curve is that of both slips together, by similarity.
    const double z = axle.cornering * slip;
    const double inertia = inertia_ * rolling / dt_;
    const double holds_back =
        rotating_ * vehicle_.drag_constant * axle.rest * part + inertia_ * (wx - motion.rolling[i]) / dt_;
    motion.rolling[i] = wx;
    double& along = motion.slip_along[i];
    const double before = along;
    double of = secant(z * z + axle.cornering * axle.cornering * along * along);
    for (int step = 0; step < 2; ++step) {
      const double torque = rotating_ * (force >= 0.0 ? axle.drive : axle.brake) * std::fabs(force);
      along = slip_for(torque, force >= 0.0 ? 1.0 : -1.0, force >= 0.0 ? wheels_.drive : wheels_.brakes,
                       most * axle.cornering * of + inertia, inertia * before - holds_back);
      of = secant(z * z + axle.cornering * axle.cornering * along * along);
    }
    const double fy = most * z * of;
    const double fx = most * axle.cornering * along * of;
    const double px = is_front ? cm * fx - sm * fy : fx;
    const double py = is_front ? sm * fx + cm * fy : fy;
    forward += px;
    sideways += py;
    moment += axle.x * py - y * px;
    lost += is_front ? sm * fy : 0.0;
  }
  forward -= rotating_ * (drag - vehicle_.drag_constant);
  motion.resistance = lost;
  motion.forward = forward;
  motion.sideways = sideways;
  const double r = motion.r + dt_ * turn_ * moment;
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
  motion.vx += dt_ * forward;
  motion.vy += dt_ * sideways;
  turn(0.5 * turned, motion.vx, motion.vy);
}

double FourWheels::secant(double square) const noexcept {
  const double z = sqrt(square + kLeastSquare);
  return sin(vehicle_.tire_shape * atan(z / vehicle_.tire_shape)) / z;
}

}  // namespace chicane::identify
