// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/base/angle.hpp"
#include "chicane/sim/fault.hpp"

/// Faults of the car and of what it drives on.
namespace chicane::sim {

inline constexpr FaultKind kHalfGrip{
    .name = "half_grip",
    .meaning = "Tyre forces are reduced.",
    .duration = 5.0,
    .strength = 0.5,
    .weakest = 0.05,
    .strongest = 1.0,
    .strength_meaning = "share of the force that is left",
    .grip = [](double strength) noexcept { return strength; },
};

inline constexpr FaultKind kIcePatch{
    .name = "ice_patch",
    .meaning = "A short stretch of ice.",
    .duration = 0.3,
    .strength = 0.1,
    .weakest = 0.05,
    .strongest = 1.0,
    .strength_meaning = "share of the force that is left",
    .grip = [](double strength) noexcept { return strength; },
};

inline constexpr FaultKind kSideWind{
    .name = "side_wind",
    .meaning = "A gust from the right.",
    .duration = 2.0,
    .strength = 2.0,
    .weakest = -10.0,
    .strongest = 10.0,
    .strength_meaning = "push to the left [m/s²]",
    .side_acceleration = [](double strength) noexcept { return strength; },
};

inline constexpr FaultKind kWeakBrakes{
    .name = "weak_brakes",
    .meaning = "The brakes give less than asked for.",
    .duration = 5.0,
    .strength = 0.3,
    .weakest = 0.0,
    .strongest = 1.0,
    .strength_meaning = "share that is left",
    .actuate =
        [](FaultMemory& memory, const model::Command&, model::Command& done) noexcept {
          if (done.throttle < 0.0) done.throttle *= memory.strength;
        },
};

inline constexpr FaultKind kSteeringStuck{
    .name = "steering_stuck",
    .meaning = "The wheel stays where it is.",
    .duration = 0.5,
    .place = FaultPlace::kSource,
    .actuate =
        [](FaultMemory& memory, const model::Command& asked, model::Command& done) noexcept {
          if (!memory.value) memory.value = asked.steer;
          done.steer = *memory.value;
        },
};

inline constexpr FaultKind kSteeringOffset{
    .name = "steering_offset",
    .meaning = "The wheel stands off what is asked for.",
    .duration = 5.0,
    .strength = 2.0,
    .weakest = -20.0,
    .strongest = 20.0,
    .strength_meaning = "angle to the left [deg]",
    .actuate = [](FaultMemory& memory, const model::Command&,
                  model::Command& done) noexcept { done.steer += degrees_to_radians(memory.strength); },
};

inline constexpr FaultKind kThrottleStuck{
    .name = "throttle_stuck",
    .meaning = "The pedal stays where it is.",
    .duration = 2.0,
    .place = FaultPlace::kSource,
    .actuate =
        [](FaultMemory& memory, const model::Command& asked, model::Command& done) noexcept {
          if (!memory.value) memory.value = asked.throttle;
          done.throttle = *memory.value;
        },
};

}  // namespace chicane::sim
