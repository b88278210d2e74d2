// SPDX-License-Identifier: MIT
#include <array>

#include "chicane/sim/detail/faults.hpp"
#include "chicane/sim/fault.hpp"

namespace chicane::sim {
namespace {

/// A new fault is a line here and its include. It is the last line: recordings know faults by their index.
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
