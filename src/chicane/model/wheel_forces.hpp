// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "chicane/base/math.hpp"
#include "chicane/model/vehicle.hpp"

namespace chicane::model {

/// Four wheels of a car on a plane, for plants, limits, stops and fits: they share where the wheels are, how
/// their forces add up and how controllers of the wheels take torque away. Loads and slips differ: a plant
/// integrates slips, a limit has them as variables, a stop finds them for a force, a fit for a torque.
/// Templates over the scalar: double, or a jet. No allocation, no failure.

/// A vector in a plane.
template <class T>
struct Planar {
  T x{};
  T y{};
};

/// `v` in axes that are turned by an angle with this cosine and sine.
template <class T>
[[nodiscard]] Planar<T> in_turned_axes(const Planar<T>& v, const T& cosine, const T& sine) {
  return {cosine * v.x + sine * v.y, cosine * v.y - sine * v.x};
}
/// The other way round.
template <class T>
[[nodiscard]] Planar<T> from_turned_axes(const Planar<T>& v, const T& cosine, const T& sine) {
  return {cosine * v.x - sine * v.y, sine * v.x + cosine * v.y};
}

/// Force and moment about the centre of mass, in the car's axes.
template <class T>
struct WheelForces {
  T x{};
  T y{};
  T moment{};
};

/// Adds the forces of the wheels 0 to 3, front left, front right, rear left, rear right, to `sum`.
/// `force_of(i, axle, v)` is the force of wheel i in its own axes, `v` the velocity of its centre in the
/// car's. `cosine` and `sine` belong to the angle of the front wheels.
template <class T, class ForceOf>
[[nodiscard]] WheelForces<T> wheel_forces(const std::array<Axle, 2>& axles, const Planar<T>& velocity,
                                          const T& yaw_rate, const T& cosine, const T& sine,
                                          WheelForces<T> sum, const ForceOf& force_of) {
  for (std::size_t i = 0; i < 4; ++i) {
    const Axle& axle = axles[i / 2];
    const double y = i % 2 == 0 ? axle.half_track : -axle.half_track;
    Planar<T> force = force_of(i, axle, Planar<T>{velocity.x - yaw_rate * y, velocity.y + yaw_rate * axle.x});
    if (i < 2) force = from_turned_axes(force, cosine, sine);
    sum.x += force.x;
    sum.y += force.y;
    sum.moment += axle.x * force.y - y * force.x;
  }
  return sum;
}

/// Functions with a corner as they are.
struct Sharp {
  /// max(x, 0).
  [[nodiscard]] static double positive(double x, double /*width*/) noexcept { return std::max(x, 0.0); }
  /// x in [0, 1].
  [[nodiscard]] static double share(double x, double /*width*/) noexcept { return std::clamp(x, 0.0, 1.0); }
};
/// The same, smooth within about `width`: for searches that use derivatives.
struct Rounded {
  template <class T>
  [[nodiscard]] static T positive(const T& x, double width) {
    return 0.5 * (x + sqrt(x * x + width * width));
  }
  template <class T>
  [[nodiscard]] static T share(const T& x, double width) {
    return positive(x, width) - positive(T(x - 1.0), width);
  }
};

/// What anti-lock leaves of a brake, or traction control of a drive: 1 up to `start`, nothing from `end` on,
/// of the slip in the direction of the force.
template <class Corners, class T>
[[nodiscard]] T torque_share(const T& slip, double start, double end) {
  constexpr double kCorner = 0.02;
  return Corners::share(T((end - slip) / (end - start)), kCorner);
}

}  // namespace chicane::model
