// SPDX-License-Identifier: MIT
#include "python_plant.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "conversion.hpp"
#include "faces.hpp"

namespace chicane::python {
namespace {

constexpr double kShortestStep = 1e-4, kLongestStep = 0.05;  // [s]

double step_of(const py::object& plant) {
  const double step = plant.attr("step_s").cast<double>();
  if (!(step >= kShortestStep && step <= kLongestStep))
    throw py::value_error("Plant: step_s: got " + std::to_string(step) +
                          ", expected a number of seconds from 0.0001 to 0.05");
  return step;
}

/// The state that a step returned; NaN and infinity are refused.
model::State state_of(const py::object& answer) {
  if (!py::isinstance<model::State>(answer))
    throw py::type_error("step: got " + py::repr(answer).cast<std::string>() + ", expected a CarState");
  const auto state = answer.cast<model::State>();
  if (!std::isfinite(state.x + state.y + state.psi + state.vx + state.vy + state.r + state.steer))
    throw py::value_error("step: got " + py::repr(answer).cast<std::string>() + ", expected finite numbers");
  return state;
}

double within(double value, double most) {
  return std::isfinite(value) ? std::clamp(value, -most, most) : 0.0;
}

}  // namespace

PythonPlant::PythonPlant(py::object object, const model::VehicleParams& vehicle, double step_limit,
                         std::shared_ptr<PlantFailure> failure)
    : object_{std::move(object)},
      vehicle_{std::make_shared<const model::VehicleParams>(vehicle)},
      step_{step_of(object_)},
      watch_{step_limit},
      failure_{std::move(failure)} {
  object_.attr("front_axle") = vehicle.front_axle;
  object_.attr("rear_axle") = vehicle.rear_axle;
  object_.attr("steer_limit") = vehicle.steer_limit;
}

PythonPlant::~PythonPlant() {
  const py::gil_scoped_acquire lock;
  object_ = py::object();
}

template <class Call>
void PythonPlant::guarded(const Call& call) noexcept {
  if (failure_->has_failed()) return;
  const py::gil_scoped_acquire lock;
  watch_.begin();
  try {
    try {
      call();
    } catch (const py::builtin_exception& error) {  // of ours: as if Python had raised it
      error.set_error();
      throw py::error_already_set();
    }
    watch_.end();
  } catch (py::error_already_set& error) {
    watch_.end();
    failure_->error = std::make_unique<py::error_already_set>(error);
  }
}

void PythonPlant::begin_at_state() noexcept {
  output_ = {};
  output_.speed = std::hypot(state_.vx, state_.vy);
  guarded([&] { object_.attr("reset")(state_); });
}

void PythonPlant::reset(const model::Pose& pose, double speed) noexcept {
  state_ = {.x = pose.x, .y = pose.y, .psi = pose.psi, .vx = speed};
  begin_at_state();
}

void PythonPlant::set_motion(const Vec2& velocity, double yaw_rate) noexcept {
  state_.vx = velocity.x();
  state_.vy = velocity.y();
  state_.r = yaw_rate;
  begin_at_state();
}

void PythonPlant::deviate(const sim::PlantDeviation& deviation) noexcept {
  guarded([&] {
    object_.attr("friction_scale") = deviation.friction_scale;
    object_.attr("mass_scale") = deviation.mass_scale;
  });
}

void PythonPlant::disturb(const sim::Disturbance& disturbance) noexcept {
  if (disturbance.grip == disturbance_.grip &&
      disturbance.side_acceleration == disturbance_.side_acceleration)
    return;
  disturbance_ = disturbance;
  guarded([&] {
    object_.attr("grip") = disturbance.grip;
    object_.attr("side_acceleration") = disturbance.side_acceleration;
  });
}

void PythonPlant::advance(const model::Command& command) noexcept {
  guarded([&] {
    const double throttle = within(command.throttle, 1.0);
    const model::State before = state_;
    state_ = state_of(object_.attr("step")(before, within(command.steer, vehicle_->steer_limit), throttle));
    output_.ax = (state_.vx - before.vx) / step_ - state_.r * state_.vy;
    output_.ay = (state_.vy - before.vy) / step_ + state_.r * state_.vx;
    output_.speed = std::hypot(state_.vx, state_.vy);
    output_.throttle = std::max(0.0, throttle);
  });
}

std::array<Vec2, 4> PythonPlant::contact_points() const noexcept {
  const double front = vehicle_->front_axle, rear = -vehicle_->rear_axle;
  const double side = 0.5 * (vehicle_->track_width + vehicle_->tire_width);
  return {Vec2{front, side}, Vec2{front, -side}, Vec2{rear, side}, Vec2{rear, -side}};
}

void add_plant(py::module_& module) {
  using S = model::State;
  py::class_<S>(module, "CarState")
      .def(py::init([](double x, double y, double yaw, double vx, double vy, double yaw_rate, double steer) {
             return S{.x = x, .y = y, .psi = yaw, .vx = vx, .vy = vy, .r = yaw_rate, .steer = steer};
           }),
           py::arg("x") = 0.0, py::arg("y") = 0.0, py::arg("yaw") = 0.0, py::arg("vx") = 0.0,
           py::arg("vy") = 0.0, py::arg("yaw_rate") = 0.0, py::arg("steer") = 0.0)
      .def_readwrite("x", &S::x)
      .def_readwrite("y", &S::y)
      .def_readwrite("yaw", &S::psi)
      .def_readwrite("vx", &S::vx)
      .def_readwrite("vy", &S::vy)
      .def_readwrite("yaw_rate", &S::r)
      .def_readwrite("steer", &S::steer)
      .def("__repr__", [](const S& s) {
        return py::str("CarState(x={!r}, y={!r}, yaw={!r}, vx={!r}, vy={!r}, yaw_rate={!r}, steer={!r})")
            .format(s.x, s.y, s.psi, s.vx, s.vy, s.r, s.steer);
      });
}

}  // namespace chicane::python
