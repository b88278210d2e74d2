// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <memory>

#include "chicane/base/vec2.hpp"
#include "chicane/model/state.hpp"

namespace chicane::sim {

/// What an observer can see of a plant beside its state.
struct PlantOutput {
  double ax = 0.0;                     ///< acceleration of the centre of mass along B's x [m/s²]
  double ay = 0.0;                     ///< along B's y, centripetal part included [m/s²]
  double speed = 0.0;                  ///< |velocity| [m/s]
  double throttle = 0.0;               ///< accelerator as telemetry reports it, [0, 1]: braking reads 0
  std::array<double, 4> slip_angle{};  ///< front left, front right, rear left, rear right [rad]
  std::array<double, 4> slip_ratio{};
  /// Share of its grip that each axle uses, front and rear, wheels weighted by their load: force over peak up
  /// to the slip of the peak, slip over that slip beyond it. 1 is all there is, more is sliding.
  std::array<double, 2> tire_use{};
};

/// How a plant differs from its nominal self, unknown to a controller.
struct PlantDeviation {
  double friction_scale = 1.0;  ///< all tyre forces times this
  double mass_scale = 1.0;      ///< mass and yaw inertia of the body times this
};

/// What happens to a plant from outside (sim/fault.hpp).
struct Disturbance {
  double grip = 1.0;               ///< all tyre forces times this, beside any lasting deviation; > 0
  double side_acceleration = 0.0;  ///< push along B's y [m/s²]
};

/// The car that answers back: tyres, drive, brakes, actuators. Not the model of a controller.
/// Deterministic, allocation-free. Fixed physics step. One thread at a time; plants share nothing. References
/// it returns are to what changes with the next advance() or reset().
class Plant {
 public:
  virtual ~Plant() = default;
  [[nodiscard]] virtual double step_length() const noexcept = 0;  ///< [s]
  /// Stands the car at `pose` in W, moving forward with `speed` [m/s], wheels rolling freely.
  virtual void reset(const model::Pose& pose, double speed) noexcept = 0;
  /// It slides and turns from now on: velocity in B [m/s], yaw rate [rad/s]. Its wheels roll as fast as it
  /// moves along.
  virtual void set_motion(const Vec2& velocity, double yaw_rate) noexcept = 0;
  /// Another deviation from the nominal car from the next step on; the car stays where it is, as fast as it
  /// is.
  virtual void deviate(const PlantDeviation& deviation) noexcept = 0;
  /// Acts from the next step on, until the next call; survives reset().
  virtual void disturb(const Disturbance& /*disturbance*/) noexcept {}
  /// One physics step with `command` acting on the actuators from its beginning. Any command, also one
  /// that is not finite; clamped inside.
  virtual void advance(const model::Command& command) noexcept = 0;
  [[nodiscard]] virtual const model::State& state() const noexcept = 0;
  [[nodiscard]] virtual const PlantOutput& output() const noexcept = 0;
  /// Outer corners of the contact patches in B [m]: front left, front right, rear left, rear right.
  [[nodiscard]] virtual std::array<Vec2, 4> contact_points() const noexcept = 0;
  /// Another one in the same state; null: this plant cannot be copied, nor a run with it.
  [[nodiscard]] virtual std::unique_ptr<Plant> copy() const { return nullptr; }
};

[[nodiscard]] inline std::unique_ptr<Plant> copy_of(const Plant& plant) { return plant.copy(); }

}  // namespace chicane::sim
