// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <memory>

#include "chicane/base/vec2.hpp"
#include "chicane/model/state.hpp"

/// Interface of the simulated cars, and the quantities that they take and give.

namespace chicane::sim {

/// Quantities of a plant that are not in its state, for displays, reports and telemetry.
struct PlantOutput {
  double ax = 0.0;                     ///< acceleration of the centre of mass along B's x [m/s²]
  double ay = 0.0;                     ///< acceleration along B's y, centripetal part included [m/s²]
  double speed = 0.0;                  ///< |velocity| [m/s]
  double throttle = 0.0;               ///< accelerator as telemetry reports it, [0, 1]: braking reads 0
  std::array<double, 4> slip_angle{};  ///< front left, front right, rear left, rear right [rad]
  std::array<double, 4> slip_ratio{};  ///< forward slip over speed, in the same order
  /// Share of the grip that an axle uses, front and rear, wheels weighted by load: force over peak force up
  /// to the slip of the peak, and beyond it slip over that slip. 1 is the limit, more is sliding.
  std::array<double, 2> tire_use{};
};

/// Deviation of a plant from its nominal parameters, unknown to a controller.
struct PlantDeviation {
  double friction_scale = 1.0;  ///< factor of all tyre forces
  double mass_scale = 1.0;      ///< factor of mass and yaw inertia of the body
};

/// External disturbance of a plant (sim/fault.hpp).
struct Disturbance {
  double grip = 1.0;               ///< factor of all tyre forces, beside any lasting deviation; > 0
  double side_acceleration = 0.0;  ///< push along B's y [m/s²]
};

/// A simulated car: tyres, drive, brakes, actuators. It is not the model of a controller. Deterministic,
/// without allocation, with a fixed physics step. One thread at a time; plants share nothing. Returned
/// references are valid until the next advance() or reset().
class Plant {
 public:
  virtual ~Plant() = default;
  [[nodiscard]] virtual double step_length() const noexcept = 0;  ///< [s]
  /// Puts the car at `pose` in W, moving forward with `speed` [m/s], wheels rolling freely.
  virtual void reset(const model::Pose& pose, double speed) noexcept = 0;
  /// Sets velocity in B [m/s] and yaw rate [rad/s], with wheels rolling freely.
  virtual void set_motion(const Vec2& velocity, double yaw_rate) noexcept = 0;
  /// Changes the deviation from the nominal car, from the next step on. Place and speed stay.
  virtual void deviate(const PlantDeviation& deviation) noexcept = 0;
  /// Sets the disturbance, from the next step on until the next call; survives reset().
  virtual void disturb(const Disturbance& /*disturbance*/) noexcept {}
  /// Makes one physics step, with `command` acting on the actuators from its beginning. Accepts any command,
  /// also one that is not finite, and clamps it.
  virtual void advance(const model::Command& command) noexcept = 0;
  [[nodiscard]] virtual const model::State& state() const noexcept = 0;
  [[nodiscard]] virtual const PlantOutput& output() const noexcept = 0;
  /// Outer corners of the contact patches in B [m]: front left, front right, rear left, rear right.
  [[nodiscard]] virtual std::array<Vec2, 4> contact_points() const noexcept = 0;
  /// A copy in the same state; null if this plant, and so a run with it, cannot be copied.
  [[nodiscard]] virtual std::unique_ptr<Plant> copy() const { return nullptr; }
};

}  // namespace chicane::sim
