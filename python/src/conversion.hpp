// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "chicane/base/math.hpp"
#include "chicane/base/result.hpp"
#include "chicane/base/text.hpp"
#include "chicane/base/vec2.hpp"
#include "chicane/model/state.hpp"

namespace chicane::python {

namespace py = pybind11;

/// The value; for an error Python's ValueError with the same text.
template <class T>
T value_of(Result<T>&& result) {
  if (!result) throw py::value_error(result.error().message);
  return std::move(*result);
}
inline void check(const Result<void>& result) {
  if (!result) throw py::value_error(result.error().message);
}

/// What `work` returns, done without the interpreter's lock: nothing of Python may be touched in it.
template <class Work>
auto unlocked(const Work& work) {
  const py::gil_scoped_release without_lock;
  return work();
}

/// A one-dimensional array that owns the vector: no copy.
template <class T>
py::array_t<T> to_array(std::vector<T>&& values) {
  auto owner = std::make_unique<std::vector<T>>(std::move(values));
  const std::vector<T>& kept = *owner;
  const py::capsule capsule(owner.release(),
                            [](void* vector) { delete static_cast<std::vector<T>*>(vector); });
  return py::array_t<T>(static_cast<py::ssize_t>(kept.size()), kept.data(), capsule);
}

/// Points as an array of shape (n, 2).
inline py::array_t<double> to_array(std::span<const Vec2> points) {
  py::array_t<double> array({static_cast<py::ssize_t>(points.size()), py::ssize_t{2}});
  double* to = array.mutable_data();
  for (const Vec2& point : points) {
    *to++ = point.x();
    *to++ = point.y();
  }
  return array;
}

/// ValueError for a steering that is not finite or beyond a right angle, as degrees are, and for a throttle
/// that is not finite. Beyond the car's steering limit and beyond [-1, 1] the car takes the limit.
inline void check_command(const char* what, const model::Command& command) {
  const auto refuse = [&](const char* name, double value, const char* expected) {
    throw py::value_error(std::string(what) + ": " + name + ": got " + number_text(value, 6) + ", expected " +
                          expected);
  };
  if (!(std::fabs(command.steer) <= 0.5 * kPi))
    refuse("steer", command.steer, "a number in [-1.57, 1.57] rad (is it in degrees?)");
  if (!std::isfinite(command.throttle)) refuse("throttle", command.throttle, "a finite number");
}

inline py::str to_text(std::string_view text) { return {text.data(), text.size()}; }

}  // namespace chicane::python
