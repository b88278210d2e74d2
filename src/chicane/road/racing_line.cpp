// SPDX-License-Identifier: MIT
#include "chicane/road/racing_line.hpp"

#include <algorithm>
#include <cmath>

namespace chicane::road {

RacingLinePoint RacingLine::at(double s) const noexcept {
  if (is_empty() || !(length > 0.0) || !std::isfinite(s)) return {};
  const double wrapped = std::clamp(s - length * std::floor(s / length), 0.0, length);
  const auto behind = std::upper_bound(points.begin() + 1, points.end() - 1, wrapped,
                                       [](double place, const RacingLinePoint& p) { return place < p.s; });
  const RacingLinePoint& a = *(behind - 1);
  const RacingLinePoint& b = *behind;
  const double share = b.s > a.s ? (wrapped - a.s) / (b.s - a.s) : 0.0;
  const auto between = [&](double RacingLinePoint::*value) {
    return a.*value + share * (b.*value - a.*value);
  };
  using P = RacingLinePoint;
  return {.s = wrapped,
          .time = between(&P::time),
          .offset = between(&P::offset),
          .heading = between(&P::heading),
          .vx = between(&P::vx),
          .vy = between(&P::vy),
          .yaw_rate = between(&P::yaw_rate),
          .steer = between(&P::steer),
          .steer_asked = between(&P::steer_asked),
          .acceleration = between(&P::acceleration),
          .throttle = between(&P::throttle)};
}

}  // namespace chicane::road
