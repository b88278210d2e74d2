// SPDX-License-Identifier: MIT
// Laps to race by: planned before a run, replanned during it with learned grip, and driven again without each
// cause of lost time.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/base/vec2.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/lap_time/limit.hpp"
#include "chicane/road/racing_road.hpp"
#include "chicane/road/track.hpp"
#include "chicane/run/worker.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/telemetry/metrics.hpp"

namespace chicane::run {

/// TrackingMpcOptions::plan_budget of the scenario [s].
[[nodiscard]] double plan_budget(const scenario::Scenario& scenario) noexcept;

/// Planned lap to race by; null: none.
using PlannedLap = std::shared_ptr<const road::RacingRoad>;

/// Whether the scenario's car gets round `track` within the width that its controller may use.
/// kInvalidArgument names place and radius, or the width: "track: hairpins is not for the car indy: the bend
/// at s = ...".
[[nodiscard]] Result<void> check_room(const scenario::Scenario& scenario, const road::Track& track);

/// Callbacks of plan_lap().
struct PlanHooks {
  std::function<void(const lap_time::PlanProgress&)> on_progress{};  ///< each iteration; may be empty
  std::function<void(std::string_view)> say{};  ///< gets a line if the plan is no optimum; may be empty
};

/// Lap that a scenario's controller races by: the minimum-time line of the assumed car on `track`, with the
/// shares of grip and brakes and the margin to the edges in the controller's settings. Null if the controller
/// does not race, may use waypoints only (GuardRoad::kWaypoints), or no line is found: the controller then
/// follows its reference. If TrackingMpcOptions::plan_budget ends the search, the best line so far.
///
/// Takes 1 to 30 s (lap_time::plan_racing_line), or milliseconds from the cache (plan_cache.hpp). Equal
/// scenarios and tracks give equal bits. kInvalidArgument for a road that is too narrow or too tight, and
/// after must_stop_planning().
[[nodiscard]] Result<PlannedLap> plan_lap(const scenario::Scenario& scenario, const road::Track* track,
                                          const PlanHooks& hooks = {});

/// Lap that a controller requests during a run, with learned grip: on `track`, or on a road through waypoints
/// that leaves TrackingMpcOptions::assumed_half_width to each side for the centre of mass. Null if the
/// request is for the track, and `track` is null. `go_on` is asked in each iteration; false ends the search.
/// Equal scenarios, tracks and requests give equal bits.
[[nodiscard]] Result<PlannedLap> plan_wanted_lap(const scenario::Scenario& scenario, const road::Track* track,
                                                 const controller::LapRequest& request,
                                                 const std::function<bool()>& go_on = {});

class ClosedLoop;
class ControlCycle;

/// Planner of the laps that a controller requests during a run (Controller::wants_lap). In real time a thread
/// of low priority plans beside the run; in virtual time the plan is made at once and takes effect after
/// kPlanningTime. A plan depends on scenario, road and learned grip alone; recordings hold the grip and the
/// time of effect, as the change lap_change().
///
/// Used on the thread of the run. The destructor cancels a search, and waits for one of its iterations.
class LapPlanner {
 public:
  enum class Clock { kReal, kVirtual };
  /// Duration of a search in virtual time [s]; chosen: about that of a search in real time.
  static constexpr double kPlanningTime = 5.0;

  explicit LapPlanner(Clock clock) noexcept : clock_{clock} {}
  /// Planner of a copy of the run. Pre: kVirtual.
  LapPlanner(const LapPlanner& other)
      : clock_{other.clock_},
        wanted_since_{other.wanted_since_},
        ready_since_{other.ready_since_},
        has_answered_{other.has_answered_},
        lap_{other.lap_} {}

  // A car at the limit of its tyres cannot steer to a distant line: a new lap is used where the planned
  // positions lie near it. Chosen.
  static constexpr double kJoining = 0.4;       ///< largest distance of the plan to a lap just found [m]
  static constexpr double kJoiningGrows = 0.1;  ///< growth of that distance with time [m/s]

  /// Lap to use from the next control cycle on, returned once; otherwise null. Call it after each cycle, at
  /// the run's `time` [s]. Allocates when a search begins; does not wait for a search in real time. `track`:
  /// the road, or null if unknown; outlives this.
  [[nodiscard]] PlannedLap follow(const controller::Controller& controller,
                                  const scenario::Scenario& scenario, const road::Track* track, double time);

  /// Calls follow() after a control cycle of a run, and sets the lap. Returns its change for recordings and
  /// viewers; none without a new lap.
  std::optional<telemetry::Change> advance(ClosedLoop& loop);
  /// Does the same in a run without a plant, at its `time` [s].
  std::optional<telemetry::Change> advance(ControlCycle& cycle, const scenario::Scenario& scenario,
                                           const road::Track* track, double time);

  /// Change for recordings and viewers when `lap` is used from control cycle `cycle` on. Its value is the
  /// grip of the plan, then kSlip and the share of slip if slip is kept in reserve, then kSlides if the plan
  /// slides. Allocates.
  [[nodiscard]] static telemetry::Change lap_change(const road::RacingRoad& lap, std::uint64_t cycle,
                                                    double time);
  static constexpr std::string_view kChange = "run.racing_line";  ///< name of the change
  static constexpr std::string_view kSlides = ", slides";
  static constexpr std::string_view kSlip = ", slip ";

 private:
  /// Inputs of a search on the planning thread.
  struct Search {
    scenario::Scenario scenario;
    const road::Track* track = nullptr;
    controller::LapRequest request;
    std::vector<Vec2> waypoints;  ///< copy of the request's waypoints, which it only refers to
  };
  /// Begins the search on the thread, with copies of scenario and waypoints.
  void begin(const scenario::Scenario& scenario, const road::Track* track,
             const controller::LapRequest& request);
  /// Lap by plan_wanted_lap(); null also after an error.
  [[nodiscard]] static PlannedLap planned(const scenario::Scenario& scenario, const road::Track* track,
                                          const controller::LapRequest& request,
                                          const std::function<bool()>& is_wanted);

  Clock clock_;
  std::optional<double> wanted_since_;  ///< time of the current request [s]; none: no request
  std::optional<double> ready_since_;   ///< time at which its lap_ was found [s]
  bool has_answered_ = false;           ///< the current request has been answered
  PlannedLap lap_;                      ///< lap that waits until the car is near it
  std::optional<NewestTask<Search, PlannedLap>> search_;
};

/// Drives `scenario` again without one cause of lost time at a time: latency with its jitter, noise and age
/// of the sensor, margin to the edges, reserve of grip and brakes, guard (docs/limit.md, "The gap by
/// corner"). Leaves out causes that the scenario does not have.
///
/// Uses as many threads as there are processors; each run plans its own lap. `go_on` is asked repeatedly on
/// these threads; false ends with the complete runs. Fails if a run cannot be made. Deterministic. Allocates.
[[nodiscard]] Result<std::vector<lap_time::LapWithout>> laps_without(const scenario::Scenario& scenario,
                                                                     const std::function<bool()>& go_on = {});

}  // namespace chicane::run
