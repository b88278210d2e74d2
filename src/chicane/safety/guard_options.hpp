// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "chicane/base/option.hpp"
#include "chicane/controller/guard_words.hpp"

namespace chicane::safety {

/// What the guard did in a control cycle, and why.
struct GuardReport {
  controller::Rung rung = controller::Rung::kController;  ///< whose command was sent
  bool gated = false;                                     ///< the command gate had to change it
  /// The worst that was found; with GuardMode::kObserve also where nothing was done about it.
  controller::GuardReason reason = controller::GuardReason::kNone;
  /// Of the stop at hand: least distance of a tyre to the known edge [m]; not-a-number: none at hand.
  double stop_edge = std::numeric_limits<double>::quiet_NaN();
  double stop_distance = std::numeric_limits<double>::quiet_NaN();  ///< and its length [m]
};

/// Version of the guard, in results and recordings: raised when the guard may decide differently on the same
/// input. Runs that name none are of version 1.
inline constexpr int kGuardVersion = 6;

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
