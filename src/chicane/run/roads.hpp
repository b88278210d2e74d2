// SPDX-License-Identifier: MIT
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

/// Distance beyond a road's edge within which waypoints still belong to it [m]: maps of one road differ.
inline constexpr double kBesideRoad = 5.0;

/// Whether the waypoints that are shown belong to another road than `track`: at least half of them, of two or
/// more, lie more than kBesideRoad beyond its edges. Then the distance of the farthest from its line [m],
/// otherwise nothing. Cost: a search of the whole line for each waypoint.
[[nodiscard]] std::optional<double> distance_to_other_road(const road::Track& track,
                                                           const model::Measurement& shown) noexcept;

/// Parts that many runs on a few roads share, made once: reading a track file and smoothing its line for the
/// guard take milliseconds, as long as ten simulated seconds. Remembers the last kRemembered roads, and the
/// files that runs are composed of. Runs that use it are the same bit for bit as those that do not. One
/// thread.
class Roads {
 public:
  static constexpr std::size_t kRemembered = 16;

  struct Prepared {
    road::Track track;
    road::Track waypoints;                        ///< waypoints that telemetry shows
    road::KnownRoad known;                        ///< road known to the guard at the start
    std::shared_ptr<const road::RacingRoad> lap;  ///< planned, of a controller that races; null of any other
  };
  /// Road of scenario.track, for its guard and vehicle. Fails as `make` does. Valid until the next call.
  /// `make` must be the same in all calls: a road is remembered by its scenario. `hooks`: of plan_lap().
  [[nodiscard]] Result<const Prepared*> of(const scenario::Scenario& scenario,
                                           const TrackFactory& make = make_track,
                                           const PlanHooks& hooks = {});
  /// run::check_room() on `road`, which is of(scenario): remembered where it is the car of the call before,
  /// as it takes up to 0.1 s.
  [[nodiscard]] Result<void> check_room(const scenario::Scenario& scenario, const Prepared& road);
  /// Files for protocol::compose() of these runs.
  [[nodiscard]] protocol::RememberedFiles& files() noexcept { return files_; }

 private:
  struct Entry {
    scenario::Scenario scenario;
    Prepared prepared;
    std::optional<scenario::Scenario> has_room{};  ///< scenario whose car fits
  };
  protocol::RememberedFiles files_;
  std::deque<Entry> entries_;  ///< the newest first
};

}  // namespace chicane::run
