// SPDX-License-Identifier: MIT
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

/// Road that the scenario's guard starts with; `track`: the track it may use, or null. Takes milliseconds.
[[nodiscard]] road::KnownRoad known_road(const scenario::Scenario& scenario, const road::Track* track);

/// Input of a control cycle besides the measurement. Recorded in the frame: with it and the measurement a
/// cycle is computed again bit for bit.
struct CycleInput {
  Deadline deadline = Deadline::stopwatch();  ///< deadline of the controller's step
  std::uint32_t deadline_spent_at = 0;        ///< DeadlineLog::spent_at, where it is given
  double interval = 0.0;  ///< time since the last cycle [s], for the rate limit; unused in the first cycle
  std::optional<model::Command> manual{};  ///< a person's command, sent in the controller's place
};

/// The control cycle: a measurement becomes a command, and all of it a frame. The one place where that
/// happens: `drive`, `serve`, replay, branches and programs of users all run it.
///
///     measurement → plausibility → controller → fallback → gate → what is sent → frame
///
/// safety::Guard does all between measurement and gate. It gets a model car in full size (model/vehicle.hpp);
/// frames and stops have the actual size. No allocation; one thread; objects are independent.
class ControlCycle {
 public:
  /// Pre: `controller` is not null. The scenario's vehicle gives the model's parameters, its guard watches.
  /// `track`: the road, where the guard may know it; null: it is not known.
  ControlCycle(std::unique_ptr<controller::Controller> controller, const scenario::Scenario& scenario,
               const road::Track* track);
  /// The same with what known_road() has made of the track before.
  ControlCycle(std::unique_ptr<controller::Controller> controller, const scenario::Scenario& scenario,
               road::KnownRoad road);

  /// The planned lap of a scenario that races (run/racing.hpp): before the car drives, or between two cycles
  /// where the controller wants_lap(). Null changes nothing.
  void use_line(std::shared_ptr<const road::RacingRoad> lap);

  /// A new run, or the same car after something unknown: everything learned is forgotten. The next cycle has
  /// the number `cycle`.
  void begin(std::uint64_t cycle = 0) noexcept;
  /// Applies settings before the next cycle; learned values stay. One change of the guard takes effect,
  /// GuardRoad::kWaypoints in place of kTrack; it allocates, and so belongs before the car drives.
  void configure(const scenario::Scenario& scenario) noexcept;

  /// One cycle. Reads from `frame` the measurement, and the truth where there is one; writes everything that
  /// the cycle decides, its number and its times. The rest of the frame, place and laps, is the caller's.
  void step(const CycleInput& input, telemetry::Frame& frame) noexcept;

  /// Number of the next cycle.
  [[nodiscard]] std::uint64_t next() const noexcept { return next_; }
  [[nodiscard]] const controller::Controller& controller() const noexcept { return guard_.controller(); }
  /// The stop at hand after step(), for the receiver, which stops the car when commands cease.
  [[nodiscard]] const safety::StopPlan& stop() const noexcept {
    return similarity_.is_identity() ? guard_.stop() : stop_;
  }

 private:
  void to_scale(controller::StepResult& result) const noexcept;
  void keep_stop() noexcept;

  model::Similarity similarity_;
  safety::Guard guard_;
  safety::StopPlan stop_;  ///< stop plan of a model car
  telemetry::PredictionCheck prediction_check_;
  std::uint64_t next_ = 0;
  bool begins_ = true;
};

}  // namespace chicane::run
