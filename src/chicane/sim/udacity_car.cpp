// SPDX-License-Identifier: MIT
// The original simulator's car: PhysX wheels with its friction curves, steer helper, traction control and
// drive torque, step by step as its scripts do it.
#include "chicane/sim/udacity_car.hpp"

#include <algorithm>
#include <cmath>

#include "chicane/base/jet.hpp"
#include "chicane/base/math.hpp"

namespace chicane::sim {

namespace {

double finite_or_zero(double value) noexcept { return std::isfinite(value) ? value : 0.0; }

/// `v` turned counter-clockwise by `angle` [rad].
Vec2 rotated(const Vec2& v, double angle) noexcept {
  const double c = cos(angle);
  const double s = sin(angle);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}

/// Yaw as the original engine counts it: clockwise from +y, in [0, 360).
double engine_yaw(double psi) noexcept {
  const double yaw = std::fmod(90.0 - radians_to_degrees(psi), 360.0);
  return yaw < 0.0 ? yaw + 360.0 : yaw;
}

/// Use of a tyre in one direction: force over peak force up to the slip of the peak, and beyond it slip over
/// that slip.
double use_of(const model::FrictionCurve& curve, double slip) noexcept {
  const double size = std::fabs(slip);
  return size < curve.extremum_slip ? curve(size) / curve.extremum_value : size / curve.extremum_slip;
}

}  // namespace

UdacityCar::UdacityCar(const UdacityCarParams& params) noexcept : nominal_{params}, params_{params} {
  const double wheelbase = params.front_axle + params.rear_axle;
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    const bool is_front = i < 2;
    Wheel& wheel = wheels_[i];
    wheel.position = {is_front ? params.front_axle : -params.rear_axle,
                      i % 2 == 0 ? params.half_track : -params.half_track};
    wheel.radius = is_front ? params.front_radius : params.rear_radius;
    wheel.inertia = 0.5 * params.wheel_mass * wheel.radius * wheel.radius;
    wheel.load_share = 0.5 * (is_front ? params.rear_axle : params.front_axle) / wheelbase;
  }
  reset({}, 0.0);
}

void UdacityCar::reset(const model::Pose& pose, double speed) noexcept {
  state_ = {.x = pose.x, .y = pose.y, .psi = pose.psi, .vx = speed, .vy = 0.0, .r = 0.0, .steer = 0.0};
  velocity_ = rotated({speed, 0.0}, pose.psi);
  psi_before_ = pose.psi;
  drive_torque_ = speed > 0.0 ? params_.drive_torque : 0.0;
  for (Wheel& wheel : wheels_) {
    wheel.speed = speed / wheel.radius;
    wheel.drive = wheel.brake = wheel.slip_angle = wheel.slip_ratio = 0.0;
  }
  output_ = {};
  output_.speed = speed;
}

void UdacityCar::set_motion(const Vec2& velocity, double yaw_rate) noexcept {
  state_.vx = velocity.x();
  state_.vy = velocity.y();
  state_.r = yaw_rate;
  velocity_ = rotated(velocity, state_.psi);
  for (Wheel& wheel : wheels_) wheel.speed = velocity.x() / wheel.radius;
  output_.speed = velocity.norm();
}

void UdacityCar::deviate(const PlantDeviation& deviation) noexcept {
  params_.mass = nominal_.mass * deviation.mass_scale;
  params_.yaw_inertia = nominal_.yaw_inertia * deviation.mass_scale;
  params_.friction_scale = nominal_.friction_scale * deviation.friction_scale;
}

void UdacityCar::advance(const model::Command& command) noexcept {
  const Vec2 velocity_before = velocity_;
  const double pedal = std::clamp(finite_or_zero(command.throttle), -1.0, 1.0);
  state_.steer = std::clamp(finite_or_zero(command.steer), -params_.steer_limit, params_.steer_limit);
  help_steering();
  apply_pedal(pedal);
  if (const double speed = velocity_.norm(); speed > params_.speed_cap)
    velocity_ *= params_.speed_cap / speed;
  load_wheels();
  control_traction();
  for (int part = 0; part < kParts; ++part) move(kStepLength / kParts);
  velocity_ *= 1.0 - params_.linear_drag * kStepLength;
  state_.r *= 1.0 - params_.angular_drag * kStepLength;
  publish(velocity_before, pedal);
}

void UdacityCar::help_steering() noexcept {
  const double change = state_.psi - psi_before_;
  constexpr double kMostChange = 10.0;  // [deg] from this change on the original's script does nothing
  const double seen = engine_yaw(state_.psi) - engine_yaw(psi_before_);
  if (std::fabs(seen) < kMostChange) velocity_ = rotated(velocity_, params_.steer_helper * change);
  psi_before_ = state_.psi;
}

void UdacityCar::apply_pedal(double pedal) noexcept {
  const Vec2 forward = rotated({1.0, 0.0}, state_.psi);
  const double speed = velocity_.norm();
  const bool is_forward = forward.dot(velocity_) > speed * cos(params_.brake_angle);
  const double drive = std::max(pedal, 0.0) * drive_torque_ / 4.0;
  const double brake = std::max(-pedal, 0.0);
  for (Wheel& wheel : wheels_) {
    wheel.drive = drive;
    if (speed > params_.brake_speed && is_forward) {
      wheel.brake = params_.brake_torque * brake;
    } else if (brake > 0.0) {
      wheel.brake = 0.0;
      wheel.drive = -params_.reverse_torque * brake;
    }  // else the brake torque stays: the original does not clear it here
  }
}

void UdacityCar::control_traction() noexcept {
  for (const Wheel& wheel : wheels_) {
    const double change = wheel.slip_ratio >= params_.slip_limit ? -params_.torque_ramp : params_.torque_ramp;
    drive_torque_ = std::clamp(drive_torque_ + change, 0.0, params_.drive_torque);
  }
}

void UdacityCar::load_wheels() noexcept {
  const double rest = (params_.mass + 4.0 * params_.wheel_mass) * params_.gravity;
  const double load = rest + params_.downforce * velocity_.norm();
  const double slope = (3.0 - params_.load_filter_offset) / 3.0;
  const double filtered = std::min(rest * params_.load_filter_offset + slope * load, 3.0 * rest);
  for (Wheel& wheel : wheels_)
    wheel.load = filtered * wheel.load_share * params_.friction_scale * disturbance_.grip;
}

double UdacityCar::forward_force(Wheel& wheel, double speed_along, double dt) const noexcept {
  const double rim = wheel.speed * wheel.radius;
  const double fastest = std::max(std::fabs(rim), std::fabs(speed_along));
  const bool is_driven = wheel.drive != 0.0 || wheel.brake != 0.0;
  const double denominator =
      is_driven ? fastest + params_.driven_speed_offset : std::max(fastest, params_.rolling_speed_floor);
  wheel.slip_ratio = (rim - speed_along) / denominator;
  const FullJet<1> normalised = params_.forward(FullJet<1>::variable(wheel.slip_ratio, 0));
  const double force = wheel.load * normalised.v;
  const double stiffness =
      std::max(wheel.load * normalised.slopes[0] / denominator, 0.0);  // force over slip speed [N s/m]
  const double body_gain = dt * stiffness * 4.0 / params_.mass;
  const double wheel_gain = dt * stiffness * wheel.radius / wheel.inertia;

  // A locked wheel stays locked while the brake can hold it.
  const double free_torque = wheel.drive - params_.wheel_damping * wheel.speed;
  const double force_locked = force / (1.0 + body_gain);
  const double pull = free_torque - wheel.radius * force_locked;
  if (wheel.speed == 0.0 && std::fabs(pull) <= wheel.brake) return force_locked;

  const double direction = wheel.speed != 0.0 ? wheel.speed : pull;
  const double torque = free_torque - std::copysign(wheel.brake, direction);
  const double limit = wheel.load * params_.forward.extremum_value;
  const double result = std::clamp(
      (force + wheel_gain * torque) / (1.0 + wheel_gain * wheel.radius + body_gain), -limit, limit);
  const double speed_after = wheel.speed + dt * (torque - wheel.radius * result) / wheel.inertia;
  const bool is_stopped = wheel.brake > 0.0 && wheel.speed * speed_after < 0.0;
  wheel.speed = is_stopped ? 0.0 : speed_after;
  return result;
}

void UdacityCar::move(double dt) noexcept {
  const Vec2 v_B = rotated(velocity_, -state_.psi);
  const double cos_steer = cos(state_.steer);
  const double sin_steer = sin(state_.steer);
  Vec2 force_B{};
  double moment = 0.0;
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    Wheel& wheel = wheels_[i];
    const double c = i < 2 ? cos_steer : 1.0;
    const double s = i < 2 ? sin_steer : 0.0;
    const Vec2 v{v_B.x() - state_.r * wheel.position.y(), v_B.y() + state_.r * wheel.position.x()};
    const double along = c * v.x() + s * v.y();
    const double across = c * v.y() - s * v.x();
    wheel.slip_angle = atan(across / (std::fabs(along) + params_.lateral_speed_offset));
    const double side = -wheel.load * params_.sideways(wheel.slip_angle);
    const double forward = forward_force(wheel, along, dt);
    const Vec2 force{c * forward - s * side, s * forward + c * side};
    force_B += force;
    moment += wheel.position.x() * force.y() - wheel.position.y() * force.x();
  }
  force_B.y() += params_.mass * disturbance_.side_acceleration;
  velocity_ += (dt / params_.mass) * rotated(force_B, state_.psi);
  state_.r += dt * moment / params_.yaw_inertia;
  state_.x += dt * velocity_.x();
  state_.y += dt * velocity_.y();
  state_.psi += dt * state_.r;
}

void UdacityCar::publish(const Vec2& velocity_before, double pedal) noexcept {
  const Vec2 v_B = rotated(velocity_, -state_.psi);
  const Vec2 a_B = rotated((velocity_ - velocity_before) / kStepLength, -state_.psi);
  state_.vx = v_B.x();
  state_.vy = v_B.y();
  output_.ax = a_B.x();
  output_.ay = a_B.y();
  output_.speed = velocity_.norm();
  output_.throttle = std::max(pedal, 0.0);
  output_.tire_use = {};
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    output_.slip_angle[i] = wheels_[i].slip_angle;
    output_.slip_ratio[i] = wheels_[i].slip_ratio;
    // Longitudinal and lateral force do not share grip. The wheels of an axle carry the same load.
    output_.tire_use[i / 2] += 0.5 * std::max(use_of(params_.sideways, wheels_[i].slip_angle),
                                              use_of(params_.forward, wheels_[i].slip_ratio));
  }
}

std::array<Vec2, 4> UdacityCar::contact_points() const noexcept {
  const double edge = params_.half_track + params_.half_tire;
  return {Vec2{params_.front_axle, edge}, Vec2{params_.front_axle, -edge}, Vec2{-params_.rear_axle, edge},
          Vec2{-params_.rear_axle, -edge}};
}

}  // namespace chicane::sim
