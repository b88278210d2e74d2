// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "chicane/base/result.hpp"
#include "chicane/recording/reader.hpp"
#include "chicane/run/closed_loop.hpp"
#include "chicane/run/lap_planner.hpp"
#include "chicane/run/make.hpp"
#include "chicane/run/setting.hpp"
#include "chicane/telemetry/frame.hpp"

namespace chicane::recording {

/// Visits all events of a run in order; a failure of the visitor ends them.
using RunEvents = std::function<Result<void>(const std::function<Result<void>(const RecordedEvent&)>& visit)>;

/// Observers of a shadow run; empty functions are not called.
struct ShadowObservers {
  std::function<void(const run::ClosedLoop&)> on_step{};  ///< after each control step of drive()
  std::function<void(const telemetry::CompletedLap&)> on_lap{};
};

/// A run of our simulator in the shadow of another run: begun from a scenario, a loop or a copy of a shadow
/// run, computed event by event with follow(), changed with apply(), and driven in virtual time with drive().
/// One thread.
class ShadowRun {
 public:
  explicit ShadowRun(ShadowObservers observers = {}, run::Factories make = {})
      : observers_{std::move(observers)}, make_{std::move(make)} {}

  /// Begins from a scenario, without an end after its laps. Fails as ClosedLoop::create() does.
  [[nodiscard]] Result<void> begin(const scenario::Scenario& scenario);
  /// Begins from a loop, behind its last control step. Pre: not null.
  void begin(std::unique_ptr<run::ClosedLoop> loop);
  /// Begins where `other` is, which has begun. False where its loop cannot be copied (ClosedLoop::copy()).
  [[nodiscard]] bool begin(const ShadowRun& other);
  [[nodiscard]] bool has_begun() const noexcept { return loop_ != nullptr; }

  /// Computes the next event: a scenario begins a run, a control step gets its recorded clock. Fails as
  /// begin() does. Pre: a run has begun, or `event` is a scenario.
  [[nodiscard]] Result<void> follow(const RecordedEvent& event);
  /// Log time of the last control step that was followed [s].
  [[nodiscard]] double time() const noexcept { return time_; }
  /// Number of the control step behind it.
  [[nodiscard]] std::uint64_t next_cycle() const noexcept { return next_cycle_; }
  /// Cycle of the first control step whose measurement or command differed from the followed one in any bit:
  /// a difference anywhere in plant or controller shows there.
  [[nodiscard]] std::optional<std::uint64_t> first_difference() const noexcept { return first_difference_; }

  /// Changes a setting at the next control step. A fault that began or ended by itself, at the last control
  /// step, did so here, too: that change is ignored.
  void apply(const run::Setting& setting);
  /// Physics up to the next control step.
  void finish_cycle();
  /// Drives until `is_enough`, asked before each physics step, or until the car is lost. Plans the laps that
  /// the controller wants (LapPlanner, virtual clock).
  void drive(const std::function<bool()>& is_enough);

  [[nodiscard]] run::ClosedLoop& loop() const { return *loop_; }

 private:
  [[nodiscard]] Result<void> take(const scenario::Scenario& scenario) { return begin(scenario); }
  [[nodiscard]] Result<void> take(const telemetry::Change& change);
  [[nodiscard]] Result<void> take(const RecordedStep& recorded);
  void tell_lap();

  ShadowObservers observers_;
  run::Factories make_;
  std::unique_ptr<run::ClosedLoop> loop_;
  run::LapPlanner planner_{run::LapPlanner::Clock::kVirtual};
  double time_ = 0.0;
  std::uint64_t next_cycle_ = 0;
  std::optional<std::uint64_t> first_difference_;
};

}  // namespace chicane::recording
