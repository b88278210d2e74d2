// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>

#include "chicane/base/option.hpp"
#include "chicane/base/result.hpp"
#include "chicane/model/state.hpp"

/// Parameters of a car, its longitudinal model, and the conversion of model cars to full size.

namespace chicane::model {

/// An axle: its position, and its shares of the car's loads and forces.
struct Axle {
  double x;            ///< position ahead of the centre of mass [m]
  double half_track;   ///< distance from its middle to the centre of a wheel [m]
  double rest;         ///< load of each of its wheels at rest, over the car's
  double roll_share;   ///< share of the load moved to the outer wheels in a bend
  double drive_share;  ///< share of the drive force
  double brake_share;  ///< share of the braking force
};

/// Parameters that plants and controllers' models share. Defaults are for an ordinary car, the plant
/// `road-car`; origin of each number: docs/model.md, table 2.
struct CarBody {
  double front_axle = 1.25;        ///< centre of mass to front axle [m]
  double rear_axle = 1.45;         ///< centre of mass to rear axle [m]
  double track_width = 1.60;       ///< distance between the wheel centres of an axle [m]
  double tire_width = 0.205;       ///< width of a contact patch [m]
  double mass = 1300.0;            ///< [kg]
  double yaw_inertia = 2000.0;     ///< [kg m²]
  double height = 0.50;            ///< height of the centre of mass; 0: no load transfer [m]
  double roll_share_front = 0.58;  ///< front share of the load moved across in a bend
  /// Front share of braking; up to 0.9 g the front wheels lock first, as UN R13-H demands of road cars.
  double brake_share_front = 0.72;
  double drive_share_front = 0.40;          ///< front share of the drive; open differentials
  double friction = 1.20;                   ///< peak force over load, at rest
  double load_sensitivity = 0.08;           ///< share of the friction that a tyre loses when its load doubles
  double steer_limit = 0.4363323129985824;  ///< largest road-wheel angle, 25° [rad]
  double steer_rate_limit = 1.5707963267948966;  ///< largest rate of the wheel angle, 90°/s [rad/s]
  double steer_lag = 0.05;                       ///< time constant of the steering [s], 0 = instant
  double drive_lag = 0.1;                        ///< time constant of drive and brakes [s]

  [[nodiscard]] double wheelbase() const noexcept { return front_axle + rear_axle; }
  [[nodiscard]] double half_track() const noexcept { return 0.5 * track_width; }
  [[nodiscard]] double half_tire() const noexcept { return 0.5 * tire_width; }
  /// The front axle, then the rear one.
  [[nodiscard]] std::array<Axle, 2> axles() const noexcept {
    return {Axle{front_axle, half_track(), 0.5 * rear_axle / wheelbase(), roll_share_front, drive_share_front,
                 brake_share_front},
            Axle{-rear_axle, half_track(), 0.5 * front_axle / wheelbase(), 1.0 - roll_share_front,
                 1.0 - drive_share_front, 1.0 - brake_share_front}};
  }

  friend bool operator==(const CarBody&, const CarBody&) = default;
};

/// A controller's model of a car: geometry, a single track with saturating tyres, and a longitudinal
/// law. The simulator's plants are richer (sim/plant.hpp). Values of shipped cars: data/cars/*.yaml, each
/// with its origin.
struct VehicleParams : CarBody {
  VehicleParams()
      : CarBody{.front_axle = 1.27,
                .rear_axle = 1.60,
                .track_width = 2.0,
                .tire_width = 0.20,
                .mass = 1000.0,
                .yaw_inertia = 1600.0,
                .height = 0.0,
                .roll_share_front = 0.5,
                .brake_share_front = 0.5,
                .drive_share_front = 0.5,
                .friction = 1.08,
                .load_sensitivity = 0.0,
                .steer_rate_limit = std::numeric_limits<double>::infinity(),
                .steer_lag = 0.0,
                .drive_lag = 0.0} {}

  std::string name = "udacity";

  double scale = 1.0;  ///< scale of a model car, 0.1 for 1:10: settings of controller and guard in metres and
                       ///< seconds are for the car in full size (Similarity)

  // Geometry.
  double length = 4.47;            ///< length of the body [m]
  double width = 2.43;             ///< width of the body [m]
  double kinematic_length = 2.67;  ///< L_f of the kinematic model ψ' = v δ / L_f [m]

  // Tyres: force = load · friction · curve(cornering · slip / friction), load = mass · (load_0 + load_v · v +
  // load_vv · v²) by axle (docs/controller.md, eq. 4a–4c).
  double cornering_front = 5.0;  ///< cornering stiffness over load, front [1/rad]
  double cornering_rear = 4.92;  ///< cornering stiffness over load, rear [1/rad]
  double tire_shape = 0.0;       ///< C of the magic formula; 0: the original simulator's curve
  double friction_coupling =
      0.0;  ///< 1: friction ellipse (a real tyre), 0: braking and cornering share no force
  double load_constant = 12.22;    ///< normal acceleration at rest [m/s²]
  double load_per_speed = 0.0923;  ///< growth of the load with speed (downforce) [1/s]
  double load_quadratic = 0.0;     ///< growth of the load with squared speed [1/m]
  double load_balance = 0.0;       ///< share of the front axle in that growth, less its share at rest
  double steer_helper =
      0.768;                ///< share of each yaw change by which the velocity turns along; 0 = a real car
  double helper_gap = 0.0;  ///< gap of the helper when the heading passes +y [s] (actuator.hpp)

  // Longitudinal: a = drive_acceleration · throttle − drag_linear · v − drag_quadratic · v² for throttle >=
  // 0, and − brake_acceleration · |throttle| − drag for throttle < 0 (reverse_acceleration below
  // reverse_speed). Stated for v >= 0.
  double drive_acceleration = 5.43;  ///< at full throttle and rest [m/s²]
  /// Largest product of drive acceleration and v [W/kg].
  double drive_power_per_mass = std::numeric_limits<double>::infinity();
  double drag_constant = 0.0;         ///< deceleration by rolling resistance, motor and gears [m/s²]
  double drag_driven = 0.0;           ///< part of drag_constant that acts on the driven wheels alone [m/s²]
  double drag_linear = 0.104;         ///< deceleration over speed [1/s]
  double drag_quadratic = 0.0;        ///< deceleration over squared speed [1/m]
  double brake_acceleration = 218.0;  ///< deceleration over negative throttle, before the wheels lock [m/s²]
  double brake_throttle_limit = 0.04;  ///< negative throttle beyond which the wheels lock; 1: they never do
  /// Speed up to which these parameters hold; plans are no faster [m/s].
  double valid_speed = std::numeric_limits<double>::infinity();

  // The reverse gear.
  double reverse_speed =
      2.235;  ///< speed below which a negative throttle is the reverse gear [m/s]; 0: never
  double reverse_acceleration = 1.63;  ///< backward acceleration over negative throttle in reverse [m/s²]

  // Driving off again.
  /// Speed at which applied brakes latch: they stay applied, whatever the pedal does, until they are released
  /// [m/s]; 0: brakes follow the pedal.
  double brake_latch_speed = 2.235;
  /// Throttle that releases latched brakes when it is sent for one control period at or below
  /// brake_latch_speed.
  double brake_release_throttle = -0.01;

  /// Normal acceleration carried by the tyres at speed v [m/s²].
  [[nodiscard]] double load(double v) const noexcept {
    return load_constant + load_per_speed * v + load_quadratic * v * v;
  }
  /// Whether brakes that stopped the car have to be released before it drives off.
  [[nodiscard]] bool latches_brakes() const noexcept { return brake_latch_speed > 0.0; }
  /// Peak lateral force over load of the whole car: what load transfer to the outer wheels leaves of the
  /// friction (docs/controller.md, eq. 4f).
  [[nodiscard]] double cornering_friction() const noexcept;

  friend bool operator==(const VehicleParams&, const VehicleParams&) = default;
};

/// The fields with their units and ranges, for files and messages.
[[nodiscard]] std::span<const Option> vehicle_options() noexcept;

/// Checks all fields. kInvalidArgument "vehicle.mass_kg: got -900, expected a number in [0.1, 100000] kg" for
/// the first one outside its range.
[[nodiscard]] Result<void> validate(const VehicleParams& params);

/// Longitudinal acceleration [m/s²] of the car at speed v [m/s] for a throttle in [-1, 1], by the law in
/// VehicleParams, without lag.
[[nodiscard]] double longitudinal_acceleration(const VehicleParams& params, double throttle,
                                               double v) noexcept;

/// Lowest useful throttle at speed v [m/s]: -brake_throttle_limit, or -1 in the reverse gear.
[[nodiscard]] double lowest_throttle(const VehicleParams& params, double v) noexcept;

/// Throttle in [lowest_throttle, 1] whose acceleration at speed v [m/s] is nearest to `acceleration` [m/s²].
[[nodiscard]] double throttle_for(const VehicleParams& params, double acceleration, double v) noexcept;

/// Throttle, never positive, that brakes with `acceleration` [m/s²] at speed v [m/s] and brings the car to
/// rest without rolling back. The deceleration is at most v / kRestTime, so that braking ends gently.
[[nodiscard]] double throttle_to_rest(const VehicleParams& params, double acceleration, double v) noexcept;
inline constexpr double kRestTime = 0.4;  ///< time constant of the end of braking, in full size [s]; chosen

/// Model of the plant `udacity`, the original simulator's car: the defaults of VehicleParams, and the gap of
/// its helper. Fitted to the plant by `chicane_plant_report` (docs/model.md).
[[nodiscard]] VehicleParams udacity_params();
/// Model of the plant `road-car`, an ordinary car: 1300 kg, about 1.2 g, proportional brakes, 90°/s steering.
/// Derived from the plant's parameters (docs/model.md, eq. 23–27).
[[nodiscard]] VehicleParams road_car_params();

/// The same car on another surface: its tyres give `share` of their forces at the same slip. Pre: share > 0.
[[nodiscard]] inline VehicleParams with_grip(VehicleParams car, double share) {
  car.friction *= share;
  car.cornering_front *= share;
  car.cornering_rear *= share;
  return car;
}

/// Conversion of a model car to the same car in full size (docs/tracks.md, "Model cars"). Lengths grow by
/// λ = 1 / scale, times and speeds by √λ, forces by λ³; accelerations, friction and gravity stay, so that
/// both cars move alike. Controllers and guard drive a model car as the car in full size, for which their
/// settings in metres and seconds are stated. For a scale of 1 all factors are exactly 1.
class Similarity {
 public:
  explicit Similarity(double scale = 1.0) noexcept : length_{1.0 / scale}, time_{std::sqrt(1.0 / scale)} {}
  explicit Similarity(const VehicleParams& car) noexcept : Similarity{car.scale} {}

  [[nodiscard]] bool is_identity() const noexcept { return length_ == 1.0; }
  [[nodiscard]] double length() const noexcept { return length_; }  ///< full size over model size
  [[nodiscard]] double time() const noexcept { return time_; }      ///< full size over model size, of times
  [[nodiscard]] double speed() const noexcept { return time_; }     ///< full size over model size, of speeds

  /// The car in full size; its own scale is 1. Ratios, angles and accelerations stay.
  [[nodiscard]] VehicleParams full_size(VehicleParams car) const noexcept {
    for (double* length : {&car.front_axle, &car.rear_axle, &car.track_width, &car.tire_width, &car.length,
                           &car.width, &car.kinematic_length, &car.height})
      *length *= length_;
    const double mass = length_ * length_ * length_;
    car.scale = 1.0;
    car.mass *= mass;
    car.yaw_inertia *= mass * length_ * length_;
    car.steer_rate_limit /= time_;
    car.steer_lag *= time_;
    car.drive_lag *= time_;
    car.helper_gap *= time_;
    car.load_per_speed /= speed();
    car.load_quadratic /= length_;
    car.drive_power_per_mass *= speed();
    car.valid_speed *= speed();
    car.drag_linear /= time_;
    car.drag_quadratic /= length_;
    car.reverse_speed *= speed();
    car.brake_latch_speed *= speed();
    return car;
  }

  /// The measurement for the controller of the car in full size.
  [[nodiscard]] Measurement full_size(Measurement seen) const noexcept {
    seen.time *= time_;
    seen.x *= length_;
    seen.y *= length_;
    seen.speed *= speed();
    seen.delay *= time_;
    for (int i = 0; i < seen.waypoint_count; ++i) seen.waypoints[static_cast<std::size_t>(i)] *= length_;
    return seen;
  }

 private:
  double length_;  ///< length()
  double time_;    ///< time()
};

}  // namespace chicane::model
