// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/sim/fault.hpp"

namespace chicane::sim {

inline constexpr FaultKind kFastSpeedometer{
    .name = "fast_speedometer",
    .meaning = "The measured speed is too high.",
    .duration = 2.0,
    .strength = 1.5,
    .weakest = 1.0,
    .strongest = 4.0,
    .strength_meaning = "times the speed",
    .measure = [](FaultMemory& memory, const model::Measurement&,
                  model::Measurement& measured) noexcept { measured.speed *= memory.strength; },
};

}  // namespace chicane::sim
