// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/sim/fault.hpp"

/// Faults of the computer and of the way from it to the actuators.
namespace chicane::sim {

inline constexpr FaultKind kSlowSolver{
    .name = "slow_solver",
    .meaning = "The deadline of each step is spent almost at once.",
    .duration = 5.0,
    .strength = 1.0,
    .weakest = 1.0,
    .strongest = 100.0,
    .strength_meaning = "questions to the clock until then",
    .deadline_questions = [](double strength) noexcept { return static_cast<std::uint32_t>(strength); },
};

inline constexpr FaultKind kDeadController{
    .name = "dead_controller",
    .meaning = "No command arrives.",
    .loses_command = [](FaultMemory&) noexcept { return true; },
};

inline constexpr FaultKind kDelayDoubled{
    .name = "delay_doubled",
    .meaning = "Commands take longer than the controller knows.",
    .duration = 5.0,
    .strength = 2.0,
    .weakest = 1.0,
    .strongest = 5.0,
    .strength_meaning = "times the latency",
    .extra_delay = [](double strength, double latency) noexcept { return (strength - 1.0) * latency; },
};

inline constexpr FaultKind kCommandDropped{
    .name = "command_dropped",
    .meaning = "Some commands never arrive.",
    .duration = 5.0,
    .strength = 0.5,
    .weakest = 0.0,
    .strongest = 1.0,
    .strength_meaning = "share that is lost",
    .stream = "loss",
    .loses_command = [](FaultMemory& memory) noexcept { return memory.random.uniform() < memory.strength; },
};

}  // namespace chicane::sim
