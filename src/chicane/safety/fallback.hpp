// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "chicane/controller/controller.hpp"
#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"

namespace chicane::safety {

/// The command when a controller has no answer, for every controller: the one place where that is decided.
///
///     kShiftedPlan   last plan at most kPlanAge old, and not over: its command for the time that has come
///     kHoldAndBrake  less than kHoldAge since the last usable plan: along its path, braking gently
///     kBrake         otherwise: along its path, all useful braking
///
/// Along its path: the wheel as planned for the distance driven since, scaled to the present speed
/// (docs/guard.md, eq. 16); held where there was no plan. Braking gently: at least kGentleBraking, and enough
/// to stop where the plan ends. A speed that is not measured is extrapolated from the last one with half of
/// the braking asked for, so that a car without measurements brakes too long rather than too short.
///
/// Braking fades below kFadeSpeed, so that a car whose negative pedal drives backwards comes to rest instead.
/// Everything returned is finite and inside the vehicle's range, whatever came in. No allocation; one thread.
class Fallback {
 public:
  // Origins (chosen: by trial, see Guard):
  // - Derived: kFadeSpeed (just above the 2.2 m/s below which udacity's brake pedal is its reverse gear).
  // - Chosen, docs/how_it_works.md (rungs): kPlanAge, kHoldAge, kGentleBraking.
  static constexpr double kPlanAge = 0.5;        ///< [s]
  static constexpr double kHoldAge = 1.5;        ///< [s]
  static constexpr double kGentleBraking = 0.4;  ///< share of VehicleParams::brake_throttle_limit
  static constexpr double kFadeSpeed = 2.5;      ///< [m/s]

  struct Answer {
    model::Command command;
    controller::Rung rung = controller::Rung::kBrake;
  };

  explicit Fallback(const model::VehicleParams& vehicle) noexcept : vehicle_{vehicle} {}

  /// The controller answered: `plan` is what it intends, its first command is what it sends. Keeps the part
  /// of the plan before the first point that is not finite.
  void accept(const controller::Plan& plan) noexcept;

  /// The same of a controller that plans nothing: `command` acts from `time` [s] on, at `speed` [m/s].
  void accept(const model::Command& command, double time, double speed) noexcept;

  /// The controller did not: the command to act from `act_time` [s, clock of the run] on. An `act_time` that
  /// is not finite or runs backwards counts as 0.1 s after the one before; a speed that is not finite counts
  /// as fast.
  [[nodiscard]] Answer command(double act_time, const model::Measurement& now) noexcept;

  /// Another car's limits from now on; plan and steering stay.
  void set_vehicle(const model::VehicleParams& vehicle) noexcept { vehicle_ = vehicle; }
  /// Forgets plan and steering: a new run begins.
  void reset() noexcept { *this = Fallback{vehicle_}; }

 private:
  struct Intention {
    double time = 0.0;
    double distance = 0.0;  ///< along the plan [m]
    double speed = 0.0;     ///< [m/s]
    model::Command command;
  };
  void begin_plan() noexcept;
  void drive_on(double elapsed, double measured_speed) noexcept;
  [[nodiscard]] double steer_along_path() const noexcept;
  [[nodiscard]] double gentle_share() const noexcept;
  [[nodiscard]] const model::Command* planned(double time) const noexcept;

  model::VehicleParams vehicle_;
  std::array<Intention, controller::Plan::kCapacity> plan_{};
  int plan_size_ = 0;
  bool has_time_ = false;    ///< good_time_ and last_time_ hold something
  double good_time_ = 0.0;   ///< when the last usable plan began [s]
  double last_time_ = 0.0;   ///< act time of the last command [s]
  double last_steer_ = 0.0;  ///< of the last command [rad]
  double last_throttle_ = 0.0;
  double speed_ = 0.0;  ///< measured, or counted on from there [m/s]
  bool has_speed_ = false;
  double distance_ = 0.0;  ///< driven since the last usable plan began [m]
};

/// Acceleration that leads a car of speed `v` [m/s] to VehicleParams::valid_speed, and ends 5 % above it
/// [m/s²]. Controllers that follow a plan of that speed are a little faster now and then, and need drive in
/// bends; from 10 % above it `f1tenth` spins in a stop that was computed with its parameters.
[[nodiscard]] double drive_to_valid_speed(const model::VehicleParams& vehicle, double v) noexcept;

/// The only way to an actuator: whatever is asked, what leaves is finite, inside the vehicle's steering and
/// throttle range, and turns the wheel behind its lag no faster than its steering rate allows. Non-finite
/// parts are replaced by the last sent steering and gentle braking. A nominal command passes unchanged, bit
/// for bit. No allocation; one thread.
class CommandGate {
 public:
  explicit CommandGate(const model::VehicleParams& vehicle) noexcept : vehicle_{vehicle} {}
  /// `elapsed` [s] since the last command, for the rate limit; <= 0 or non-finite skips the rate check.
  [[nodiscard]] model::Command pass(const model::Command& asked, double elapsed) noexcept;
  /// The command that pass() would send.
  [[nodiscard]] model::Command limited(const model::Command& asked, double elapsed) const noexcept;
  void reset() noexcept { *this = CommandGate{vehicle_}; }
  /// Another car's limits from now on; the last command stays.
  void set_vehicle(const model::VehicleParams& vehicle) noexcept { vehicle_ = vehicle; }

 private:
  /// Where the wheel is `elapsed` > 0 [s] after the last command.
  [[nodiscard]] double wheel_after(double elapsed) const noexcept;

  model::VehicleParams vehicle_;
  model::Command last_;
  double wheel_ = 0.0;  ///< where it was when last_ was sent [rad]; without a time, where last_ turns it
};

}  // namespace chicane::safety
