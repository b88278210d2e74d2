// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/base/math.hpp"
#include "chicane/model/state.hpp"

namespace chicane::controller {

/// A road that bends to the left: six waypoints 12 m apart on a circle of 80 m, the first 6 m behind the car;
/// the car 0.5 m left of it, on the heading of the road, at 15 m/s. In W the car stands at (x, y, psi).
inline model::Measurement on_a_left_bend(double x = 0.0, double y = 0.0, double psi = 0.0) {
  constexpr double kRadius = 80.0;
  constexpr double kOffset = 0.5;
  model::Measurement now;
  now.time = 5.0;
  now.x = x;
  now.y = y;
  now.psi = psi;
  now.speed = 15.0;
  now.steer = 0.02;
  now.throttle = 0.3;
  now.delay = 0.1;
  now.waypoint_count = 6;
  for (int i = 0; i < 6; ++i) {
    const double angle = (12.0 * i - 6.0) / kRadius;
    const double ahead = kRadius * sin(angle);
    const double left = kRadius * (1.0 - cos(angle)) - kOffset;
    now.waypoints[static_cast<std::size_t>(i)] = {x + cos(psi) * ahead - sin(psi) * left,
                                                  y + sin(psi) * ahead + cos(psi) * left};
  }
  return now;
}

/// The same world seen in a mirror along W's x axis.
inline model::Measurement mirrored(model::Measurement now) {
  now.y = -now.y;
  now.psi = -now.psi;
  now.steer = -now.steer;
  for (Vec2& point : now.waypoints) point.y() = -point.y();
  return now;
}

}  // namespace chicane::controller
