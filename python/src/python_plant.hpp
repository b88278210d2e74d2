// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>

#include "chicane/model/vehicle.hpp"
#include "chicane/sim/plant.hpp"
#include "step_watch.hpp"

namespace chicane::python {

/// What a plant written in Python has raised, for whoever runs it.
struct PlantFailure {
  std::unique_ptr<pybind11::error_already_set> error{};
  [[nodiscard]] bool has_failed() const noexcept { return error != nullptr; }
};

/// A Python object with `step(state, steer, throttle)` and `reset(state)` as the simulated car. Each call
/// takes the interpreter's lock. After an exception, a state that is not finite, or a call that takes too
/// long the car stays where it is, and the run is to be ended.
class PythonPlant final : public sim::Plant {
 public:
  /// Throws py::value_error for a step length that is none. `step_limit` [s] of a call by the wall clock; 0:
  /// none. Constructed with the lock, destroyed without it.
  PythonPlant(pybind11::object object, const model::VehicleParams& vehicle, double step_limit,
              std::shared_ptr<PlantFailure> failure);
  ~PythonPlant() override;
  PythonPlant(const PythonPlant&) = delete;
  PythonPlant& operator=(const PythonPlant&) = delete;

  [[nodiscard]] double step_length() const noexcept override { return step_; }
  void reset(const model::Pose& pose, double speed) noexcept override;
  void set_motion(const Vec2& velocity, double yaw_rate) noexcept override;
  void deviate(const sim::PlantDeviation& deviation) noexcept override;
  void disturb(const sim::Disturbance& disturbance) noexcept override;
  void advance(const model::Command& command) noexcept override;
  [[nodiscard]] const model::State& state() const noexcept override { return state_; }
  [[nodiscard]] const sim::PlantOutput& output() const noexcept override { return output_; }
  [[nodiscard]] std::array<Vec2, 4> contact_points() const noexcept override;

 private:
  template <class Call>
  void guarded(const Call& call) noexcept;
  void begin_at_state() noexcept;

  pybind11::object object_;
  std::shared_ptr<const model::VehicleParams> vehicle_;
  double step_ = 0.0;
  StepWatch watch_;
  std::shared_ptr<PlantFailure> failure_;
  sim::Disturbance disturbance_;
  model::State state_;
  sim::PlantOutput output_;
};

}  // namespace chicane::python
