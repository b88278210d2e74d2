// SPDX-License-Identifier: MIT
// The four-wheel plant: options of its parameters, conversion from and to a controller's model, and its
// motion (tyre slips with relaxation, load transfer, drive, brakes, rolling), integrated in parts of a step.
#include "chicane/sim/double_track.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "chicane/base/math.hpp"

namespace chicane::sim {

namespace {

double finite_or_zero(double value) noexcept { return std::isfinite(value) ? value : 0.0; }

/// `v` in the axes of a body that is turned by an angle with cosine c and sine s, given in axes of the world.
Vec2 in_body(const Vec2& v, double c, double s) noexcept {
  const auto turned = model::in_turned_axes(model::Planar<double>{v.x(), v.y()}, c, s);
  return {turned.x, turned.y};
}
/// `v` in axes of the world, given in the axes of that body.
Vec2 in_world(const Vec2& v, double c, double s) noexcept { return in_body(v, c, -s); }

/// Number of parts of a step. Slip and speed of a wheel are an oscillator of frequency √(R² k / (J σ)), k
/// force per slip; in one part its phase changes by kMostTurn at most.
int parts_of(const DoubleTrackParams& p) noexcept {
  constexpr double kMostTurn = 0.25;   // [rad]; chosen: explicit steps stay stable
  constexpr double kMostParts = 50.0;  // limit of parts: bounds time; chosen
  const double load =
      0.5 * p.mass * DoubleTrackParams::kGravity * std::max(p.front_axle, p.rear_axle) / p.wheelbase();
  const double stiffness = load * p.friction * p.shape * std::max(p.stiffness_front, p.stiffness_rear);
  const double squared = p.wheel_radius * p.wheel_radius * stiffness / (p.wheel_inertia * p.relaxation_along);

  return static_cast<int>(
      std::clamp(std::ceil(DoubleTrack::kStepLength * std::sqrt(squared) / kMostTurn), 1.0, kMostParts));
}

using P = DoubleTrackParams;
// Units that only this plant has.
constexpr Unit kNewton{"N", "_n"};
constexpr Unit kWatt{"W", "_w"};
constexpr Unit kPressure = unit::per("kg/m");

/// Option row of a field of model::CarBody, which plants share with controllers' models.
const Option& body_row(std::string_view name) noexcept {
  const std::span<const Option> rows = model::vehicle_options();
  return *std::find_if(rows.begin(), rows.end(), [&](const Option& row) { return row.name == name; });
}

}  // namespace

std::span<const Option> double_track_options() noexcept {
  static const std::array kOptions{
      body_row("mass"),
      body_row("yaw_inertia"),
      body_row("front_axle"),
      body_row("rear_axle"),
      body_row("track_width"),
      body_row("tire_width"),
      body_row("height"),
      body_row("roll_share_front"),
      option<&P::load_lag>("load_lag", unit::kMillisecond, 1, 1000, "Time constant of the load transfer."),
      option<&P::wheel_radius>("wheel_radius", unit::kMetre, 0.001, 2, "Radius of the wheels."),
      option<&P::wheel_inertia>("wheel_inertia", unit::kInertia, 1e-10, 1000,
                                "Inertia of each of four wheels, with what turns along with it."),
      option<&P::rolling_resistance>("rolling_resistance", unit::kNone, 0, 1, "Resistance over load."),
      option<&P::drag>("drag", kPressure, 0, 100, "Resistance of the air for each (m/s)²."),
      option<&P::downforce_front>("downforce_front", kPressure, 0, 100,
                                  "Load of the front axle for each (m/s)²."),
      option<&P::downforce_rear>("downforce_rear", kPressure, 0, 100,
                                 "Load of the rear axle for each (m/s)²."),
      body_row("friction"),
      body_row("load_sensitivity"),
      option<&P::stiffness_front>("stiffness_front", unit::kNone, 0.5, 100, "Magic formula B, front."),
      option<&P::stiffness_rear>("stiffness_rear", unit::kNone, 0.5, 100, "Magic formula B, rear."),
      option<&P::shape>("shape", unit::kNone, 1.05, 2.5, "Magic formula C."),
      option<&P::relaxation_along>("relaxation_along", unit::kMetre, 0.001, 10,
                                   "Relaxation length of forward slip."),
      option<&P::relaxation_across>("relaxation_across", unit::kMetre, 0.001, 10,
                                    "Relaxation length of lateral slip."),
      option<&P::creep_speed>("creep_speed", unit::kSpeed, 0.01, 20,
                              "Slip damping fades out up to this speed."),
      option<&P::creep_damping>("creep_damping", unit::per("s/m"), 0, 10,
                                "Slip for each m/s of slip speed, at standstill."),
      option<&P::drive_force>("drive_force", kNewton, 1e-3, 1e6, "Force of all wheels at full throttle."),
      option<&P::drive_power>("drive_power", kWatt, 1e-3, 1e8, "Cap of drive force times speed."),
      body_row("drive_share_front"),
      option<&P::drive_friction>("drive_friction", kNewton, 0, 1e5,
                                 "Friction of motor and gears, on the driven wheels."),
      option<&P::brake_force>("brake_force", kNewton, 1e-3, 1e6, "Force of all wheels at throttle -1."),
      body_row("brake_share_front"),
      option<&P::abs_slip_start>("abs_slip_start", unit::kNone, 0.01, 1,
                                 "Forward slip at which anti-lock begins to take brake torque away."),
      option<&P::abs_slip_end>("abs_slip_end", unit::kNone, 0.02, 2, "Slip at which nothing is left."),
      option<&P::abs_speed>("abs_speed", unit::kSpeed, 0, 20, "Speed below which there is no anti-lock."),
      option<&P::traction_slip_start>(
          "traction_slip_start", unit::kNone, 0.01, 1,
          "Forward slip at which traction control begins to take drive torque away; "
          "infinite where there is none.")
          .or_infinite(),
      option<&P::traction_slip_end>("traction_slip_end", unit::kNone, 0.02, 2,
                                    "Slip at which nothing is left.")
          .or_infinite(),
      body_row("steer_limit"),
      body_row("steer_rate_limit"),
      body_row("steer_lag"),
      body_row("drive_lag"),
  };
  return kOptions;
}

model::VehicleParams model_of(const DoubleTrackParams& p, model::VehicleParams body) {
  model::VehicleParams m = std::move(body);
  static_cast<model::CarBody&>(m) = p;
  m.kinematic_length = p.wheelbase();
  const double slope = p.shape * p.friction;
  m.cornering_front = p.stiffness_front * slope;
  m.cornering_rear = p.stiffness_rear * slope;
  m.tire_shape = p.shape;
  m.friction_coupling = 1.0;
  m.load_constant = DoubleTrackParams::kGravity;
  m.load_per_speed = 0.0;
  // Tyres lose friction under downforce as under any load.
  const double downforce = p.downforce_front + p.downforce_rear;
  m.load_quadratic = (1.0 - p.load_sensitivity) * downforce / p.mass;
  m.load_balance = downforce > 0.0 ? p.downforce_front / downforce - p.rear_axle / p.wheelbase() : 0.0;
  m.steer_helper = 0.0;
  m.helper_gap = 0.0;
  // Inertia of the car and its wheels: a longitudinal force accelerates both.
  const double inertia = p.mass + 4.0 * p.wheel_inertia / (p.wheel_radius * p.wheel_radius);
  m.drive_acceleration = p.drive_force / inertia;
  m.drive_power_per_mass = p.drive_power / inertia;
  m.drag_constant =
      (p.rolling_resistance * DoubleTrackParams::kGravity * p.mass + p.drive_friction) / inertia;
  m.drag_driven = p.drive_friction / inertia;
  m.drag_linear = 0.0;
  m.drag_quadratic = (p.drag + p.rolling_resistance * downforce) / inertia;
  m.brake_acceleration = p.brake_force / inertia;
  // Anti-lock limits braking to the tyres' friction.
  m.brake_throttle_limit = std::min(1.0, p.friction * DoubleTrackParams::kGravity / m.brake_acceleration);
  m.reverse_speed = 0.0;
  m.brake_latch_speed = 0.0;
  return m;
}

DoubleTrackParams plant_of(const model::VehicleParams& m, DoubleTrackParams like) {
  DoubleTrackParams p = like;
  static_cast<model::CarBody&>(p) = m;
  if (m.tire_shape > 0.0) p.shape = m.tire_shape;
  const double slope = p.shape * p.friction;
  p.stiffness_front = m.cornering_front / slope;
  p.stiffness_rear = m.cornering_rear / slope;
  const double downforce = m.load_quadratic * p.mass / (1.0 - p.load_sensitivity);
  const double share_front = m.rear_axle / m.wheelbase() + m.load_balance;
  p.downforce_front = share_front * downforce;
  p.downforce_rear = (1.0 - share_front) * downforce;
  const double inertia = p.mass + 4.0 * p.wheel_inertia / (p.wheel_radius * p.wheel_radius);
  p.drive_force = m.drive_acceleration * inertia;
  if (m.drive_power_per_mass < std::numeric_limits<double>::infinity())
    p.drive_power = m.drive_power_per_mass * inertia;
  const double resistance = m.drag_constant * inertia;
  p.drive_friction = std::min(m.drag_driven * inertia, resistance);
  p.rolling_resistance = (resistance - p.drive_friction) / (DoubleTrackParams::kGravity * p.mass);
  p.drag = std::max(0.0, m.drag_quadratic * inertia - p.rolling_resistance * downforce);
  p.brake_force = m.brake_acceleration * inertia;
  return p;
}

DoubleTrack::DoubleTrack(const DoubleTrackParams& params) noexcept
    : nominal_{params},
      params_{params},
      steer_{params.steer()},
      pedal_way_{params.pedal()},
      parts_{parts_of(params)},
      dt_{kStepLength / parts_},
      axles_{params.axles()} {
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    Wheel& wheel = wheels_[i];
    wheel.static_load = params.static_load(i < 2);
    wheel.tire = params.tire(i < 2);
    wheel.peak_slip = wheel.tire.peak_slip();
  }
  reset({}, 0.0);
}

void DoubleTrack::reset(const model::Pose& pose, double speed) noexcept {
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

void DoubleTrack::set_motion(const Vec2& velocity, double yaw_rate) noexcept {
  state_.vx = velocity.x();
  state_.vy = velocity.y();
  state_.r = yaw_rate;
  velocity_ = in_world(velocity, cos(state_.psi), sin(state_.psi));
  for (Wheel& wheel : wheels_) wheel.speed = velocity.x() / params_.wheel_radius;
  output_.speed = velocity.norm();
}

void DoubleTrack::deviate(const PlantDeviation& deviation) noexcept {
  params_.mass = nominal_.mass * deviation.mass_scale;
  params_.yaw_inertia = nominal_.yaw_inertia * deviation.mass_scale;
  params_.friction = nominal_.friction * deviation.friction_scale;
  for (std::size_t i = 0; i < wheels_.size(); ++i) wheels_[i].static_load = params_.static_load(i < 2);
}

void DoubleTrack::advance(const model::Command& command) noexcept {
  const double steer = finite_or_zero(command.steer);
  const double throttle = std::clamp(finite_or_zero(command.throttle), -1.0, 1.0);
  for (int part = 0; part < parts_; ++part) {
    state_.steer = steer_.next(state_.steer, steer, dt_);
    pedal_ = pedal_way_.next(pedal_, throttle, dt_);
    load_wheels();
    move();
  }
  output_.throttle = std::max(throttle, 0.0);
}

void DoubleTrack::load_wheels() noexcept {
  const auto shift = params_.load_shift(transfer_.x(), transfer_.y(), 0.5 * velocity_.squared_norm());
  for (std::size_t i = 0; i < wheels_.size(); ++i)
    wheels_[i].load = std::max(params_.wheel_load(i, wheels_[i].static_load, shift), 0.0);
}

model::Planar<double> DoubleTrack::tire_force(Wheel& wheel, const model::Planar<double>& v) const noexcept {
  // Relaxed slips (docs/model.md, eq. 19), implicit in the slip: stable at any speed.
  const double rolling = std::fabs(v.x);
  const double slide = wheel.speed * params_.wheel_radius - v.x;
  const double gain_along = dt_ / params_.relaxation_along;
  const double gain_across = dt_ / params_.relaxation_across;
  wheel.slip_along =
      std::clamp((wheel.slip_along + gain_along * slide) / (1.0 + gain_along * rolling), -1.0, 1.0);
  wheel.slip_across =
      std::clamp((wheel.slip_across - gain_across * v.y) / (1.0 + gain_across * rolling), -1.0, 1.0);

  // Damping that keeps a standing tyre from ringing like a spring.
  const double damping = params_.creep_damping * std::max(1.0 - rolling / params_.creep_speed, 0.0);
  const double along = wheel.slip_along + damping * slide;
  const double across = wheel.slip_across - damping * v.y;

  // Combined slip by similarity (eq. 20).
  const double size = hypot(along, across);
  wheel.use = 0.0;
  if (size < 1e-9 || wheel.load <= 0.0) return {};
  constexpr double kLeastFriction = 0.1;  // keeps the force positive under any load; chosen
  const double friction = std::max(params_.grip(wheel.load, wheel.static_load), kLeastFriction);
  const double share = wheel.tire(size);
  wheel.use = size < wheel.peak_slip ? share : size / wheel.peak_slip;
  const double force = wheel.load * friction * disturbance_.grip * share;
  return {force * along / size, force * across / size};
}

void DoubleTrack::spin(Wheel& wheel, double force, double drive, double brake,
                       double speed_along) const noexcept {
  if (std::fabs(speed_along) > params_.abs_speed) {
    const double slip = -wheel.slip_along * (speed_along > 0.0 ? 1.0 : -1.0);
    brake *= model::torque_share<model::Sharp>(slip, params_.abs_slip_start, params_.abs_slip_end);
  }
  if (params_.has_traction_control()) {
    const double slip = wheel.slip_along * (speed_along < 0.0 ? -1.0 : 1.0);
    drive *= model::torque_share<model::Sharp>(slip, params_.traction_slip_start, params_.traction_slip_end);
  }
  const double resistance =
      brake + params_.rolling_resistance * wheel.load * params_.wheel_radius + wheel.friction;
  const double free = wheel.speed + dt_ * (drive - params_.wheel_radius * force) / params_.wheel_inertia;
  const double most = dt_ * resistance / params_.wheel_inertia;
  wheel.speed = std::fabs(free) <= most ? 0.0 : free - std::copysign(most, free);
}

void DoubleTrack::move() noexcept {
  const double c = cos(state_.psi);
  const double s = sin(state_.psi);
  const double cos_steer = cos(state_.steer);
  const double sin_steer = sin(state_.steer);
  const Vec2 v_B = in_body(velocity_, c, s);
  const double speed = velocity_.norm();

  constexpr double kLeastSpeed =
      1.0;  // [m/s] keeps force by power finite; chosen: below it the force is the limit
  const double drive_force = std::min(std::max(pedal_, 0.0) * params_.drive_force,
                                      params_.drive_power / std::max(std::fabs(v_B.x()), kLeastSpeed));
  const double brake_force = std::max(-pedal_, 0.0) * params_.brake_force;
  const Vec2 air = -params_.drag * speed * v_B;
  const auto sum = model::wheel_forces<double>(
      axles_, {v_B.x(), v_B.y()}, state_.r, cos_steer, sin_steer, {air.x(), air.y(), 0.0},
      [&](std::size_t i, const model::Axle& axle, const model::Planar<double>& v) {
        Wheel& wheel = wheels_[i];
        const model::Planar<double> rolling = i < 2 ? model::in_turned_axes(v, cos_steer, sin_steer) : v;
        const model::Planar<double> force = tire_force(wheel, rolling);
        wheel.friction = 0.5 * axle.drive_share * params_.drive_friction * params_.wheel_radius;
        spin(wheel, force.x, 0.5 * axle.drive_share * drive_force * params_.wheel_radius,
             0.5 * axle.brake_share * brake_force * params_.wheel_radius, rolling.x);
        output_.slip_angle[i] = -atan(wheel.slip_across);
        output_.slip_ratio[i] = wheel.slip_along;
        return force;
      });
  for (std::size_t axle = 0; axle < 2; ++axle) {
    const Wheel& left = wheels_[2 * axle];
    const Wheel& right = wheels_[2 * axle + 1];
    output_.tire_use[axle] =
        (left.load * left.use + right.load * right.use) / std::max(left.load + right.load, 1e-9);
  }

  const Vec2 a_B = Vec2{sum.x, sum.y + params_.mass * disturbance_.side_acceleration} / params_.mass;
  transfer_ += (dt_ / params_.load_lag) * (a_B - transfer_);
  velocity_ += dt_ * in_world(a_B, c, s);
  state_.r += dt_ * sum.moment / params_.yaw_inertia;
  state_.x += dt_ * velocity_.x();
  state_.y += dt_ * velocity_.y();
  state_.psi += dt_ * state_.r;
  const Vec2 v_after = in_body(velocity_, cos(state_.psi), sin(state_.psi));
  state_.vx = v_after.x();
  state_.vy = v_after.y();
  output_.ax = a_B.x();
  output_.ay = a_B.y();
  output_.speed = velocity_.norm();
}

std::array<Vec2, 4> DoubleTrack::contact_points() const noexcept {
  const double edge = params_.half_track() + params_.half_tire();
  return {Vec2{params_.front_axle, edge}, Vec2{params_.front_axle, -edge}, Vec2{-params_.rear_axle, edge},
          Vec2{-params_.rear_axle, -edge}};
}

}  // namespace chicane::sim
