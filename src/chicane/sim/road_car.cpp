// SPDX-License-Identifier: MIT
#include "chicane/sim/road_car.hpp"

#include <algorithm>
#include <cmath>

#include "chicane/base/angle.hpp"
#include "chicane/base/math.hpp"

namespace chicane::sim {

namespace {

constexpr double kDt = RoadCar::kStepLength;

double finite_or_zero(double value) noexcept { return std::isfinite(value) ? value : 0.0; }

/// `v` from axes turned by an angle with cosine c and sine s, to the axes it is turned against.
Vec2 turned(const Vec2& v, double c, double s) noexcept {
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}

/// Where the curve has its maximum: C atan(B x − E (B x − atan(B x))) = π/2, by Newton's method.
double peak_slip_of(const model::MagicFormula& tire) noexcept {
  const double wanted = tan(kPi / (2.0 * tire.shape));
  double z = wanted;  // B x; exact for E = 0
  for (int i = 0; i < 20; ++i) {
    const double error = z - tire.curvature * (z - atan(z)) - wanted;
    z -= error / (1.0 - tire.curvature * (1.0 - 1.0 / (1.0 + z * z)));
  }
  return z / tire.stiffness;
}

}  // namespace

RoadCar::RoadCar(const RoadCarParams& params) noexcept : nominal_{params}, params_{params} {
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    const bool is_front = i < 2;
    Wheel& wheel = wheels_[i];
    wheel.position = {is_front ? params.front_axle : -params.rear_axle,
                      i % 2 == 0 ? params.half_track : -params.half_track};
    wheel.static_load = static_load(is_front);
    wheel.tire = {.stiffness = is_front ? params.stiffness_front : params.stiffness_rear,
                  .shape = params.shape,
                  .peak = 1.0,
                  .curvature = params.curvature};
    wheel.peak_slip = peak_slip_of(wheel.tire);
  }
  reset({}, 0.0);
}

void RoadCar::reset(const model::Pose& pose, double speed) noexcept {
  state_ = {.x = pose.x, .y = pose.y, .psi = pose.psi, .vx = speed, .vy = 0.0, .r = 0.0, .steer = 0.0};
  velocity_ = {speed * cos(pose.psi), speed * sin(pose.psi)};
  transfer_ = Vec2{};
  pedal_ = 0.0;
  for (Wheel& wheel : wheels_) {
    wheel.speed = speed / params_.wheel_radius;
    wheel.slip_along = wheel.slip_across = 0.0;
    wheel.load = wheel.static_load;
  }
  output_ = {};
  output_.speed = speed;
}

void RoadCar::set_motion(const Vec2& velocity, double yaw_rate) noexcept {
  state_.vx = velocity.x();
  state_.vy = velocity.y();
  state_.r = yaw_rate;
  velocity_ = turned(velocity, cos(state_.psi), sin(state_.psi));
  for (Wheel& wheel : wheels_) wheel.speed = velocity.x() / params_.wheel_radius;
  output_.speed = velocity.norm();
}

void RoadCar::deviate(const PlantDeviation& deviation) noexcept {
  params_.mass = nominal_.mass * deviation.mass_scale;
  params_.yaw_inertia = nominal_.yaw_inertia * deviation.mass_scale;
  params_.friction = nominal_.friction * deviation.friction_scale;
  for (std::size_t i = 0; i < wheels_.size(); ++i) wheels_[i].static_load = static_load(i < 2);
}

double RoadCar::static_load(bool is_front) const noexcept {
  const double wheelbase = params_.front_axle + params_.rear_axle;
  return 0.5 * params_.mass * params_.gravity * (is_front ? params_.rear_axle : params_.front_axle) /
         wheelbase;
}

void RoadCar::advance(const model::Command& command) noexcept {
  state_.steer = params_.steer.next(state_.steer, finite_or_zero(command.steer), kDt);
  const double throttle = std::clamp(finite_or_zero(command.throttle), -1.0, 1.0);
  pedal_ = params_.pedal.next(pedal_, throttle, kDt);
  load_wheels();
  move();
  output_.throttle = std::max(throttle, 0.0);
}

void RoadCar::load_wheels() noexcept {
  const double along =
      params_.mass * params_.height * transfer_.x() / (params_.front_axle + params_.rear_axle);
  const double across = params_.mass * params_.height * transfer_.y() / (2.0 * params_.half_track);
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    const double share = i < 2 ? params_.roll_share_front : 1.0 - params_.roll_share_front;
    const double change = (i < 2 ? -0.5 : 0.5) * along + (i % 2 == 0 ? -share : share) * across;
    wheels_[i].load = std::max(wheels_[i].static_load + change, 0.0);
  }
}

Vec2 RoadCar::tire_force(Wheel& wheel, const Vec2& v) const noexcept {
  // Relaxed slips (docs/plants.md, eq. 5), implicit in the slip: stable at any speed.
  const double rolling = std::fabs(v.x());
  const double slide = wheel.speed * params_.wheel_radius - v.x();
  const double gain_along = kDt / params_.relaxation_along;
  const double gain_across = kDt / params_.relaxation_across;
  wheel.slip_along =
      std::clamp((wheel.slip_along + gain_along * slide) / (1.0 + gain_along * rolling), -1.0, 1.0);
  wheel.slip_across =
      std::clamp((wheel.slip_across - gain_across * v.y()) / (1.0 + gain_across * rolling), -1.0, 1.0);

  // Damping that keeps a standing tyre from ringing like a spring.
  const double damping = params_.creep_damping * std::max(1.0 - rolling / params_.creep_speed, 0.0);
  const double along = wheel.slip_along + damping * slide;
  const double across = wheel.slip_across - damping * v.y();

  // Combined slip by similarity (eq. 6).
  const double size = hypot(along, across);
  wheel.use = 0.0;
  if (size < 1e-9 || wheel.load <= 0.0) return Vec2{};
  const double friction =
      params_.friction * (1.0 - params_.load_sensitivity * (wheel.load / wheel.static_load - 1.0));
  const double share = wheel.tire(size);
  wheel.use = size < wheel.peak_slip ? share : size / wheel.peak_slip;
  const double force = wheel.load * std::max(friction, 0.1) * disturbance_.grip * share;
  return {force * along / size, force * across / size};
}

void RoadCar::spin(Wheel& wheel, double force, double drive, double brake,
                   double speed_along) const noexcept {
  // Anti-lock: less brake the more the wheel slips.
  if (std::fabs(speed_along) > params_.abs_speed) {
    const double slip = -wheel.slip_along * (speed_along > 0.0 ? 1.0 : -1.0);
    brake *=
        std::clamp((params_.abs_slip_end - slip) / (params_.abs_slip_end - params_.abs_slip_start), 0.0, 1.0);
  }
  const double resistance = brake + params_.rolling_resistance * wheel.load * params_.wheel_radius;
  const double free = wheel.speed + kDt * (drive - params_.wheel_radius * force) / params_.wheel_inertia;
  const double most = kDt * resistance / params_.wheel_inertia;
  wheel.speed = std::fabs(free) <= most ? 0.0 : free - std::copysign(most, free);
}

void RoadCar::move() noexcept {
  const double c = cos(state_.psi);
  const double s = sin(state_.psi);
  const double cos_steer = cos(state_.steer);
  const double sin_steer = sin(state_.steer);
  const Vec2 v_B = turned(velocity_, c, -s);
  const double speed = velocity_.norm();

  const double drive_force = std::min(std::max(pedal_, 0.0) * params_.drive_force,
                                      params_.drive_power / std::max(std::fabs(v_B.x()), 1.0));
  const double brake_force = std::max(-pedal_, 0.0) * params_.brake_force;
  Vec2 force_B = -params_.drag * speed * v_B;
  double moment = 0.0;
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    Wheel& wheel = wheels_[i];
    const bool is_front = i < 2;
    const double cw = is_front ? cos_steer : 1.0;
    const double sw = is_front ? sin_steer : 0.0;
    const Vec2 v_wheel = turned(
        Vec2{v_B.x() - state_.r * wheel.position.y(), v_B.y() + state_.r * wheel.position.x()}, cw, -sw);
    const Vec2 force_wheel = tire_force(wheel, v_wheel);
    const double drive_share = is_front ? params_.drive_share_front : 1.0 - params_.drive_share_front;
    const double brake_share = is_front ? params_.brake_share_front : 1.0 - params_.brake_share_front;
    spin(wheel, force_wheel.x(), 0.5 * drive_share * drive_force * params_.wheel_radius,
         0.5 * brake_share * brake_force * params_.wheel_radius, v_wheel.x());
    const Vec2 force = turned(force_wheel, cw, sw);
    force_B += force;
    moment += wheel.position.x() * force.y() - wheel.position.y() * force.x();
    output_.slip_angle[i] = -atan(wheel.slip_across);
    output_.slip_ratio[i] = wheel.slip_along;
  }
  for (std::size_t axle = 0; axle < 2; ++axle) {
    const Wheel& left = wheels_[2 * axle];
    const Wheel& right = wheels_[2 * axle + 1];
    output_.tire_use[axle] =
        (left.load * left.use + right.load * right.use) / std::max(left.load + right.load, 1.0);
  }

  force_B.y() += params_.mass * disturbance_.side_acceleration;
  const Vec2 a_B = force_B / params_.mass;
  transfer_ += (kDt / params_.load_lag) * (a_B - transfer_);
  velocity_ += kDt * turned(a_B, c, s);
  state_.r += kDt * moment / params_.yaw_inertia;
  state_.x += kDt * velocity_.x();
  state_.y += kDt * velocity_.y();
  state_.psi += kDt * state_.r;
  const Vec2 v_after = turned(velocity_, cos(state_.psi), -sin(state_.psi));
  state_.vx = v_after.x();
  state_.vy = v_after.y();
  output_.ax = a_B.x();
  output_.ay = a_B.y();
  output_.speed = velocity_.norm();
}

std::array<Vec2, 4> RoadCar::contact_points() const noexcept {
  const double edge = params_.half_track + params_.half_tire;
  return {Vec2{params_.front_axle, edge}, Vec2{params_.front_axle, -edge}, Vec2{-params_.rear_axle, edge},
          Vec2{-params_.rear_axle, -edge}};
}

}  // namespace chicane::sim
