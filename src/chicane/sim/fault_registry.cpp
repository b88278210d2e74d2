// SPDX-License-Identifier: MIT
// Table of faults: name, place, range and effect of each. Durations, strengths and ranges were chosen.
#include <array>
#include <limits>

#include "chicane/base/math.hpp"
#include "chicane/sim/fault.hpp"

namespace chicane::sim {
namespace {

// Faults of the car and its road.

constexpr FaultKind kHalfGrip{
    .name = "half_grip",
    .meaning = "Tyre forces are reduced.",
    .duration = 5.0,
    .strength = 0.5,
    .weakest = 0.05,
    .strongest = 1.0,
    .strength_meaning = "share of the force that is left",
    .grip = [](double strength) noexcept { return strength; },
};

constexpr FaultKind kIcePatch{
    .name = "ice_patch",
    .meaning = "A short stretch of ice.",
    .duration = 0.3,
    .strength = 0.1,
    .weakest = 0.05,
    .strongest = 1.0,
    .strength_meaning = "share of the force that is left",
    .grip = [](double strength) noexcept { return strength; },
};

constexpr FaultKind kSideWind{
    .name = "side_wind",
    .meaning = "A gust from the right.",
    .duration = 2.0,
    .strength = 2.0,
    .weakest = -10.0,
    .strongest = 10.0,
    .strength_meaning = "push to the left [m/s²]",
    .side_acceleration = [](double strength) noexcept { return strength; },
};

constexpr FaultKind kWeakBrakes{
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

constexpr FaultKind kSteeringStuck{
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

constexpr FaultKind kSteeringOffset{
    .name = "steering_offset",
    .meaning = "The wheel's angle differs from the command.",
    .duration = 5.0,
    .strength = 2.0,
    .weakest = -20.0,
    .strongest = 20.0,
    .strength_meaning = "angle to the left [deg]",
    .actuate = [](FaultMemory& memory, const model::Command&,
                  model::Command& done) noexcept { done.steer += degrees_to_radians(memory.strength); },
};

constexpr FaultKind kThrottleStuck{
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

// Faults of the computer and of the link from it to the actuators.

constexpr FaultKind kSlowSolver{
    .name = "slow_solver",
    .meaning = "The deadline of each step is spent almost at once.",
    .duration = 5.0,
    .strength = 1.0,
    .weakest = 1.0,
    .strongest = 100.0,
    .strength_meaning = "questions to the clock until then",
    .deadline_questions = [](double strength) noexcept { return static_cast<std::uint32_t>(strength); },
};

constexpr FaultKind kDeadController{
    .name = "dead_controller",
    .meaning = "No command arrives.",
    .loses_command = [](FaultMemory&) noexcept { return true; },
};

constexpr FaultKind kDelayDoubled{
    .name = "delay_doubled",
    .meaning = "Commands take longer than the controller knows.",
    .duration = 5.0,
    .strength = 2.0,
    .weakest = 1.0,
    .strongest = 5.0,
    .strength_meaning = "times the latency",
    .extra_delay = [](double strength, double latency) noexcept { return (strength - 1.0) * latency; },
};

constexpr FaultKind kCommandDropped{
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

// Faults of the sensors and of the link from them to the computer.

constexpr FaultKind kLinkLost{
    .name = "link_lost",
    .meaning = "No measurement arrives.",
    .duration = 2.0,
    .place = FaultPlace::kLink,
    .measure =
        [](FaultMemory&, const model::Measurement&, model::Measurement& measured) noexcept {
          measured.waypoint_count = 0;
          measured.x = measured.y = measured.psi = measured.speed = std::numeric_limits<double>::quiet_NaN();
          measured.steer = measured.throttle = std::numeric_limits<double>::quiet_NaN();
        },
};

constexpr FaultKind kFrozenSensor{
    .name = "frozen_sensor",
    .meaning = "The sensors repeat their last measurement with a new time.",
    .place = FaultPlace::kSource,
    .measure =
        [](FaultMemory& memory, const model::Measurement& now, model::Measurement& measured) noexcept {
          if (!memory.measurement) memory.measurement = now;
          measured = *memory.measurement;
          measured.time = now.time;
          measured.delay = now.delay;
        },
};

constexpr FaultKind kNanMeasurement{
    .name = "nan_measurement",
    .meaning = "Position, yaw and speed are not numbers.",
    .duration = 2.0,
    .place = FaultPlace::kLink,
    .measure =
        [](FaultMemory&, const model::Measurement&, model::Measurement& measured) noexcept {
          measured.x = measured.y = measured.psi = measured.speed = std::numeric_limits<double>::quiet_NaN();
        },
};

constexpr FaultKind kPositionJump{
    .name = "position_jump",
    .meaning = "The measured position lies to the left of the car.",
    .strength = 5.0,
    .weakest = -100.0,
    .strongest = 100.0,
    .strength_meaning = "distance, right negative [m]",
    .measure =
        [](FaultMemory& memory, const model::Measurement& now, model::Measurement& measured) noexcept {
          measured.x -= memory.strength * sin(now.psi);
          measured.y += memory.strength * cos(now.psi);
        },
};

constexpr FaultKind kGpsNoise{
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
        [](FaultMemory& memory, const model::Measurement&, model::Measurement& measured) noexcept {
          measured.x += memory.strength * memory.random.normal();
          measured.y += memory.strength * memory.random.normal();
        },
};

constexpr FaultKind kSpeedSensorZero{
    .name = "speed_sensor_zero",
    .meaning = "The measured speed is zero.",
    .measure = [](FaultMemory&, const model::Measurement&,
                  model::Measurement& measured) noexcept { measured.speed = 0.0; },
};

constexpr FaultKind kWaypointsMissing{
    .name = "waypoints_missing",
    .meaning = "Telemetry shows no waypoints.",
    .duration = 2.0,
    .place = FaultPlace::kLink,
    .measure = [](FaultMemory&, const model::Measurement&,
                  model::Measurement& measured) noexcept { measured.waypoint_count = 0; },
};

/// The list. A new fault is added as the last line, because recordings know faults by their index.
// clang-format off
constexpr std::array kKinds{
    kLinkLost,
    kFrozenSensor,
    kNanMeasurement,
    kPositionJump,
    kGpsNoise,
    kSpeedSensorZero,
    kWaypointsMissing,
    kHalfGrip,
    kIcePatch,
    kSideWind,
    kWeakBrakes,
    kSteeringStuck,
    kSteeringOffset,
    kThrottleStuck,
    kSlowSolver,
    kDeadController,
    kDelayDoubled,
    kCommandDropped,
};
// clang-format on
static_assert(kKinds.size() <= kMostFaults);

}  // namespace

std::span<const FaultKind> fault_kinds() noexcept { return kKinds; }

}  // namespace chicane::sim
