// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "chicane/base/vec2.hpp"

namespace chicane::survey {

/// A place on the earth [deg], WGS 84.
struct Geographic {
  double latitude = 0.0, longitude = 0.0;
};

/// East and north of the middle of the places' extent [m], on the plane that touches the ellipsoid there:
/// lengths are right to 1e-4 within 30 km. Heights are left out. Pre: |latitude| < 89.
[[nodiscard]] std::vector<Vec2> to_plane(std::span<const Geographic> places);

/// The middle that to_plane() counts from.
[[nodiscard]] Geographic middle_of(std::span<const Geographic> places) noexcept;

}  // namespace chicane::survey
