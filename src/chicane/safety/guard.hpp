// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>

#include "chicane/base/deadline.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/model/measurement.hpp"
#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/safety/command_gate.hpp"
#include "chicane/safety/fallback.hpp"
#include "chicane/safety/measurement_monitor.hpp"

namespace chicane::safety {

/// The guard around a controller, the same for all of them: checks what it is told, decides what happens
/// without an answer, and lets nothing out that the actuators cannot do.
///
///     measurement → MeasurementMonitor → controller → Fallback (without an answer) → CommandGate → sent
///
/// Which of them chose the command is in the report: StepReport::rung and `gated`, and nobody else sets
/// these. Whatever is measured and whatever the controller does, what is sent is finite and inside the
/// vehicle's range and rate limits. No allocation; bounded time beside the controller's own; one thread.
class Guard {
 public:
  /// Pre: `controller` is not null. `vehicle`: limits of what is sent.
  Guard(std::unique_ptr<controller::Controller> controller, const model::VehicleParams& vehicle) noexcept;

  /// What else holds in a cycle.
  struct Cycle {
    double interval = 0.0;  ///< since the command before [s], for the rate limit; <= 0: not limited
    std::optional<model::Command> manual{};  ///< a person's command, sent in the controller's place
  };
  /// One control cycle. Writes into `result` what the controller answered with the command that is sent, and
  /// returns the command as it was asked for, before the gate.
  model::Command step(const model::Measurement& measured, Deadline deadline, const Cycle& cycle,
                      controller::StepResult& result) noexcept;
  /// Everything learned is forgotten, the controller's part included: a new run begins.
  void reset() noexcept;
  /// Another car's limits from now on.
  void set_vehicle(const model::VehicleParams& vehicle) noexcept;

  [[nodiscard]] controller::Controller& controller() noexcept { return *controller_; }
  [[nodiscard]] const controller::Controller& controller() const noexcept { return *controller_; }

 private:
  void fall_back(const model::Measurement& seen, controller::StepResult& result) noexcept;

  std::unique_ptr<controller::Controller> controller_;
  MeasurementMonitor monitor_;
  Fallback fallback_;
  CommandGate gate_;
};

}  // namespace chicane::safety
