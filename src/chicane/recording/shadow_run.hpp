// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/recording/replay.hpp"
#include "chicane/run/closed_loop.hpp"
#include "chicane/run/run_steps.hpp"
#include "chicane/run/setting.hpp"
#include "chicane/telemetry/frame.hpp"

namespace chicane::recording {

/// Visits all events of a run in order; a failure of the visitor ends them.
using RunEvents = std::function<Result<void>(const std::function<Result<void>(const RecordedEvent&)>& visit)>;

/// A run of our simulator in the shadow of another run: begun from a scenario, a loop or a copy of a shadow
/// run, computed event by event with follow(), changed with apply(), and driven in virtual time with drive().
/// One thread.
class ShadowRun {
 public:
  /// `hooks`: on_frame and on_change are called during drive(), on_lap for all laps.
  explicit ShadowRun(run::RunHooks hooks = {}) : hooks_{std::move(hooks)} {}

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
  /// Number of the next control step.
  [[nodiscard]] std::uint64_t next_cycle() const noexcept { return next_cycle_; }
  /// Cycle of the first control step whose measurement or command differed from the followed one in any bit:
  /// a difference anywhere in plant or controller shows there.
  [[nodiscard]] std::optional<std::uint64_t> first_difference() const noexcept { return first_difference_; }

  /// Changes a setting at the next control step. A fault that began or ended by itself, at the last control
  /// step, did so here, too: that change is ignored.
  void apply(const run::Setting& setting);
  /// Physics up to the next control step.
  void finish_cycle() { steps_->finish_cycle(); }
  /// Drives until `is_enough`, asked before each physics step, or until the car is lost. Plans the laps that
  /// the controller wants, in virtual time (RunSteps).
  void drive(const std::function<bool()>& is_enough);

  [[nodiscard]] run::ClosedLoop& loop() const { return *loop_; }

 private:
  [[nodiscard]] Result<void> take(const scenario::Scenario& scenario) { return begin(scenario); }
  [[nodiscard]] Result<void> take(const telemetry::Change& change);
  [[nodiscard]] Result<void> take(const RecordedStep& recorded);
  void take(std::unique_ptr<run::ClosedLoop> loop);

  run::RunHooks hooks_;
  std::unique_ptr<run::ClosedLoop> loop_;
  std::optional<run::RunSteps> steps_;  ///< steps of loop_
  double time_ = 0.0;
  std::uint64_t next_cycle_ = 0;
  std::optional<std::uint64_t> first_difference_;
};

/// Options for a branch: a recorded run that continues with other settings from a moment on.
struct BranchOptions {
  std::string log{};
  double at = 0.0;                                              ///< moment on the recording's time line [s]
  std::vector<std::pair<std::string, std::string>> settings{};  ///< as --set takes them; empty: no change
  double duration = 0.0;  ///< time from `at` on [s]; 0: to the end of the recording, or `laps`
  int laps = 0;           ///< ends after so many completed laps of the run; 0: no limit
  int more_laps = 0;      ///< ends after so many crossings of the line since `at`; 0: no limit
  /// Drives the first future on, too, if its recording ends before the second future does.
  bool drives_both = false;
  /// Starting point, with the events behind it, before `at`. Null: the start of the run.
  std::shared_ptr<const ShadowRun> from{};
};

/// The end of a third of a lap that was passed.
struct Passage {
  int lap = 0;        ///< lap from 1
  int sector = 0;     ///< sector from 1
  double time = 0.0;  ///< time since the branch [s], interpolated
};

/// One future, from the moment of the branch on.
struct Future {
  double duration = 0.0;            ///< [s]
  std::vector<double> lap_times{};  ///< times of completed laps [s]
  double max_lateral_error = 0.0;   ///< [m]
  double min_edge_distance = 0.0;   ///< signed, of the outermost tyre [m]; NaN without a control step
  double mean_speed = 0.0;          ///< [m/s]
  double top_speed = 0.0;           ///< [m/s]
  int off_track_events = 0;
  std::uint64_t interventions = 0;  ///< control steps in which another command than the controller's was sent
  std::vector<Passage> passages{};
};

/// A control step of a future.
struct FutureStep {
  const telemetry::Frame& frame;
  double distance = 0.0;  ///< along the line, from the start line of the lap in which the branch begins [m]
  bool is_branch = false;
};

/// The plant used in place of a car that others simulate.
struct StandIn {
  std::string plant;
  double compared = 0.0;  ///< time before the branch that both drove from the same place [s]; 0: not compared
  double apart = 0.0;     ///< distance between them at its end [m]
};

struct BranchReport {
  double at = 0.0;                 ///< first control step from the branch on [s]
  std::uint64_t cycle = 0;         ///< cycle of that control step in its run
  std::uint64_t steps_before = 0;  ///< computed again on the way to it
  double known_until = 0.0;        ///< the last control step of the recording [s]
  /// First recorded step that was not reproduced bit for bit: from there on the first future is this
  /// program's result, not the record.
  std::optional<std::uint64_t> first_difference{};
  Future recorded{};
  Future branched{};
  std::string end_reason{};  ///< reason of an early end of the branch; else empty
  std::optional<StandIn> stand_in{};
};

/// Callbacks for the second future and for the recorded run up to the branch.
struct BranchHooks {
  std::function<Result<void>(const run::ClosedLoop&)> on_begin{};  ///< called for each run in the recording
  std::function<void(const telemetry::Change&)> on_change{};
  std::function<void(const telemetry::Frame&)> on_frame{};
  std::function<void(const telemetry::CompletedLap&)> on_lap{};
  std::function<void(const FutureStep&)> on_future{};  ///< called for both futures, one after the other
  /// Asked at each control step that is computed, with the time [s] it has come to; false gives up.
  std::function<bool(double time)> go_on{};
};

/// Computes a recorded run of `drive` again from its start, controller and plant, and continues a copy of it
/// from `options.at` with other settings, in virtual time. Fails with kInvalidArgument when the moment is not
/// in the recording, a setting is unknown, out of range or cannot change during a run, when
/// BranchHooks::go_on gives up, when the recording is not of our simulator, or when controller or plant
/// cannot be copied.
[[nodiscard]] Result<BranchReport> branch_recording(const BranchOptions& options, const BranchHooks& hooks);
/// The same of a run that is not a file, whose events are visited once; `options.log` is not used. Without
/// `options.from` they are the events of the whole run.
[[nodiscard]] Result<BranchReport> branch_run(const RunEvents& events, const BranchOptions& options,
                                              const BranchHooks& hooks);

}  // namespace chicane::recording
