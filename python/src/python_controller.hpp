// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <string_view>

#include "chicane/controller/controller.hpp"
#include "chicane/model/vehicle.hpp"
#include "step_watch.hpp"

namespace chicane::python {

/// What a controller written in Python is told in one cycle, of the car as it is.
struct Seen {
  model::Measurement measurement;
  std::shared_ptr<const model::VehicleParams> vehicle;
};

/// What a step returns that has no answer: chicane.NO_ANSWER.
struct NoAnswer {};

/// How a controller written in Python has failed, for whoever runs it.
struct ControllerFailure {
  std::string text{};                                        ///< the traceback; empty: it has not failed
  double time = 0.0;                                         ///< of the measurement [s]
  std::unique_ptr<pybind11::error_already_set> interrupt{};  ///< Ctrl-C came while it was computing
  [[nodiscard]] bool has_failed() const noexcept { return !text.empty() || interrupt != nullptr; }
};

/// A Python object with `step(seen)` and `reset()` as a controller. Each call takes the interpreter's lock.
///
/// After an exception, a command that is not finite, or a call that takes too long it is not called any more:
/// it has no answer, and the guard stops the car.
class PythonController final : public controller::Controller {
 public:
  /// `step_limit` [s] of a call by the wall clock; 0: none. `failure` is shared with whoever runs it.
  /// Constructed with the lock, destroyed without it.
  PythonController(pybind11::object object, const model::VehicleParams& vehicle, double step_limit,
                   std::shared_ptr<ControllerFailure> failure);
  ~PythonController() override;
  PythonController(const PythonController&) = delete;
  PythonController& operator=(const PythonController&) = delete;

  const controller::StepResult& step(const model::Measurement& now, Deadline deadline) noexcept override;
  void reset() noexcept override;
  [[nodiscard]] std::string_view name() const noexcept override { return name_; }

 private:
  template <class Call>
  void guarded(double time, const Call& call) noexcept;
  void fail(double time, pybind11::error_already_set& error, bool is_late);
  [[nodiscard]] model::Measurement as_it_is(model::Measurement now) const noexcept;

  pybind11::object object_;
  std::string name_;
  std::shared_ptr<const model::VehicleParams> vehicle_;
  model::Similarity similarity_;
  double step_limit_;
  StepWatch watch_;
  std::shared_ptr<ControllerFailure> failure_;
  controller::StepResult result_;
};

}  // namespace chicane::python
