// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>

#include "chicane/base/vec2.hpp"
#include "chicane/model/state.hpp"

namespace chicane::controller {

/// The line ahead in the car's frame (x forward, y left): y = f(x) = c0 + c1 x + c2 x² + c3 x³ [m]. `Real`: a
/// number, or a pack of several lines'.
template <class Real>
struct CubicOver {
  std::array<Real, 4> c{};

  template <class T>
  [[nodiscard]] auto at(const T& x) const {
    return c[0] + x * (c[1] + x * (c[2] + x * c[3]));
  }
  /// f'(x) = dy/dx, the tangent of the line's heading.
  template <class T>
  [[nodiscard]] auto slope(const T& x) const {
    return c[1] + x * (2.0 * c[2] + x * (3.0 * c[3]));
  }
};
using Cubic = CubicOver<double>;

/// Points in a car's frame; fixed memory.
struct LocalPoints {
  int count = 0;
  std::array<Vec2, model::Measurement::kMaxWaypoints> points{};  ///< [m]

  [[nodiscard]] std::span<const Vec2> view() const noexcept {
    return {points.data(), static_cast<std::size_t>(count)};
  }
};

/// The measured waypoints seen from `car`, by a rotation: p = R(−ψ) (w − o). Skips points that are not
/// finite.
[[nodiscard]] LocalPoints to_car_frame(const model::Measurement& now, const model::Pose& car) noexcept;

/// The same by radius and angle: r = |w − o|, θ = atan2(w − o) − ψ, p = r (cos θ, sin θ). Equal up to
/// rounding.
[[nodiscard]] LocalPoints to_car_frame_polar(const model::Measurement& now, const model::Pose& car) noexcept;

/// Least-squares polynomial of `order` (1 to 3) through points by Householder QR. Where the points cannot
/// tell the higher powers (fewer than four different x), those coefficients are 0. False, and `fit`
/// unchanged, for fewer than two points, or less than 1 mm of extent along x. Pre: finite points, at most
/// LocalPoints' capacity.
[[nodiscard]] bool fit_cubic(std::span<const Vec2> points, Cubic& fit, int order = 3) noexcept;

}  // namespace chicane::controller
