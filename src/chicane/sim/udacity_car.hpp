// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>

#include "chicane/base/vec2.hpp"
#include "chicane/model/wheel_forces.hpp"
#include "chicane/sim/plant.hpp"

namespace chicane::sim {

/// The original simulator's car as its scene and scripts define it (udacity/self-driving-car-sim v1.45:
/// Car.prefab, CarController.cs; PhysX 3 vehicle defaults). Origin of all: docs/model.md, table 1.
struct UdacityCarParams {
  double mass = 1000.0;         ///< rigid body without wheels [kg]
  double yaw_inertia = 1600.0;  ///< [kg m²]
  double linear_drag = 0.1;     ///< velocity times (1 − linear_drag · dt) each step [1/s]
  double angular_drag = 0.05;   ///< yaw rate likewise [1/s]
  double gravity = 9.81;        ///< [m/s²]
  double downforce = 100.0;     ///< per speed [N s/m]

  double front_axle = 1.27;     ///< centre of mass to front wheels [m]
  double rear_axle = 1.60;      ///< [m]
  double half_track = 1.0;      ///< [m]
  double half_tire = 0.10;      ///< half the width of a contact patch [m]
  double front_radius = 0.335;  ///< [m]
  double rear_radius = 0.37;    ///< [m]
  double wheel_mass = 20.0;     ///< each; inertia ½ m r² [kg]
  double wheel_damping = 0.25;  ///< [N m s]

  model::FrictionCurve forward{0.4, 1.0, 0.8, 0.5};
  model::FrictionCurve sideways{0.2, 1.0, 0.5, 0.75};
  double friction_scale = 1.0;  ///< both curves times this
  double load_filter_offset =
      0.2308;  ///< filtered load = rest load · (offset + (3 − offset)/3 · load / rest load)
  double lateral_speed_offset = 1.0;  ///< slip angle = atan(v_lat / (|v_long| + this)) [m/s]
  double driven_speed_offset =
      0.1;  ///< forward slip of a driven or braked wheel: denominator plus this [m/s]
  double rolling_speed_floor = 4.0;  ///< forward slip of a free wheel: denominator at least this [m/s]

  double steer_limit = 0.4363323129985824;  ///< 25° [rad]
  double steer_helper = 0.774;
  double drive_torque = 2000.0;             ///< torque over all wheels [N m]
  double reverse_torque = 150.0;            ///< each wheel [N m]
  double brake_torque = 20000.0;            ///< each wheel at throttle −1 [N m]
  double slip_limit = 0.4;                  ///< forward slip that traction control takes torque away for
  double torque_ramp = 10.0;                ///< traction control's change of torque per wheel and step [N m]
  double brake_speed = 5.0 / 2.23693629;    ///< braking above, reverse drive below: 5 mph [m/s]
  double brake_angle = 0.8726646259971648;  ///< braking only if the velocity is within 50° of forward [rad]
  double speed_cap = 200.0 / 2.23693629;    ///< 200 mph [m/s]
};

/// The plant `udacity`: planar, four wheels that spin on their own, friction curves of PhysX, 50 Hz.
///
/// One step does, in the order of CarController.Move and FixedUpdate: clamp; front wheels to the angle asked
/// for at once; steer helper (velocity turned by 0.774 of the last yaw change, skipped when the original's
/// yaw angle wraps); drive torque, brake or reverse with the original's quirk that a brake held down to 5 mph
/// stays on until the throttle goes negative; speed cap; downforce; traction control; tyres. Tyre forces and
/// wheel speeds advance in four parts of 5 ms, the force implicit in the wheel speed (docs/model.md,
/// eq. 15), because one explicit step of 20 ms is unstable below 8 m/s. No roll, pitch or load transfer: the
/// centre of mass lies 0.06 m above the road.
class UdacityCar final : public Plant {
 public:
  static constexpr std::string_view kName = "udacity";
  static constexpr std::string_view kMeaning =
      "the original simulator's car: torque ramp, locking wheels, steer helper; 50 Hz";
  static constexpr double kStepLength = 0.02;  ///< [s]
  static constexpr int kParts = 4;

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
    Vec2 position{};  ///< position in B [m]
    double radius = 0.0;
    double inertia = 0.0;
    double load = 0.0;  ///< filtered, in this step [N]
    double load_share = 0.0;
    double speed = 0.0;  ///< [rad/s]
    double drive = 0.0;  ///< torque [N m]
    double brake = 0.0;  ///< torque, >= 0 [N m]
    double slip_angle = 0.0;
    double slip_ratio = 0.0;
  };

  void help_steering() noexcept;
  void apply_pedal(double pedal) noexcept;
  void control_traction() noexcept;
  void load_wheels() noexcept;
  void move(double dt) noexcept;
  [[nodiscard]] double forward_force(Wheel& wheel, double speed_along, double dt) const noexcept;
  void publish(const Vec2& velocity_before, double pedal) noexcept;

  UdacityCarParams nominal_;
  UdacityCarParams params_;  ///< parameters of this car, which may deviate
  Disturbance disturbance_;
  std::array<Wheel, 4> wheels_{};
  Vec2 velocity_{};            ///< velocity in W [m/s]
  double drive_torque_ = 0.0;  ///< allowed by traction control, over all wheels [N m]
  double psi_before_ = 0.0;    ///< yaw when the helper last looked [rad]
  model::State state_;
  PlantOutput output_;
};

}  // namespace chicane::sim
