// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>

#include "chicane/base/vec2.hpp"
#include "chicane/model/wheel_forces.hpp"
#include "chicane/sim/plant.hpp"

/// The plant that moves like the car of the original simulator.

namespace chicane::sim {

/// Parameters of the original simulator's car as its scene and scripts define them
/// (udacity/self-driving-car-sim v1.45: Car.prefab, CarController.cs; PhysX 3 vehicle defaults). Origin of
/// each: docs/model.md, table 1.
struct UdacityCarParams {
  double mass = 1000.0;         ///< rigid body without wheels [kg]
  double yaw_inertia = 1600.0;  ///< [kg m²]
  double linear_drag = 0.1;     ///< share of the velocity lost per time [1/s]
  double angular_drag = 0.05;   ///< share of the yaw rate lost per time [1/s]
  double gravity = 9.81;        ///< [m/s²]
  double downforce = 100.0;     ///< downforce over speed [N s/m]

  double front_axle = 1.27;     ///< centre of mass to front wheels [m]
  double rear_axle = 1.60;      ///< centre of mass to rear wheels [m]
  double half_track = 1.0;      ///< centre line to the middle of a wheel [m]
  double half_tire = 0.10;      ///< half the width of a contact patch [m]
  double front_radius = 0.335;  ///< radius of a front wheel [m]
  double rear_radius = 0.37;    ///< radius of a rear wheel [m]
  double wheel_mass = 20.0;     ///< mass of a wheel; its inertia is ½ m r² [kg]
  double wheel_damping = 0.25;  ///< braking torque of a wheel over its speed [N m s]

  model::FrictionCurve forward{0.4, 1.0, 0.8, 0.5};    ///< longitudinal force over load, by forward slip
  model::FrictionCurve sideways{0.2, 1.0, 0.5, 0.75};  ///< lateral force over load, by slip angle
  double friction_scale = 1.0;                         ///< factor of both curves
  /// Offset of the load filter: load on a tyre = rest load · (offset + (3 − offset)/3 · load / rest load).
  double load_filter_offset = 0.2308;
  double lateral_speed_offset = 1.0;  ///< offset v₀ in slip angle = atan(v_lat / (|v_long| + v₀)) [m/s]
  double driven_speed_offset = 0.1;  ///< addition to the denominator of a driven or braked wheel's slip [m/s]
  double rolling_speed_floor = 4.0;  ///< least denominator of a rolling wheel's slip [m/s]

  double steer_limit = 0.4363323129985824;  ///< largest road-wheel angle, 25° [rad]
  double steer_helper = 0.774;              ///< share of a yaw change by which the velocity turns along
  double drive_torque = 2000.0;             ///< drive torque of all wheels [N m]
  double reverse_torque = 150.0;            ///< torque of each wheel in reverse [N m]
  double brake_torque = 20000.0;            ///< brake torque of each wheel at throttle −1 [N m]
  double slip_limit = 0.4;                  ///< forward slip from which traction control reduces the torque
  double torque_ramp = 10.0;                ///< change of torque by traction control per wheel and step [N m]
  double brake_speed = 5.0 / 2.23693629;    ///< speed between braking and reverse drive, 5 mph [m/s]
  double brake_angle = 0.8726646259971648;  ///< largest angle of the velocity for braking, 50° [rad]
  double speed_cap = 200.0 / 2.23693629;    ///< largest speed, 200 mph [m/s]
};

/// The plant `udacity`: planar, four wheels that spin on their own, friction curves of PhysX, 50 Hz.
///
/// One step, in the order of CarController.Move and FixedUpdate:
///
/// 1. The command is clamped; the front wheels turn at once.
/// 2. The steer helper turns the velocity by 0.774 of the last yaw change, except when the original's yaw
///    angle wraps.
/// 3. The pedal gives drive torque, brake or reverse drive. As in the original, a brake held down to 5 mph
///    stays on until the throttle is negative again.
/// 4. Speed cap, downforce, traction control.
/// 5. Tyre forces and wheel speeds advance in four parts of 5 ms, the force implicit in the wheel speed
///    (docs/model.md, eq. 15), because one explicit step of 20 ms is unstable below 8 m/s.
///
/// No roll, pitch or load transfer: the centre of mass lies 0.06 m above the road.
class UdacityCar final : public Plant {
 public:
  static constexpr std::string_view kName = "udacity";
  static constexpr std::string_view kMeaning =
      "the original simulator's car: torque ramp, locking wheels, steer helper; 50 Hz";
  static constexpr double kStepLength = 0.02;  ///< [s]
  static constexpr int kParts = 4;             ///< parts of a step

  explicit UdacityCar(const UdacityCarParams& params = {}) noexcept;

  [[nodiscard]] double step_length() const noexcept override { return kStepLength; }
  /// Resets the car. From standstill the drive torque starts at 0, as when the scene starts; at speed > 0 it
  /// starts in full.
  void reset(const model::Pose& pose, double speed) noexcept override;
  void set_motion(const Vec2& velocity, double yaw_rate) noexcept override;
  void deviate(const PlantDeviation& deviation) noexcept override;
  void disturb(const Disturbance& disturbance) noexcept override { disturbance_ = disturbance; }
  void advance(const model::Command& command) noexcept override;
  [[nodiscard]] const model::State& state() const noexcept override { return state_; }
  [[nodiscard]] const PlantOutput& output() const noexcept override { return output_; }
  [[nodiscard]] std::array<Vec2, 4> contact_points() const noexcept override;
  [[nodiscard]] std::unique_ptr<Plant> copy() const override { return std::make_unique<UdacityCar>(*this); }

 private:
  struct Wheel {
    Vec2 position{};          ///< position in B [m]
    double radius = 0.0;      ///< [m]
    double inertia = 0.0;     ///< [kg m²]
    double load = 0.0;        ///< filtered load in this step, times friction and grip [N]
    double load_share = 0.0;  ///< share of the car's load
    double speed = 0.0;       ///< [rad/s]
    double drive = 0.0;       ///< drive torque [N m]
    double brake = 0.0;       ///< brake torque, >= 0 [N m]
    double slip_angle = 0.0;  ///< [rad]
    double slip_ratio = 0.0;  ///< forward slip
  };

  /// Turns the velocity along with the body.
  void help_steering() noexcept;
  /// Sets the drive and brake torques of the wheels.
  void apply_pedal(double pedal) noexcept;
  /// Raises or lowers the drive torque by the slip of each wheel.
  void control_traction() noexcept;
  /// Sets the loads of the wheels by weight and downforce.
  void load_wheels() noexcept;
  /// Moves wheels and body by dt [s].
  void move(double dt) noexcept;
  /// Longitudinal force of a wheel [N] at a speed along its plane [m/s]; turns the wheel by dt [s].
  [[nodiscard]] double forward_force(Wheel& wheel, double speed_along, double dt) const noexcept;
  /// Updates state and output at the end of a step; `velocity_before`: velocity in W at its begin [m/s].
  void publish(const Vec2& velocity_before, double pedal) noexcept;

  UdacityCarParams nominal_;  ///< parameters before deviate()
  UdacityCarParams params_;   ///< parameters of this car, which may deviate
  Disturbance disturbance_;
  std::array<Wheel, 4> wheels_{};  ///< front left, front right, rear left, rear right
  Vec2 velocity_{};                ///< velocity in W [m/s]
  double drive_torque_ = 0.0;      ///< torque that traction control permits, over all wheels [N m]
  double psi_before_ = 0.0;        ///< yaw at the last call of help_steering() [rad]
  model::State state_;
  PlantOutput output_;
};

}  // namespace chicane::sim
