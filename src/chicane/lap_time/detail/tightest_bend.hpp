// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <limits>

#include "chicane/base/result.hpp"
#include "chicane/road/track.hpp"

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
[[nodiscard]] Result<void> fits_road(const road::Track& track, const CarSize& car);

/// How tight is too tight.
struct Fit {
  double reserve = 1.0 / 1.02;  ///< of the radius that a bend leaves room for, over that of the full lock
  double surely = 4.0;  ///< a middle of the road with so many times the radius at full lock needs no look
  double beside = std::numeric_limits<double>::infinity();  ///< that the car may be from the middle [m]
  double scale = 1.0;                                       ///< of the lengths in messages
  std::function<bool()> go_on{};  ///< asked before each iteration; false: no answer, as if it fitted
};
[[nodiscard]] Result<void> fits_road(const road::Track& track, const CarSize& car, const Fit& fit);

}  // namespace chicane::lap_time
