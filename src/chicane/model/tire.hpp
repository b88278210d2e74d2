// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/base/angle.hpp"
#include "chicane/base/math.hpp"

namespace chicane::model {

/// Normalised tyre curves: force over load from slip. Odd functions of slip, templates over the scalar, so
/// that a jet gives their slope. Equations and sources: docs/model.md, eq. 10–12.

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

/// sin(C atan(x/C)) over x, by the square of the slip x > 0: the magic formula's secant. For C = 3/2 without
/// an angle, cos θ = 1/√(1 + (x/C)²) and sin(3θ/2) = sin θ (1 + 2 cos θ) / (2 cos(θ/2)).
/// T is double or a Pack.
template <class T>
[[nodiscard]] T magic_secant(double shape, const T& square) noexcept {
  if (shape != 1.5) {
    const T size = sqrt(square);
    return sin(shape * atan(size / shape)) / size;
  }
  const T cosine = 1.0 / sqrt(1.0 + square / (shape * shape));
  return cosine * (1.0 + 2.0 * cosine) / (2.0 * shape * sqrt(0.5 * (1.0 + cosine)));
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

}  // namespace chicane::model
