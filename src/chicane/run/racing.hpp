// SPDX-License-Identifier: MIT
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

/// Whether the scenario's controller races by a line that is planned for the whole road.
[[nodiscard]] bool races(const scenario::Scenario& scenario) noexcept;

/// TrackingMpcOptions::plan_budget of the scenario [s].
[[nodiscard]] double plan_budget(const scenario::Scenario& scenario) noexcept;

/// Whether the scenario's car gets round `track` by what its controller may use of the width.
/// kInvalidArgument "track: hairpins is not for the car indy: the bend at s = ..." names place and radius, or
/// the width.
[[nodiscard]] Result<void> check_room(const scenario::Scenario& scenario, const road::Track& track);

/// Callbacks of plan_lap().
struct PlanHooks {
  std::function<void(const lap_time::PlanProgress&)> on_progress{};  ///< each iteration; may be empty
  std::function<void(std::string_view)> say{};  ///< a line where it is not the optimum; may be empty
};

/// The lap that a scenario's controller races by: the minimum-time line of the car it assumes on `track`,
/// with the shares of grip and brakes and the margin to the edges in its settings. Null if the settings do
/// not ask for one, or allow waypoints only (GuardRoad::kWaypoints), or the search finds none: the controller
/// then follows its reference. Takes 1 to 30 s (lap_time::plan_racing_line), or milliseconds from the cache
/// (plan_cache.hpp). If TrackingMpcOptions::plan_budget ends the search, the best plan so far. The same
/// scenario and track give the same bits.
///
/// kInvalidArgument names the reason for no lap: a road that is too narrow or too tight, or
/// must_stop_planning().
[[nodiscard]] Result<std::shared_ptr<const road::RacingRoad>> plan_lap(const scenario::Scenario& scenario,
                                                                       const road::Track* track,
                                                                       const PlanHooks& hooks = {});

/// The lap that a controller wants: with another grip, on `track`, or on a road through waypoints with
/// TrackingMpcOptions::assumed_half_width for the centre of mass each side of them. Null where it is to be
/// the track, and that is null. `go_on` is asked in each iteration; false ends the search. The same scenario,
/// track and request give the same bits.
[[nodiscard]] Result<std::shared_ptr<const road::RacingRoad>> plan_wanted_lap(
    const scenario::Scenario& scenario, const road::Track* track, const controller::LapRequest& request,
    const std::function<bool()>& go_on = {});

class ClosedLoop;
class ControlCycle;

/// Plans the lap to race by that a controller asks for with its learned terms (Controller::wants_lap). In
/// real time a thread of low priority plans during the run; in virtual time the plan is made at once and
/// takes effect after kPlanningTime. The plan depends on scenario, road and grip alone; grip and time of
/// effect are in recordings, as the change lap_change().
///
/// One thread, that of the run. Its end cancels a search, and waits for one iteration of it.
class LapPlanner {
 public:
  enum class Clock { kReal, kVirtual };
  static constexpr double kPlanningTime = 5.0;  ///< time of a plan in virtual time [s]

  explicit LapPlanner(Clock clock) noexcept : clock_{clock} {}
  /// Planner of a copy of the run. Pre: kVirtual.
  LapPlanner(const LapPlanner& other)
      : clock_{other.clock_},
        wanted_since_{other.wanted_since_},
        ready_since_{other.ready_since_},
        has_answered_{other.has_answered_},
        lap_{other.lap_} {}

  /// A lap is taken up where the car is about to drive so near to it [m]; the longer it is ready, the farther
  /// [m/s]. A car at the limit of its tyres has nothing left to come to another line with.
  static constexpr double kJoining = 0.4;
  static constexpr double kJoiningGrows = 0.1;

  /// Lap to use from the next control cycle on, once; call it after each cycle, at the run's time [s]. Null
  /// otherwise, and on a road without a lap. Allocates when a search begins; waits for none in real time.
  /// `track`: the road, or null if unknown; outlives this.
  [[nodiscard]] std::shared_ptr<const road::RacingRoad> follow(const controller::Controller& controller,
                                                               const scenario::Scenario& scenario,
                                                               const road::Track* track, double time);

  /// follow() after a control cycle of a run: a lap that is ready is used from the next one on. Gives what
  /// recordings and viewers get of it then.
  std::optional<telemetry::Change> advance(ClosedLoop& loop);
  /// The same for a run without a plant, at its time [s].
  std::optional<telemetry::Change> advance(ControlCycle& cycle, const scenario::Scenario& scenario,
                                           const road::Track* track, double time);

  /// Change for recordings and viewers when `lap` is used from control cycle `cycle` on: the grip of its
  /// plan, kSlip with its share if it keeps slip in reserve, and kSlides if it slides. Allocates.
  [[nodiscard]] static telemetry::Change lap_change(const road::RacingRoad& lap, std::uint64_t cycle,
                                                    double time);
  static constexpr std::string_view kChange = "run.racing_line";
  static constexpr std::string_view kSlides = ", slides";
  static constexpr std::string_view kSlip = ", slip ";

 private:
  using Lap = std::shared_ptr<const road::RacingRoad>;  ///< null: there is none
  struct Search {
    scenario::Scenario scenario;
    const road::Track* track = nullptr;
    controller::LapRequest request;
    std::vector<Vec2> waypoints;  ///< copy that `request` points to on the thread
  };
  void begin(const scenario::Scenario& scenario, const road::Track* track,
             const controller::LapRequest& request);
  [[nodiscard]] static Lap planned(const scenario::Scenario& scenario, const road::Track* track,
                                   const controller::LapRequest& request,
                                   const std::function<bool()>& is_wanted);

  Clock clock_;
  std::optional<double> wanted_since_;  ///< [s]
  std::optional<double> ready_since_;   ///< lap_ [s]
  bool has_answered_ = false;           ///< the current request has been answered
  Lap lap_;
  std::optional<NewestTask<Search, Lap>> search_;
};

/// Drives `scenario` again without each thing that keeps its laps from the limit, one at a time: latency with
/// its jitter, noise and age of the sensor, margin to the edges, reserve of grip and brakes, guard
/// (docs/limit.md, "The gap by corner"). Causes that the scenario does not have are left out.
///
/// On as many threads as there are processors; each run plans its own lap. `go_on` is asked repeatedly, by
/// these threads; false ends it with the complete runs. Fails where a run cannot be made. Deterministic.
/// Allocates.
[[nodiscard]] Result<std::vector<lap_time::LapWithout>> laps_without(const scenario::Scenario& scenario,
                                                                     const std::function<bool()>& go_on = {});

}  // namespace chicane::run
