// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/base/result.hpp"
#include "chicane/path/track.hpp"

namespace chicane::lap_time {

/// What has to fit a road.
struct CarSize {
  double front_axle = 0.0, rear_axle = 0.0;  ///< from the centre of mass [m]
  double half_width = 0.0;                   ///< to the outer edge of a contact patch [m]
  double steer_limit = 0.0;                  ///< [rad]

  /// Curvature that the centre of mass drives at full lock and walking pace [1/m].
  [[nodiscard]] double most_curvature() const noexcept;
};

/// Whether the car can get round at walking pace: wide enough everywhere, and a line within the edges that
/// its full lock can follow (docs/limit.md, section 4). kInvalidArgument with the place, and the radius there
/// and of the full lock.
[[nodiscard]] Result<void> fits_road(const path::Track& track, const CarSize& car);

}  // namespace chicane::lap_time
