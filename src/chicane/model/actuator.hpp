// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <limits>

#include "chicane/base/math.hpp"

namespace chicane::model {

/// Steering with a longer time constant than this is slow [s of a car in full size]: what is asked of it runs
/// ahead of the wheel by far more than the wheel moves until the next command. Controller and gate then count
/// the rate of the wheel. Below, the change of what is asked stands in for it, as weights and limits of
/// cars in full size were chosen with (docs/decisions/0039-rates-of-slow-steering.md).
inline constexpr double kSlowSteering = 0.3;

/// From the value asked for to the value at the wheel: range, first-order lag, rate limit, in this order
/// (docs/model.md, eq. 13). Exact for a value asked for that is held over the step while the rate does not
/// bind. Plain data and one function, no allocation.
struct Actuator {
  double low = -1.0;  ///< range of the value
  double high = 1.0;
  double lag = 0.0;                                       ///< time constant [s], 0 = none
  double rate = std::numeric_limits<double>::infinity();  ///< largest change per second, > 0

  /// The value dt [s] later. Pre: dt >= 0, all finite.
  [[nodiscard]] double next(double value, double asked, double dt) const noexcept {
    const double target = std::clamp(asked, low, high);
    const double share = lag > 0.0 ? 1.0 - exp(-dt / lag) : 1.0;
    const double change = std::clamp((target - value) * share, -rate * dt, rate * dt);
    return std::clamp(value + change, low, high);
  }
};

}  // namespace chicane::model
