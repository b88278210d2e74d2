// SPDX-License-Identifier: MIT
#include "chicane/controller/speed_hold.hpp"

#include <algorithm>
#include <cmath>

namespace chicane::controller {
namespace {

constexpr double kComfortableBraking = 3.0;  ///< assumed on the way to a curve [m/s²]
constexpr double kSampleSpacing = 2.0;       ///< at which the curvature ahead is looked at [m]
constexpr int kMaxSamples = 100;             ///< and how often

}  // namespace

SpeedHold::Wanted SpeedHold::reference(const road::Path& path, double s) const noexcept {
  double wanted_squared = options_.speed_reference * options_.speed_reference;
  SpeedLimiter limiter = SpeedLimiter::kAsked;
  const double sight = path.length() - s;
  for (int i = 0; i < kMaxSamples && i * kSampleSpacing <= sight; ++i) {
    const double ahead = i * kSampleSpacing;
    const double curvature = std::fabs(path.at(s + ahead).curvature);
    const double limit_squared = options_.lateral_acceleration_limit / std::max(curvature, 1e-6);
    const double here_squared = limit_squared + 2.0 * kComfortableBraking * ahead;
    if (here_squared < wanted_squared) {
      wanted_squared = here_squared;
      limiter = i == 0 ? SpeedLimiter::kCurvature : SpeedLimiter::kBraking;
    }
  }
  return {std::sqrt(wanted_squared), limiter};
}

double SpeedHold::throttle(double wanted, double v) const noexcept {
  const double holding = model::throttle_for(vehicle_, 0.0, v);
  const double pedal = std::clamp(holding + options_.speed_gain * (wanted - v), -1.0, 1.0);
  return pedal >= 0.0 ? pedal : pedal * vehicle_.brake_throttle_limit;
}

}  // namespace chicane::controller
