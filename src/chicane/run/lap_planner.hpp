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
#include "chicane/scenario/scenario.hpp"
#include "chicane/telemetry/change.hpp"

namespace chicane::run {

/// Plans the lap to race by for a controller that has learned its road from waypoints (plan_learned_lap):
/// beside a run in real time, on a thread of its own with low priority; in virtual time at once, taken up as
/// late as kPlanningTime. What is planned depends on waypoints and scenario alone; when it takes effect is in
/// recordings, as the change lap_change().
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

  /// After each control cycle, at the run's time [s]: the lap that is to be used from the next one on, once.
  /// Null otherwise, and where the road has none. Allocates when a search begins; waits for none in real
  /// time.
  [[nodiscard]] std::shared_ptr<const road::RacingRoad> follow(const controller::Controller& controller,
                                                               const scenario::Scenario& scenario,
                                                               double time);

  /// What recordings and viewers are told where a lap is used from control cycle `cycle` on.
  [[nodiscard]] static telemetry::Change lap_change(std::uint64_t cycle, double time) noexcept {
    return {.cycle = cycle, .time = time, .name = kChange, .value = kLearned};
  }
  static constexpr std::string_view kChange = "run.racing_line";
  static constexpr std::string_view kLearned = "learned";

 private:
  void search(std::vector<Vec2> waypoints, const scenario::Scenario& scenario);

  Clock clock_;
  std::optional<double> wanted_since_;  ///< [s]
  bool has_answered_ = false;           ///< to what is wanted now
  std::atomic<bool> is_wanted_{false};
  std::atomic<bool> has_ended_{false};           ///< the thread: lap_ may be read
  std::shared_ptr<const road::RacingRoad> lap_;  ///< null: there is none
  std::thread thread_;
};

}  // namespace chicane::run
