// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include "chicane/base/math.hpp"
#include "chicane/sim/fault.hpp"

/// Faults between the car and what the controller is told.
namespace chicane::sim {

inline constexpr FaultKind kLinkLost{
    .name = "link_lost",
    .meaning = "No measurement arrives.",
    .duration = 2.0,
    .place = FaultPlace::kLink,
    .measure =
        [](FaultMemory&, const model::Measurement&, model::Measurement& told) noexcept {
          told.waypoint_count = 0;
          told.x = told.y = told.psi = told.speed = std::numeric_limits<double>::quiet_NaN();
          told.steer = told.throttle = std::numeric_limits<double>::quiet_NaN();
        },
};

inline constexpr FaultKind kFrozenSensor{
    .name = "frozen_sensor",
    .meaning = "The sensors repeat their last measurement with a new time.",
    .place = FaultPlace::kSource,
    .measure =
        [](FaultMemory& memory, const model::Measurement& now, model::Measurement& told) noexcept {
          if (!memory.measurement) memory.measurement = now;
          told = *memory.measurement;
          told.time = now.time;
          told.delay = now.delay;
        },
};

inline constexpr FaultKind kNanMeasurement{
    .name = "nan_measurement",
    .meaning = "Position, yaw and speed are not numbers.",
    .duration = 2.0,
    .place = FaultPlace::kLink,
    .measure =
        [](FaultMemory&, const model::Measurement&, model::Measurement& told) noexcept {
          told.x = told.y = told.psi = told.speed = std::numeric_limits<double>::quiet_NaN();
        },
};

inline constexpr FaultKind kPositionJump{
    .name = "position_jump",
    .meaning = "The measured position lies to the left of the car.",
    .strength = 5.0,
    .weakest = -100.0,
    .strongest = 100.0,
    .strength_meaning = "distance, right negative [m]",
    .measure =
        [](FaultMemory& memory, const model::Measurement& now, model::Measurement& told) noexcept {
          told.x -= memory.strength * sin(now.psi);
          told.y += memory.strength * cos(now.psi);
        },
};

inline constexpr FaultKind kGpsNoise{
    .name = "gps_noise",
    .meaning = "The measured position is noisy.",
    .duration = 3.0,
    .strength = 0.5,
    .weakest = 0.0,
    .strongest = 100.0,
    .strength_meaning = "standard deviation [m]",
    .stream = "noise",
    .place = FaultPlace::kSource,
    .measure =
        [](FaultMemory& memory, const model::Measurement&, model::Measurement& told) noexcept {
          told.x += memory.strength * memory.random.normal();
          told.y += memory.strength * memory.random.normal();
        },
};

inline constexpr FaultKind kSpeedSensorZero{
    .name = "speed_sensor_zero",
    .meaning = "The measured speed is zero.",
    .measure = [](FaultMemory&, const model::Measurement&,
                  model::Measurement& told) noexcept { told.speed = 0.0; },
};

inline constexpr FaultKind kWaypointsMissing{
    .name = "waypoints_missing",
    .meaning = "Telemetry shows no waypoints.",
    .duration = 2.0,
    .place = FaultPlace::kLink,
    .measure = [](FaultMemory&, const model::Measurement&,
                  model::Measurement& told) noexcept { told.waypoint_count = 0; },
};

}  // namespace chicane::sim
