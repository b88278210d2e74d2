// SPDX-License-Identifier: MIT
// Smoothing of noisy points to a line, as the first step from raw points to a road.
#pragma once

#include <span>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/base/vec2.hpp"

namespace chicane::road {

/// Smooth line through noisy, unevenly spaced points, given by evenly spaced knots.
struct SmoothLine {
  std::vector<Vec2> knots;        ///< spaced by `spacing` [m]; a closed line's last knot precedes its first
  std::vector<double> parameter;  ///< arc length of each given point along the smooth line [m]
  double length = 0.0;            ///< length of the line [m]
  double spacing = 0.0;           ///< spacing of the knots [m]
  double smoothing_length = 0.0;  ///< ℓ, equation (1) of docs/tracks.md [m]
  double rms_deviation = 0.0;     ///< root mean square of the points' distances from the line, across it [m]
  double max_deviation = 0.0;     ///< largest distance of a point from the line, across it [m]
};

/// Fits the penalised cubic B-spline r(s) that minimises Σ Δsᵢ |r(sᵢ) − pᵢ|² + ℓ^2m ∫ |r⁽ᵐ⁾|² ds over the arc
/// length s (docs/tracks.md, eq. 1; Eilers and Marx 1996). m is 3 for even points, 2 if a gap is over four
/// times the median of the seven around it. Wavelengths below about 2π ℓ are damped. ℓ follows from `sigma`,
/// the standard deviation of the points' noise [m]: the line has 0.003 1/m of curvature noise then (eq. 2).
/// ℓ, and `spacing` of the knots [m] with it, is reduced while the points' distances from the line are larger
/// than their noise explains: rms > σ or any > 4 σ, with m = 2 any > 2 σ (plus millimetres, for σ = 0).
///
/// Pre: finite points, at least two different. Fails with kInvalidArgument if the line needs more than
/// 200,000 knots, or so many to each point that rounding dominates. Memory: 400,000 knots.
[[nodiscard]] Result<SmoothLine> smooth_line(std::span<const Vec2> points, bool closed, double spacing,
                                             double sigma);

/// Estimates the standard deviation of the points' noise across the line [m], at most 1, by leave-one-out
/// cross-validation of (1) (docs/tracks.md, eq. 3). Takes the largest ℓ that predicts left-out points as well
/// as the best ℓ, within a standard error. `spacing` of the knots [m]. Pre: finite points, at least two
/// different. Allocates.
[[nodiscard]] double estimate_noise(std::span<const Vec2> points, bool closed, double spacing);

}  // namespace chicane::road
