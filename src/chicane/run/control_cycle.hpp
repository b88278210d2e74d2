// SPDX-License-Identifier: MIT
// One control cycle: from a measurement, through guard and controller, to the sent command and the frame.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "chicane/base/deadline.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/road/racing_road.hpp"
#include "chicane/road/track.hpp"
#include "chicane/safety/guard.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/telemetry/frame.hpp"
#include "chicane/telemetry/metrics.hpp"

namespace chicane::run {

/// Road that the scenario's guard starts with. `track`: track that the guard may know; null: none. Takes
/// milliseconds.
[[nodiscard]] road::KnownRoad known_road(const scenario::Scenario& scenario, const road::Track* track);

/// Input of a control cycle besides the measurement. The frame records it, so that the cycle can be computed
/// again bit for bit.
struct CycleInput {
  Deadline deadline = Deadline::stopwatch();  ///< deadline of the controller's step
  std::uint32_t deadline_spent_at = 0;        ///< DeadlineLog::spent_at of a recorded cycle; 0: none
  double interval = 0.0;  ///< time since the last cycle [s], for the rate limit; unused in the first cycle
  std::optional<model::Command> manual{};  ///< command of a person, sent in place of the controller's
};

/// The control cycle: computes a command from a measurement, and writes both, with everything between, into a
/// frame. Shared by `drive`, `serve`, replay, branches and programs of users.
///
///     measurement → plausibility → controller → fallback → gate → what is sent → frame
///
/// safety::Guard does everything between measurement and gate. A model car is scaled to full size for it
/// (model/vehicle.hpp); frames and stops have the car's own size. No allocation; one thread; objects are
/// independent.
class ControlCycle {
 public:
  /// Pre: `controller` is not null. The scenario gives the vehicle and the options of the guard. `track`:
  /// track that the guard may know; null: none.
  ControlCycle(std::unique_ptr<controller::Controller> controller, const scenario::Scenario& scenario,
               const road::Track* track);
  /// Creates a cycle with a road that known_road() made before.
  ControlCycle(std::unique_ptr<controller::Controller> controller, const scenario::Scenario& scenario,
               road::KnownRoad road);

  /// Sets the planned lap of a scenario that races (run/racing.hpp), before the car drives or between two
  /// cycles if the controller wants_lap(). Null changes nothing.
  void use_line(std::shared_ptr<const road::RacingRoad> lap);

  /// Begins a run, or continues after an interruption: drops everything learned of the car. `cycle`: number
  /// of the next cycle. `longest`: time for which this link may hold a command [s].
  void begin(std::uint64_t cycle = 0, double longest = 0.0) noexcept;
  /// Applies settings before the next cycle; learned values stay. Of the guard's options only a change from
  /// GuardRoad::kTrack to kWaypoints takes effect. That change allocates: make it before the car drives.
  void configure(const scenario::Scenario& scenario) noexcept;

  /// One cycle. Reads measurement and truth, if known, from `frame`. Writes the cycle's decisions, number and
  /// times. Place and laps are written by the caller.
  void step(const CycleInput& input, telemetry::Frame& frame) noexcept;

  /// Number of the next cycle.
  [[nodiscard]] std::uint64_t next() const noexcept { return next_; }
  /// Longest recent interval between two cycles [s]; older ones fade within half a minute.
  [[nodiscard]] double longest() const noexcept { return longest_; }
  [[nodiscard]] const controller::Controller& controller() const noexcept { return guard_.controller(); }
  /// The stop at hand after step(), for the receiver, which stops the car when commands cease.
  [[nodiscard]] const safety::StopPlan& stop() const noexcept {
    return similarity_.is_identity() ? guard_.stop() : stop_;
  }

 private:
  /// Scales a result from full size to the size of the car.
  void to_scale(controller::StepResult& result) const noexcept;
  /// Scales the guard's stop plan to the size of the car, into stop_.
  void scale_stop() noexcept;

  model::Similarity similarity_;  ///< scale of the car to full size
  safety::Guard guard_;
  safety::StopPlan stop_;  ///< stop plan in the size of a model car; unused in full size
  telemetry::PredictionCheck prediction_check_;
  std::uint64_t next_ = 0;       ///< number of the next cycle
  bool begins_ = true;           ///< the next cycle is the first of a run
  bool shows_throttle_ = false;  ///< telemetry of this run has had a throttle above 0
  double longest_ = 0.0;         ///< longest recent interval, faded [s]
};

}  // namespace chicane::run
