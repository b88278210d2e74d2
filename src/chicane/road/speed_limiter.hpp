// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace chicane::road {

/// What keeps the car from being faster where it is.
enum class SpeedLimiter : std::uint8_t {
  kNone = 0,       ///< nothing that is known
  kAsked = 1,      ///< the speed that was asked for is reached
  kCurvature = 2,  ///< the grip planned with, in the bend
  kBraking = 3,    ///< a slower place ahead
  kPower = 4,      ///< the drive: the throttle is at its bound, or was on the way out of the last bend
  kSight = 5,      ///< the known road ends too soon
};

}  // namespace chicane::road
