// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "chicane/lap_time/detail/plant_model.hpp"
#include "chicane/road/track.hpp"

namespace chicane::lap_time {

/// What a first guess of a lap knows of a car.
struct GuessCar {
  double grip = 8.0;    ///< sideways [m/s²]
  double drive = 3.0;   ///< [m/s²]
  double brake = 5.0;   ///< [m/s²]
  double speed = 60.0;  ///< top speed [m/s]
  double front_axle = 1.25, rear_axle = 1.45;
};

/// Speeds at the nodes along the centre line by curvature, then braking, then drive.
[[nodiscard]] std::vector<double> guess_speeds(const std::vector<double>& curvature,
                                               const std::vector<double>& step, const GuessCar& car);

/// Nodes about `time_step` [s] apart at the speed of the guess, from s = 0 on; at least `least` [m].
[[nodiscard]] RoadNodes lay_nodes(const road::Track& track, const GuessCar& car, double time_step);

}  // namespace chicane::lap_time
