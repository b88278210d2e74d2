// SPDX-License-Identifier: MIT
#include "chicane/safety/command_gate.hpp"

#include <cmath>

#include "chicane/base/math.hpp"
#include "chicane/model/actuator.hpp"

namespace chicane::safety {
namespace {

/// Share of the useful braking that stands for "gentle".
constexpr double kGentleBraking = 0.4;

/// Severity of a reason; the worst one is reported.
constexpr int severity(GateReason reason) noexcept {
  switch (reason) {
    case GateReason::kNone:
      return 0;
    case GateReason::kRate:
      return 1;
    case GateReason::kRange:
      return 2;
    case GateReason::kNotFinite:
      return 3;
  }
  return 3;
}

bool is_slow(const model::VehicleParams& vehicle) noexcept {
  return vehicle.steer_lag > model::kSlowSteering;
}

}  // namespace

double CommandGate::wheel_after(double elapsed) const noexcept {
  if (!is_slow(vehicle_)) return last_.steer;
  if (!(std::isfinite(elapsed) && elapsed > 0.0)) return wheel_;
  const model::Actuator steering{.low = -vehicle_.steer_limit,
                                 .high = vehicle_.steer_limit,
                                 .lag = vehicle_.steer_lag,
                                 .rate = vehicle_.steer_rate_limit};
  return steering.next(wheel_, last_.steer, elapsed);
}

GateResult CommandGate::limited(const model::Command& asked, double elapsed) const noexcept {
  GateResult result{asked, GateReason::kNone};
  model::Command& command = result.command;
  const auto note = [&](GateReason reason) {
    if (severity(reason) > severity(result.reason)) result.reason = reason;
  };

  // Finite first, and explicitly: std::clamp and std::min let a NaN through.
  if (!std::isfinite(command.steer)) {
    command.steer = last_.steer;
    note(GateReason::kNotFinite);
  }
  if (!std::isfinite(command.throttle)) {
    command.throttle = -kGentleBraking * vehicle_.brake_throttle_limit;
    note(GateReason::kNotFinite);
  }

  if (std::fabs(command.steer) > vehicle_.steer_limit) {
    command.steer = std::copysign(vehicle_.steer_limit, command.steer);
    note(GateReason::kRange);
  }
  if (std::fabs(command.throttle) > 1.0) {
    command.throttle = std::copysign(1.0, command.throttle);
    note(GateReason::kRange);
  }

  if (std::isfinite(elapsed) && elapsed > 0.0) {
    const double wheel = wheel_after(elapsed);
    const double share = is_slow(vehicle_) ? 1.0 - exp(-elapsed / vehicle_.steer_lag) : 1.0;
    const double reach = vehicle_.steer_rate_limit * elapsed / share;
    if (command.steer > wheel + reach) {
      command.steer = wheel + reach;
      note(GateReason::kRate);
    } else if (command.steer < wheel - reach) {
      command.steer = wheel - reach;
      note(GateReason::kRate);
    }
  }

  return result;
}

double drive_to_valid_speed(const model::VehicleParams& car, double v) noexcept {
  constexpr double kExcess = 1.05;   // share of the valid speed
  constexpr double kApproach = 0.5;  // [s] time constant: of the order of steering and drive lags
  return (kExcess * car.valid_speed - v) / kApproach;
}

GateResult CommandGate::pass(const model::Command& asked, double elapsed) noexcept {
  const GateResult result = limited(asked, elapsed);
  wheel_ = wheel_after(elapsed);
  last_ = result.command;
  return result;
}

}  // namespace chicane::safety
