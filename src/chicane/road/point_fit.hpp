// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "chicane/road/track.hpp"

namespace chicane::road {

/// Distance of a file's points from the line that was smoothed out of them [m].
struct PointFit {
  double rms = 0.0;
  double most = 0.0;
};

[[nodiscard]] inline PointFit point_fit(const Track& track) {
  const std::size_t count = std::min(track.raw_points().size(), track.raw_places().size());
  PointFit fit;
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double away =
        (track.centre().at(track.raw_places()[i]).position - track.raw_points()[i].position).norm();
    sum += away * away;
    fit.most = std::max(fit.most, away);
  }
  fit.rms = std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, count)));
  return fit;
}

}  // namespace chicane::road
