// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

namespace chicane::lap_time {

/// Times of a lap and of its thirds from the start line on [s].
struct LapTimes {
  double lap = 0.0;
  std::array<double, 3> sectors{};
  std::vector<double> corners{};  ///< corners of the track, each with half of the straights beside it
};

/// Best lap of a run that was driven again without one thing that costs time (run/laps_without.hpp).
struct LapWithout {
  std::string cause;  ///< name of the thing that was taken away: "latency"
  double lap_time = std::numeric_limits<double>::quiet_NaN();  ///< [s]; not-a-number: no lap was completed
  std::vector<double> corners{};  ///< times as LapTimes::corners; empty without a lap
  int off_track_events = 0;       ///< count in the whole run
};

/// How much longer `time` is than the limit's, relative: 0.05 is five per cent slower. Not-a-number for one
/// that was not measured. Pre: limit > 0.
[[nodiscard]] constexpr double gap(double time, double limit) noexcept { return time / limit - 1.0; }

}  // namespace chicane::lap_time
