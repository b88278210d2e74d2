// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "chicane/base/vec2.hpp"

namespace chicane::survey {

/// Length of a polyline, with the way from its last point to its first where it is closed [m].
[[nodiscard]] double length_of(std::span<const Vec2> line, bool closed) noexcept;

/// The polyline's points at equal distances of about `spacing` [m], the first point first; an open one keeps
/// its last. Pre: two different points, spacing > 0. At most a million points.
[[nodiscard]] std::vector<Vec2> sampled(std::span<const Vec2> line, bool closed, double spacing);

/// Twice the area that a closed line goes round to the left [m²]: positive for one counter-clockwise.
[[nodiscard]] double turned_area(std::span<const Vec2> line) noexcept;

/// The median, of which there has to be a value; values are moved.
[[nodiscard]] double median(std::vector<double> values);

}  // namespace chicane::survey
