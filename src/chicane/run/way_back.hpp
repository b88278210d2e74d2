// SPDX-License-Identifier: MIT
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

/// Starting state of a car that must find back to its road.
enum class StartKind : std::uint8_t {
  kStanding = 0,   ///< at rest, in any direction
  kRolling = 1,    ///< forward, in any direction, 2 to 25 m/s
  kSliding = 2,    ///< 5 to 25 m/s, up to 60° beside where it points, turning with up to 1 rad/s
  kBackwards = 3,  ///< rolling backwards, 1 to 8 m/s
  kSpun = 4,       ///< 5 to 20 m/s, more than 90° beside where it points, turning with up to 3 rad/s
};
inline constexpr std::array<std::string_view, 5> kStartKindNames{"standing", "rolling", "sliding",
                                                                 "backwards", "spun"};

struct StartPose {
  StartKind kind = StartKind::kStanding;
  model::State state{};
};

/// `count` poses along a track, the kinds in turn, the centre of mass on the road or up to kFarthest beside
/// it. Equal seeds give equal poses.
inline constexpr double kFarthest = 30.0;  ///< distance from the nearest edge [m]
[[nodiscard]] std::vector<StartPose> start_poses(const road::Track& track, int count, std::uint64_t seed);

/// Outcome of a start. The car is back once it has been on the road for kBack, or has stood on it, with its
/// course less than kAlong off the road's; it laps once it is also faster than walking pace.
struct WayBackOutcome {
  StartPose start;
  double back = kNever;        ///< time at which it was back [s]
  double lapping = kNever;     ///< time at which it lapped [s]
  double farthest = 0.0;       ///< largest distance beyond the edge until then [m]
  double least_edge = kNever;  ///< least gap of a tyre after it was back [m]; < 0: left the road again
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  [[nodiscard]] bool has_come_back() const noexcept { return lapping < kInTime && !(least_edge < 0.0); }
  static constexpr double kInTime = 60.0;  ///< [s]
};
inline constexpr double kBack = 1.0;      ///< [s]
inline constexpr double kAlong = 0.35;    ///< [rad]
inline constexpr double kLapping = 5.0;   ///< [m/s]
inline constexpr double kWatched = 15.0;  ///< [s] driven on after it laps

/// Drives one start: `scenario` from `start` until kWatched after it laps, or kInTime. Deterministic.
[[nodiscard]] Result<WayBackOutcome> drive_back(const scenario::Scenario& scenario, const StartPose& start,
                                                Roads& roads, const Factories& make = {});

}  // namespace chicane::run
