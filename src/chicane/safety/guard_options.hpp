// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "chicane/base/option.hpp"

namespace chicane::safety {

/// Version of the guard, in results and recordings: raised when the guard may decide differently on the same
/// input. Runs that name none are of version 1.
inline constexpr int kGuardVersion = 5;

/// What a guard does with what it finds.
enum class GuardMode : std::uint8_t {
  kOn = 0,       ///< the car is stopped on the road
  kObserve = 1,  ///< it is reported; the controller's answer is sent
  kOff = 2,      ///< nothing is checked but range and rate of the command
};
/// Where the road is known from, by the guard and by a controller that races.
enum class GuardRoad : std::uint8_t {
  kTrack = 0,      ///< the track's own, with its edges
  kWaypoints = 1,  ///< what telemetry has shown, with an assumed width
};

/// What the actuators do when commands cease (safety/stop_player.hpp).
enum class Receiver : std::uint8_t {
  kStopPlan = 0,  ///< the stop that came with the last command
  kBrake = 1,     ///< all useful braking with the last steering
  kHold = 2,      ///< the last command for ever, as the original simulator
};

/// Fixed when a run starts: no viewer can change them.
struct GuardOptions {
  GuardMode mode = GuardMode::kOn;
  GuardRoad road = GuardRoad::kTrack;
  double half_width = 3.5;  ///< of the road, each side of the waypoints, where its edges are not known [m]
  Receiver receiver = Receiver::kStopPlan;
  double margin = 0.2;  ///< that the stop at hand keeps from the edge [m]
  /// How long a receiver may have to drive the stop by itself without leaving the road; 0: not checked [s]
  double blind_time = 30.0;

  friend bool operator==(const GuardOptions&, const GuardOptions&) = default;
};
/// The fields with their units and ranges, for files and messages.
[[nodiscard]] std::span<const Option> guard_options() noexcept;

}  // namespace chicane::safety
