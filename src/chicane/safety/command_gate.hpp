// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"

namespace chicane::safety {

/// Why the gate changed a command.
enum class GateReason : signed char { kNone = 0, kNotFinite = 1, kRange = 2, kRate = 3 };

struct GateResult {
  model::Command command;                 ///< always finite, inside range and rate limits
  GateReason reason = GateReason::kNone;  ///< worst one that applied
};

/// Acceleration that leads a car of speed `v` [m/s] to VehicleParams::valid_speed, and ends 5 % above it
/// [m/s²]. Controllers that follow a plan of that speed are a little faster now and then, and need drive in
/// bends; from 10 % above it `f1tenth` spins in a stop that was computed with its parameters.
[[nodiscard]] double drive_to_valid_speed(const model::VehicleParams& vehicle, double v) noexcept;

/// The only way to an actuator: whatever is asked, what leaves is finite, inside the vehicle's steering and
/// throttle range, and no faster than its steering rate allows: that of what is sent or, where the steering
/// is slow (model/actuator.hpp), that of the wheel behind its lag. Non-finite parts are replaced by the last
/// sent steering and gentle braking. A nominal command passes unchanged, bit for bit. No allocation; one
/// thread.
class CommandGate {
 public:
  explicit CommandGate(const model::VehicleParams& vehicle) noexcept : vehicle_{vehicle} {}
  /// `elapsed` [s] since the last command, for the rate limit; <= 0 or non-finite skips the rate check.
  [[nodiscard]] GateResult pass(const model::Command& asked, double elapsed) noexcept;
  /// What pass() would send.
  [[nodiscard]] GateResult limited(const model::Command& asked, double elapsed) const noexcept;
  void reset() noexcept {
    last_ = {};
    wheel_ = 0.0;
  }
  /// Another car's limits from now on; the last command stays.
  void set_vehicle(const model::VehicleParams& vehicle) noexcept { vehicle_ = vehicle; }

 private:
  /// Where the wheel is `elapsed` [s] after the last command; that command, where the steering is not slow.
  [[nodiscard]] double wheel_after(double elapsed) const noexcept;

  model::VehicleParams vehicle_;
  model::Command last_;
  double wheel_ = 0.0;  ///< where it was when last_ was sent [rad]
};

}  // namespace chicane::safety
