// SPDX-License-Identifier: MIT
// Option rows of a car's parameters, its longitudinal model (acceleration by pedal, pedal by acceleration),
// and the parameters of two shipped cars.
#include "chicane/model/vehicle.hpp"

#include <algorithm>

namespace chicane::model {

namespace {

using P = VehicleParams;
constexpr std::array kOptions{
    option<&P::name>("name", "Name in reports."),
    option<&P::scale>("scale", unit::kNone, 0.005, 1,
                      "Scale of a model car, 0.1 for 1:10; its settings are those of the car in full size."),
    option<&P::front_axle>("front_axle", unit::kMetre, 0.01, 10, "Centre of mass to front axle."),
    option<&P::rear_axle>("rear_axle", unit::kMetre, 0.01, 10, "Centre of mass to rear axle."),
    option<&P::track_width>("track_width", unit::kMetre, 0.01, 10,
                            "Distance between the centres of the wheels of an axle."),
    option<&P::tire_width>("tire_width", unit::kMetre, 0, 2, "Width of a contact patch."),
    option<&P::length>("length", unit::kMetre, 0.01, 30, "Length of the body."),
    option<&P::width>("width", unit::kMetre, 0.01, 10, "Width of the body."),
    option<&P::kinematic_length>("kinematic_length", unit::kMetre, 0.01, 20, "L_f of the described model."),
    option<&P::mass>("mass", unit::kKilogram, 1e-3, 1e5, "Mass, wheels included."),
    option<&P::yaw_inertia>("yaw_inertia", unit::kInertia, 1e-8, 1e6,
                            "Moment of inertia about the vertical axis."),
    option<&P::height>("height", unit::kMetre, 0, 5,
                       "Centre of mass above the road; 0 means no load transfer."),
    option<&P::steer_limit>("steer_limit", unit::kDegree, 0.1, 80, "Largest road-wheel angle."),
    option<&P::steer_rate_limit>("steer_rate_limit", unit::kDegreePerSecond, 1, 1e4,
                                 "Fastest change of the road-wheel angle.")
        .or_infinite(),
    option<&P::steer_lag>("steer_lag", unit::kMillisecond, 0, 1000,
                          "Time constant of the steering; 0 is instant."),
    option<&P::cornering_front>("cornering_front", unit::per("1/rad"), 0.1, 200,
                                "Lateral force over load for each radian of slip, front."),
    option<&P::cornering_rear>("cornering_rear", unit::per("1/rad"), 0.1, 200,
                               "Lateral force over load for each radian of slip, rear."),
    option<&P::friction>("friction", unit::kNone, 0.01, 5, "Peak force of a tyre over its load."),
    option<&P::friction_coupling>(
        "friction_coupling", unit::kNone, 0, 1,
        "1 where braking and cornering share the tyre's force, 0 where they do not."),
    option<&P::load_constant>("load_constant", unit::kAcceleration, 0.1, 100, "Normal acceleration at rest."),
    option<&P::load_per_speed>("load_per_speed", unit::per("1/s"), 0, 10,
                               "Growth of the normal acceleration with speed: downforce."),
    option<&P::load_quadratic>("load_quadratic", unit::per("1/m"), 0, 1,
                               "Growth of the normal acceleration with the square of the speed."),
    option<&P::load_balance>("load_balance", unit::kNone, -1, 1,
                             "Share of the front axle in that growth, less its share at rest."),
    option<&P::steer_helper>("steer_helper", unit::kNone, 0, 0.99,
                             "Share of each yaw change by which the velocity turns along; 0 for a real car."),
    option<&P::helper_gap>(
        "helper_gap", unit::kMillisecond, 0, 100,
        "Time for which the steer helper does nothing when the heading passes +y; 0: never."),
    option<&P::drive_acceleration>("drive_acceleration", unit::kAcceleration, 0.01, 100,
                                   "Acceleration at full throttle and rest."),
    option<&P::drive_power_per_mass>("drive_power_per_mass", unit::kPowerPerMass, 0.1, 1e5,
                                     "Cap of drive acceleration times speed.")
        .or_infinite(),
    option<&P::drag_constant>("drag_constant", unit::kAcceleration, 0, 1000,
                              "Rolling resistance, and friction of motor and gears."),
    option<&P::drag_driven>("drag_driven", unit::kAcceleration, 0, 1000,
                            "Part of that on the driven wheels alone: friction of motor and gears."),
    option<&P::drag_linear>("drag_linear", unit::per("1/s"), 0, 10, "Deceleration for each m/s."),
    option<&P::drag_quadratic>("drag_quadratic", unit::per("1/m"), 0, 1, "Deceleration for each (m/s)²."),
    option<&P::brake_acceleration>(
        "brake_acceleration", unit::kAcceleration, 0.01, 1000,
        "Deceleration for each unit of negative throttle, before the wheels lock."),
    option<&P::brake_throttle_limit>("brake_throttle_limit", unit::kNone, 0.001, 1,
                                     "Largest useful negative throttle; beyond it the wheels lock."),
    option<&P::drive_lag>("drive_lag", unit::kMillisecond, 0, 5000, "Time constant of drive and brake."),
    option<&P::valid_speed>("valid_speed", unit::kSpeed, 0.1, 200,
                            "Speed up to which the car's parameters hold: no plan is faster, and the guard "
                            "cuts the drive at 5 % more.")
        .or_infinite(),
    option<&P::brake_share_front>("brake_share_front", unit::kNone, 0, 1,
                                  "Share of the front wheels in the braking force."),
    option<&P::roll_share_front>(
        "roll_share_front", unit::kNone, 0, 1,
        "Share of the front axle in the load that moves to the outer wheels in a bend."),
    option<&P::drive_share_front>("drive_share_front", unit::kNone, 0, 1,
                                  "Share of the front wheels in the drive force."),
    option<&P::load_sensitivity>("load_sensitivity", unit::kNone, 0, 0.5,
                                 "Share of the friction that a tyre loses when its load doubles."),
    option<&P::tire_shape>("tire_shape", unit::kNone, 0, 2.5,
                           "C of the magic formula; 0: the original simulator's curve."),
    option<&P::reverse_speed>("reverse_speed", unit::kSpeed, 0, 10,
                              "Below it a negative throttle is the reverse gear; 0 where it never is."),
    option<&P::reverse_acceleration>("reverse_acceleration", unit::kAcceleration, 0.01, 100,
                                     "Acceleration backwards for each unit of negative throttle then."),
    option<&P::brake_latch_speed>(
        "brake_latch_speed", unit::kSpeed, 0, 10,
        "Brakes applied down to this speed stay applied until they are released; 0: they "
        "follow the pedal."),
    option<&P::brake_release_throttle>("brake_release_throttle", unit::kNone, -1, 0,
                                       "Throttle that releases latched brakes."),
};

/// Deceleration by drag at speed v [m/s²], with the sign of v.
double drag(const VehicleParams& p, double v) noexcept {
  const double direction = v > 0.0 ? 1.0 : (v < 0.0 ? -1.0 : 0.0);
  return direction * p.drag_constant + p.drag_linear * v + p.drag_quadratic * v * std::fabs(v);
}

/// Largest acceleration by the drive at speed v [m/s²].
double drive_limit(const VehicleParams& p, double v) noexcept {
  const double by_power = v > 0.0 ? p.drive_power_per_mass / v : std::numeric_limits<double>::infinity();
  return std::min(p.drive_acceleration, by_power);
}

}  // namespace

std::span<const Option> vehicle_options() noexcept { return kOptions; }

Result<void> validate(const VehicleParams& params) { return check_options("vehicle", kOptions, &params); }

double lowest_throttle(const VehicleParams& p, double v) noexcept {
  return v < p.reverse_speed ? -1.0 : -p.brake_throttle_limit;
}

double longitudinal_acceleration(const VehicleParams& p, double throttle, double v) noexcept {
  const double pedal = std::clamp(throttle, lowest_throttle(p, v), 1.0);  // below the lowest the wheels lock
  const double negative = v < p.reverse_speed ? p.reverse_acceleration : p.brake_acceleration;
  const double force =
      pedal >= 0.0 ? std::min(p.drive_acceleration * pedal, drive_limit(p, v)) : negative * pedal;
  return force - drag(p, v);
}

double throttle_for(const VehicleParams& p, double acceleration, double v) noexcept {
  const double force = acceleration + drag(p, v);
  if (std::isnan(force)) return 0.0;
  if (force < 0.0) {
    const double negative = v < p.reverse_speed ? p.reverse_acceleration : p.brake_acceleration;
    return std::max(force / negative, lowest_throttle(p, v));
  }
  return std::min(force / p.drive_acceleration, 1.0);
}

double throttle_to_rest(const VehicleParams& p, double acceleration, double v) noexcept {
  const double rest_time = kRestTime * std::sqrt(p.scale);
  return std::min(throttle_for(p, std::max(acceleration, -std::max(v, 0.0) / rest_time), v), 0.0);
}

VehicleParams udacity_params() {
  VehicleParams p;
  p.helper_gap = 0.02;
  return p;
}

double VehicleParams::cornering_friction() const noexcept {
  const auto lost = [&](double other_axle, double share) {
    const double load = load_constant * other_axle / wheelbase();
    const double shift = 2.0 * height * share / track_width * (friction * load_constant) / load;
    return load_sensitivity * shift * shift * other_axle / wheelbase();
  };
  return friction * (1.0 - lost(rear_axle, roll_share_front) - lost(front_axle, 1.0 - roll_share_front));
}

VehicleParams road_car_params() {
  VehicleParams p;
  static_cast<CarBody&>(p) = {};
  p.name = "road-car";
  p.tire_shape = 1.5;
  p.reverse_speed = 0.0;
  p.brake_latch_speed = 0.0;
  p.length = 4.30;
  p.width = 1.80;
  p.kinematic_length = 2.70;
  p.cornering_front = 16.2;
  p.cornering_rear = 18.0;
  p.friction_coupling = 1.0;
  p.load_constant = 9.81;
  p.load_per_speed = 0.0;
  p.steer_helper = 0.0;
  p.drive_acceleration = 5.35;
  p.drive_power_per_mass = 148.0;
  p.drag_constant = 0.123;
  p.drag_linear = 0.0;
  p.drag_quadratic = 2.9e-4;
  p.brake_acceleration = 9.14;
  p.brake_throttle_limit = 1.0;
  return p;
}

}  // namespace chicane::model
