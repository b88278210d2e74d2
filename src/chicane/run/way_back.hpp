// SPDX-License-Identifier: MIT
// Runs that start beside the road or out of control: whether, and when, the car is back and laps again.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/model/state.hpp"
#include "chicane/road/track.hpp"
#include "chicane/run/make.hpp"
#include "chicane/run/roads.hpp"
#include "chicane/scenario/scenario.hpp"

namespace chicane::run {

/// Kind of the starting state of a car that must find back to its road.
enum class StartKind : std::uint8_t {
  kStanding = 0,   ///< at rest, in any direction
  kRolling = 1,    ///< forward, in any direction, 2 to 25 m/s
  kSliding = 2,    ///< 5 to 25 m/s, sideslip up to 60°, yaw rate up to 1 rad/s
  kBackwards = 3,  ///< rolling backwards, 1 to 8 m/s
  kSpun = 4,       ///< 5 to 20 m/s, sideslip beyond 90°, yaw rate up to 3 rad/s
};
inline constexpr std::array<std::string_view, 5> kStartKindNames{"standing", "rolling", "sliding",
                                                                 "backwards", "spun"};

/// Starting state of one run.
struct StartPose {
  StartKind kind = StartKind::kStanding;
  model::State state{};
};

/// Largest distance of a start from the nearest edge [m]; chosen: as wide as run-off areas.
inline constexpr double kFarthest = 30.0;
/// Random starts along a track: `count` of them, the kinds in turn, with the centre of mass on the road or up
/// to kFarthest beside it. Equal seeds give equal starts.
[[nodiscard]] std::vector<StartPose> start_poses(const road::Track& track, int count, std::uint64_t seed);

/// Outcome of a start. The car is back once it has been on the road, within kAlong of the road's direction,
/// for kBack, or has stood there. It laps once it is back and also faster than kLapping.
struct WayBackOutcome {
  StartPose start;
  double back = kNever;        ///< time at which the car was back [s]
  double lapping = kNever;     ///< time at which the car began to lap [s]
  double farthest = 0.0;       ///< largest distance of a tyre beyond the edge before the car was back [m]
  double least_edge = kNever;  ///< least gap of a tyre to the edge after that [m]; < 0: left the road again
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  /// Whether the car laps in time, and has not left the road again.
  [[nodiscard]] bool has_come_back() const noexcept { return lapping < kInTime && !(least_edge < 0.0); }
  static constexpr double kInTime = 60.0;  ///< longest time from the start to lapping [s]; chosen
};
// Chosen.
inline constexpr double kBack = 1.0;      ///< time along the road after which a car is back [s]
inline constexpr double kAlong = 0.35;    ///< largest angle of course and heading to the road [rad]
inline constexpr double kLapping = 5.0;   ///< speed from which a car laps [m/s]: well above walking pace
inline constexpr double kWatched = 15.0;  ///< time that is driven after the car laps [s]

/// Drives `scenario` from `start` until kWatched after the car laps, or until kInTime. Deterministic.
[[nodiscard]] Result<WayBackOutcome> drive_back(const scenario::Scenario& scenario, const StartPose& start,
                                                Roads& roads, const Factories& make = {});

}  // namespace chicane::run
