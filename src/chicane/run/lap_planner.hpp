// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "chicane/base/vec2.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/road/racing_road.hpp"
#include "chicane/road/track.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/telemetry/metrics.hpp"

namespace chicane::run {

class ClosedLoop;
class ControlCycle;

/// Plans the lap to race by that a controller wants from what it has learned (Controller::wants_lap): beside
/// a run in real time, on a thread of its own with low priority; in virtual time at once, taken up as late as
/// kPlanningTime. What is planned depends on scenario, road and grip alone; with which grip, and when it
/// takes effect, is in recordings, as the change lap_change().
///
/// One thread, that of the run.
class LapPlanner {
 public:
  enum class Clock { kReal, kVirtual };
  static constexpr double kPlanningTime = 5.0;  ///< that a plan takes in virtual time [s]

  explicit LapPlanner(Clock clock) noexcept : clock_{clock} {}
  /// Cancels a search, and waits for its thread: for one iteration.
  ~LapPlanner();
  LapPlanner(const LapPlanner&) = delete;
  LapPlanner& operator=(const LapPlanner&) = delete;

  /// A lap is taken up where the car is about to drive so near to it [m]; the longer it is ready, the farther
  /// [m/s]. A car at the limit of its tyres has nothing left to come to another line with.
  static constexpr double kJoining = 0.4;
  static constexpr double kJoiningGrows = 0.1;

  /// After each control cycle, at the run's time [s]: the lap that is to be used from the next one on, once.
  /// Null otherwise, and where the road has none. Allocates when a search begins; waits for none in real
  /// time.
  /// `track`: the road, where it is known, or null; outlives this.
  [[nodiscard]] std::shared_ptr<const road::RacingRoad> follow(const controller::Controller& controller,
                                                               const scenario::Scenario& scenario,
                                                               const road::Track* track, double time);

  /// follow() after a control cycle of a run: a lap that is ready is used from the next one on. Gives what
  /// recordings and viewers get of it then.
  std::optional<telemetry::Change> advance(ClosedLoop& loop);
  /// The same for a run without a plant, at its time [s].
  std::optional<telemetry::Change> advance(ControlCycle& cycle, const scenario::Scenario& scenario,
                                           const road::Track* track, double time);

  /// What recordings and viewers get where `lap` is used from control cycle `cycle` on: the grip that it
  /// is planned with, and kSlides where it slides. Allocates.
  [[nodiscard]] static telemetry::Change lap_change(const road::RacingRoad& lap, std::uint64_t cycle,
                                                    double time);
  static constexpr std::string_view kChange = "run.racing_line";
  static constexpr std::string_view kSlides = ", slides";

 private:
  void search(const scenario::Scenario& scenario, const road::Track* track,
              const controller::LapRequest& request);

  Clock clock_;
  std::optional<double> wanted_since_;  ///< [s]
  std::optional<double> ready_since_;   ///< lap_ [s]
  bool has_answered_ = false;           ///< to what is wanted now
  std::atomic<bool> is_wanted_{false};
  std::atomic<bool> has_ended_{false};           ///< the thread: lap_ may be read
  std::shared_ptr<const road::RacingRoad> lap_;  ///< null: there is none
  std::thread thread_;
};

}  // namespace chicane::run
