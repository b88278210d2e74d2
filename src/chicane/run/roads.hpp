// SPDX-License-Identifier: MIT
// Roads that many runs share: track, waypoints, the guard's road and the planned lap, made once.
#pragma once

#include <deque>
#include <memory>
#include <optional>

#include "chicane/base/result.hpp"
#include "chicane/model/state.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/road/known_road.hpp"
#include "chicane/road/racing_road.hpp"
#include "chicane/road/track.hpp"
#include "chicane/run/make.hpp"
#include "chicane/run/racing.hpp"
#include "chicane/scenario/scenario.hpp"

namespace chicane::run {

/// Distance beyond a road's edge within which waypoints still belong to the road [m]. Chosen: maps of one
/// road differ by metres.
inline constexpr double kBesideRoad = 5.0;

/// Distance of the farthest waypoint of `shown` from the line of `track` [m], if the waypoints belong to
/// another road: at least half of them, of two or more, lie more than kBesideRoad beyond the edges. Otherwise
/// none. Cost: a search of the whole line for each waypoint.
[[nodiscard]] std::optional<double> distance_to_other_road(const road::Track& track,
                                                           const model::Measurement& shown) noexcept;

/// Roads that many runs share, made once: reading a track file and smoothing its line for the guard take
/// milliseconds, as long as ten simulated seconds. Remembers the newest kRemembered roads, and the files that
/// scenarios are composed of. Sharing does not change a bit of any run. One thread.
class Roads {
 public:
  static constexpr std::size_t kRemembered = 16;  ///< roads that are remembered; chosen

  /// A road with everything that is derived from it for a run.
  struct Prepared {
    road::Track track;
    road::Track waypoints;                        ///< waypoints that telemetry shows
    road::KnownRoad known;                        ///< road that the guard knows at the start
    std::shared_ptr<const road::RacingRoad> lap;  ///< planned lap; null if the controller does not race
  };
  /// Road of scenario.track, for the scenario's guard and vehicle. Fails as `make` and plan_lap() do. Valid
  /// until the next call. `make` must be the same in all calls, because a road is remembered by its scenario.
  /// `hooks`: of plan_lap().
  [[nodiscard]] Result<const Prepared*> of(const scenario::Scenario& scenario,
                                           const TrackFactory& make = make_track,
                                           const PlanHooks& hooks = {});
  /// Result of run::check_room() on `road`, which is of(scenario). A success is remembered for the next run
  /// of the same car, because the check takes up to 0.1 s.
  [[nodiscard]] Result<void> check_room(const scenario::Scenario& scenario, const Prepared& road);
  /// Files that protocol::compose() has read for these runs.
  [[nodiscard]] protocol::RememberedFiles& files() noexcept { return files_; }

 private:
  struct Entry {
    scenario::Scenario scenario;
    Prepared prepared;
    std::optional<scenario::Scenario> has_room{};  ///< scenario whose car passed check_room() here
  };
  protocol::RememberedFiles files_;
  std::deque<Entry> entries_;  ///< the newest first
};

}  // namespace chicane::run
