// SPDX-License-Identifier: MIT
#include "python_controller.hpp"

#include <pybind11/stl.h>

#include <cmath>
#include <utility>

#include "chicane/base/math.hpp"
#include "chicane/base/vec2.hpp"
#include "conversion.hpp"
#include "faces.hpp"

namespace chicane::python {
namespace {

/// A Command, or two numbers: steer and throttle.
model::Command command_of(const py::object& answer) {
  if (py::isinstance<model::Command>(answer)) return answer.cast<model::Command>();
  try {
    const auto [steer, throttle] = answer.cast<std::pair<double, double>>();
    return {steer, throttle};
  } catch (const py::cast_error&) {
    const std::string got = py::repr(answer).cast<std::string>();
    throw py::type_error("step: got " + got +
                         ", expected Command(steer, throttle), two numbers or NO_ANSWER");
  }
}

/// An error of the call itself, such as a wrong number of arguments, has no trace.
std::string traceback_of(py::error_already_set& error) {
  const py::object trace = error.trace() ? py::object(error.trace()) : py::none();
  const py::object lines =
      py::module_::import("traceback").attr("format_exception")(error.type(), error.value(), trace);
  return py::str("").attr("join")(lines).cast<std::string>();
}

py::array_t<double> waypoints(const Seen& seen) {
  return to_array(
      std::span(seen.measurement.waypoints).first(static_cast<std::size_t>(seen.measurement.waypoint_count)));
}

/// Seen from the car: x ahead, y to the left.
py::array_t<double> waypoints_ahead(const Seen& seen) {
  const model::Measurement& now = seen.measurement;
  const double c = chicane::cos(now.psi), s = chicane::sin(now.psi);
  std::array<Vec2, model::Measurement::kMaxWaypoints> points{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(now.waypoint_count); ++i) {
    const Vec2 d = now.waypoints[i] - Vec2(now.x, now.y);
    points[i] = {c * d.x() + s * d.y(), c * d.y() - s * d.x()};
  }
  return to_array(std::span<const Vec2>(points).first(static_cast<std::size_t>(now.waypoint_count)));
}

}  // namespace

PythonController::PythonController(py::object object, const model::VehicleParams& vehicle, double step_limit,
                                   std::shared_ptr<ControllerFailure> failure)
    : object_{std::move(object)},
      name_{py::str(py::type::of(object_).attr("__name__")).cast<std::string>()},
      vehicle_{std::make_shared<const model::VehicleParams>(vehicle)},
      similarity_{vehicle},
      step_limit_{step_limit},
      watch_{step_limit},
      failure_{std::move(failure)} {}

PythonController::~PythonController() {
  const py::gil_scoped_acquire lock;
  object_ = py::object();
}

/// Calls into Python; whatever comes out of it is kept as the failure.
template <class Call>
void PythonController::guarded(double time, const Call& call) noexcept {
  const py::gil_scoped_acquire lock;
  watch_.begin();
  try {
    call();
    watch_.end();
  } catch (py::error_already_set& error) {
    fail(time, error, watch_.end());
  } catch (const std::exception& error) {  // of pybind11: an answer of another type
    watch_.end();
    failure_->text = std::string(error.what()) + "\n";
    failure_->time = time;
  }
}

void PythonController::fail(double time, py::error_already_set& error, bool is_late) {
  failure_->time = time;
  if (error.matches(PyExc_KeyboardInterrupt)) {
    failure_->interrupt = std::make_unique<py::error_already_set>(error);
    return;
  }
  failure_->text = traceback_of(error);
  if (is_late)
    failure_->text += "step: it took longer than " + py::str(py::float_(step_limit_)).cast<std::string>() +
                      " s (step_limit_s) and was ended\n";
}

/// A model car is seen in full size by controllers (model/vehicle.hpp); here it is as it is.
model::Measurement PythonController::as_it_is(model::Measurement now) const noexcept {
  now.time /= similarity_.time();
  now.delay /= similarity_.time();
  now.x /= similarity_.length();
  now.y /= similarity_.length();
  now.speed /= similarity_.speed();
  for (Vec2& point : std::span(now.waypoints).first(static_cast<std::size_t>(now.waypoint_count)))
    point *= 1.0 / similarity_.length();
  return now;
}

const controller::StepResult& PythonController::step(const model::Measurement& now, Deadline) noexcept {
  result_.answer = controller::Answer::kNone;
  if (failure_->has_failed()) return result_;
  const Seen seen{similarity_.is_identity() ? now : as_it_is(now), vehicle_};
  guarded(seen.measurement.time, [&] {
    const py::object answer = object_.attr("step")(seen);
    if (py::isinstance<NoAnswer>(answer)) return;
    const model::Command command = command_of(answer);
    check_command("step", command);
    result_.command = command;
    result_.answer = controller::Answer::kDrive;
  });
  return result_;
}

void PythonController::reset() noexcept {
  guarded(0.0, [&] { object_.attr("reset")(); });
}

void add_controller(py::module_& module) {
  py::class_<model::Command>(module, "Command")
      .def(py::init([](double steer, double throttle) {
             const model::Command command{steer, throttle};
             check_command("Command", command);
             return command;
           }),
           py::arg("steer") = 0.0, py::arg("throttle") = 0.0)
      .def_readwrite("steer", &model::Command::steer)
      .def_readwrite("throttle", &model::Command::throttle)
      .def("__repr__", [](const model::Command& command) {
        return py::str("Command(steer={!r}, throttle={!r})").format(command.steer, command.throttle);
      });
  py::class_<NoAnswer>(module, "NoAnswer").def("__repr__", [](const NoAnswer&) { return "NO_ANSWER"; });
  module.attr("NO_ANSWER") = NoAnswer{};
  const auto number = [](double model::Measurement::*field) {
    return [field](const Seen& seen) { return seen.measurement.*field; };
  };
  py::class_<Seen>(module, "Measurement")
      .def_property_readonly("time", number(&model::Measurement::time))
      .def_property_readonly("x", number(&model::Measurement::x))
      .def_property_readonly("y", number(&model::Measurement::y))
      .def_property_readonly("yaw", number(&model::Measurement::psi))
      .def_property_readonly("speed", number(&model::Measurement::speed))
      .def_property_readonly("steer", number(&model::Measurement::steer))
      .def_property_readonly("throttle", number(&model::Measurement::throttle))
      .def_property_readonly("delay", number(&model::Measurement::delay))
      .def_property_readonly("waypoints", waypoints)
      .def_property_readonly("waypoints_ahead", waypoints_ahead)
      .def_property_readonly(
          "wheelbase", [](const Seen& seen) { return seen.vehicle->front_axle + seen.vehicle->rear_axle; })
      .def_property_readonly("steer_limit", [](const Seen& seen) { return seen.vehicle->steer_limit; })
      .def("__repr__", [](const Seen& seen) {
        const model::Measurement& now = seen.measurement;
        return py::str(
                   "Measurement(time={:.2f} s, x={:.2f} m, y={:.2f} m, yaw={:.3f} rad, speed={:.2f} m/s, {} "
                   "waypoints)")
            .format(now.time, now.x, now.y, now.psi, now.speed, now.waypoint_count);
      });
}

}  // namespace chicane::python
