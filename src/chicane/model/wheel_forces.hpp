// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "chicane/base/jet.hpp"
#include "chicane/base/math.hpp"
#include "chicane/model/vehicle.hpp"

/// Tyre curves, and the forces of four wheels on a plane. Plants, limits, stops and fits share where the
/// wheels are, how their forces add up, and how anti-lock and traction control reduce torque. Loads and slips
/// differ: a plant integrates slips, a limit has them as variables, a stop finds them for a force, a fit for
/// a torque.
///
/// Templates over the scalar: double, or a jet, which gives slopes. Tyre curves are odd functions of slip.
/// Equations and sources: docs/model.md, eq. 10–12. No allocation, no failure.

namespace chicane::model {

/// Magic formula y = D sin(C atan(B x − E (B x − atan(B x)))), slope B C D at 0 (eq. 10; Pacejka 2012,
/// §4.3.1).
struct MagicFormula {
  double stiffness = 10.0;  ///< B
  double shape = 1.5;       ///< C
  double peak = 1.0;        ///< D
  double curvature = 0.0;   ///< E, <= 1

  template <class T>
  [[nodiscard]] T operator()(const T& x) const {
    const T bx = stiffness * x;
    if (curvature == 0.0) return peak * sin(shape * atan(bx));
    return peak * sin(shape * atan(bx - curvature * (bx - atan(bx))));
  }
  /// Slip of the largest value: C atan(B x) = π/2. Pre: E = 0, C > 1.
  [[nodiscard]] double peak_slip() const noexcept { return tan(kPi / (2.0 * shape)) / stiffness; }
};

/// sin(C atan(x/C)) over x, by the square of the slip x > 0: the magic formula's secant. For C = 3/2 by
/// docs/model.md, eq. 10a, with its derivatives by dc/d(x²) = −c³/(2C²).
template <class T>
[[nodiscard]] T magic_secant(double shape, const T& square) noexcept {
  if (shape != 1.5) {
    const T size = sqrt(square);
    return sin(shape * atan((1.0 / shape) * size)) / size;
  }
  const auto& x2 = jet::value(square);
  const auto c = 1.0 / sqrt(1.0 + (1.0 / 2.25) * x2);
  const auto h2 = 0.5 * (1.0 + c);
  const auto per_half = 1.0 / sqrt(h2);
  const auto secant = (1.0 / 3.0) * per_half * c * (1.0 + 2.0 * c);
  if constexpr (AnyJet<T>) {
    const auto cube = c * c * c * per_half / h2;
    return jet::chain(square, secant, (-1.0 / 54.0) * cube * (2.0 + c * (9.0 + 6.0 * c)),
                      (1.0 / 243.0) * cube * c * c / h2 * (3.0 + c * (19.5 + c * (26.25 + 10.5 * c))));
  } else {
    return secant;
  }
}

/// Friction curve of PhysX wheels as Unity's WheelCollider takes it: from (0, 0) to an extremum to an
/// asymptote by two cubic Hermite pieces (eq. 11, 12; PhysX 2.8, NxTireFunctionDesc::hermiteEval). Slope at
/// 0: extremum_value / extremum_slip.
struct FrictionCurve {
  double extremum_slip = 0.2;
  double extremum_value = 1.0;
  double asymptote_slip = 0.5;
  double asymptote_value = 0.75;

  template <class T>
  [[nodiscard]] T operator()(const T& slip) const {
    const double side = value_of(slip) < 0.0 ? -1.0 : 1.0;
    const T size = side * slip;
    if (value_of(size) < extremum_slip) {
      const T u = size * (1.0 / extremum_slip);
      return (side * extremum_value) * (u + u * u - u * u * u);
    }
    if (value_of(size) < asymptote_slip) {
      const T u = (size - extremum_slip) * (1.0 / (asymptote_slip - extremum_slip));
      return side * (extremum_value + (asymptote_value - extremum_value) * (3.0 * u * u - 2.0 * u * u * u));
    }
    return T(side * asymptote_value);
  }
};

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
/// `v` in the original axes, given in axes that are turned by an angle with this cosine and sine.
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

/// Functions with a corner, exact.
struct Sharp {
  /// max(x, 0).
  [[nodiscard]] static double positive(double x, double /*width*/) noexcept { return std::max(x, 0.0); }
  /// x in [0, 1].
  [[nodiscard]] static double share(double x, double /*width*/) noexcept { return std::clamp(x, 0.0, 1.0); }
};
/// Functions with a corner that is rounded within about `width`, for searches that use derivatives.
struct Rounded {
  /// About max(x, 0).
  template <class T>
  [[nodiscard]] static T positive(const T& x, double width) {
    return 0.5 * (x + sqrt(x * x + width * width));
  }
  /// About x in [0, 1].
  template <class T>
  [[nodiscard]] static T share(const T& x, double width) {
    return positive(x, width) - positive(T(x - 1.0), width);
  }
};

/// Share of a brake torque that anti-lock permits, or of a drive torque that traction control permits: 1 up
/// to slip `start`, 0 from `end` on, for the slip in the direction of the force.
template <class Corners, class T>
[[nodiscard]] T torque_share(const T& slip, double start, double end) {
  constexpr double kCorner = 0.02;  // width of the rounding of both corners; chosen
  return Corners::share(T((end - slip) / (end - start)), kCorner);
}

}  // namespace chicane::model
