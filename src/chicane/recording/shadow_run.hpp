// SPDX-License-Identifier: MIT
// Shadow runs: a recorded or live run computed again, and continued from a moment with other settings.
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

/// Function that hands all events of a run in order to a visitor, whose failure ends it.
using RunEvents = std::function<Result<void>(const std::function<Result<void>(const RecordedEvent&)>& visit)>;

/// Run of our simulator in the shadow of another run. It begins from a scenario, a loop or a copy of a shadow
/// run; follow() repeats the events of the other run, apply() changes settings, drive() continues in virtual
/// time. One thread.
class ShadowRun {
 public:
  /// `hooks`: on_frame and on_change are called during drive(), on_lap for all laps.
  explicit ShadowRun(run::RunHooks hooks = {}) : hooks_{std::move(hooks)} {}

  /// Begins from a scenario, without an end after its laps. Fails as ClosedLoop::create().
  [[nodiscard]] Result<void> begin(const scenario::Scenario& scenario);
  /// Begins from a loop, behind its last control step. Pre: not null.
  void begin(std::unique_ptr<run::ClosedLoop> loop);
  /// Begins from the current state of `other`, which has begun. False if its loop cannot be copied
  /// (ClosedLoop::copy()).
  [[nodiscard]] bool begin(const ShadowRun& other);
  /// Whether any begin() has succeeded.
  [[nodiscard]] bool has_begun() const noexcept { return loop_ != nullptr; }

  /// Repeats the next event: a scenario begins a run, a control step is computed with its recorded clock.
  /// Fails as begin(). Pre: a run has begun, or `event` is a scenario.
  [[nodiscard]] Result<void> follow(const RecordedEvent& event);
  /// Log time of the last control step that was followed [s].
  [[nodiscard]] double time() const noexcept { return time_; }
  /// Number of the next control step.
  [[nodiscard]] std::uint64_t next_cycle() const noexcept { return next_cycle_; }
  /// Cycle of the first control step whose measurement or command differed in any bit from the followed one,
  /// as any difference in plant or controller causes; none: no step differed.
  [[nodiscard]] std::optional<std::uint64_t> first_difference() const noexcept { return first_difference_; }

  /// Changes a setting at the next control step. Ignores the change of a fault that began or ended by itself
  /// at the last control step, because the fault did so here as well.
  void apply(const run::Setting& setting);
  /// Physics up to the next control step.
  void finish_cycle() { steps_->finish_cycle(); }
  /// Drives until `is_enough`, which is asked before each physics step, or until the car is lost. Plans the
  /// laps that the controller requests, in virtual time (RunSteps).
  void drive(const std::function<bool()>& is_enough);

  [[nodiscard]] run::ClosedLoop& loop() const { return *loop_; }

 private:
  // Effects of an event, one for each kind.
  [[nodiscard]] Result<void> take(const scenario::Scenario& scenario) { return begin(scenario); }
  [[nodiscard]] Result<void> take(const telemetry::Change& change);
  [[nodiscard]] Result<void> take(const RecordedStep& recorded);
  /// Replaces the loop.
  void take(std::unique_ptr<run::ClosedLoop> loop);

  run::RunHooks hooks_;
  std::unique_ptr<run::ClosedLoop> loop_;          ///< the run; null: none has begun
  std::optional<run::RunSteps> steps_;             ///< steps of loop_
  double time_ = 0.0;                              ///< time() [s]
  std::uint64_t next_cycle_ = 0;                   ///< next_cycle()
  std::optional<std::uint64_t> first_difference_;  ///< first_difference()
};

/// Options of a branch: a recorded run that continues with other settings from a moment on.
struct BranchOptions {
  std::string log{};                                            ///< path of the recording
  double at = 0.0;                                              ///< moment on the recording's time line [s]
  std::vector<std::pair<std::string, std::string>> settings{};  ///< as --set takes them; empty: no change
  double duration = 0.0;  ///< duration from `at` on [s]; 0: to the end of the recording, or by the two next
  int laps = 0;           ///< completed laps of the run at which the branch ends; 0: no limit
  int more_laps = 0;      ///< crossings of the line since `at` after which the branch ends; 0: no limit
  /// Drives the first future on if its recording ends before the second future does.
  bool drives_both = false;
  /// Run at a moment before `at`, from which the visited events continue. Null: they begin the run.
  std::shared_ptr<const ShadowRun> from{};
};

/// Passage of the end of a third of a lap.
struct Passage {
  int lap = 0;        ///< lap from 1
  int sector = 0;     ///< sector from 1
  double time = 0.0;  ///< time since the branch [s], interpolated
};

/// Summary of one future, from the moment of the branch on.
struct Future {
  double duration = 0.0;            ///< [s]
  std::vector<double> lap_times{};  ///< times of completed laps [s]
  double max_lateral_error = 0.0;   ///< largest magnitude [m]
  double min_edge_distance = 0.0;   ///< signed, of the outermost tyre [m]; NaN without a control step
  double mean_speed = 0.0;          ///< mean over control steps [m/s]
  double top_speed = 0.0;           ///< [m/s]
  int off_track_events = 0;         ///< times that a tyre left the road
  std::uint64_t interventions = 0;  ///< control steps in which another command than the controller's was sent
  std::vector<Passage> passages{};  ///< passed thirds of laps, in order
};

/// Control step of a future.
struct FutureStep {
  const telemetry::Frame& frame;
  double distance = 0.0;   ///< distance along the line since the start line of the lap of the branch [m]
  bool is_branch = false;  ///< the frame is of the second future
};

/// Plant in place of a car that another program simulates.
struct StandIn {
  std::string plant;      ///< name of the plant
  double compared = 0.0;  ///< time before the branch in which plant and car are compared [s]; 0: none
  double apart = 0.0;     ///< largest distance between plant and car in that time [m]
};

/// Result of a branch.
struct BranchReport {
  double at = 0.0;                 ///< time of the first control step from the branch on [s]
  std::uint64_t cycle = 0;         ///< cycle of that control step in its run
  std::uint64_t steps_before = 0;  ///< control steps computed again before it
  double known_until = 0.0;        ///< time of the last control step of the recording [s]
  /// Cycle of the first recorded step that was not reproduced bit for bit: from there on the first future is
  /// a computation of this program, not the record. None: all were reproduced.
  std::optional<std::uint64_t> first_difference{};
  Future recorded{};                  ///< first future: the recorded run
  Future branched{};                  ///< second future: with the other settings
  std::string end_reason{};           ///< reason of an early end of the branch; else empty
  std::optional<StandIn> stand_in{};  ///< plant in place of an external car; none: the car was ours
};

/// Callbacks for the recorded run up to the branch, and for the second future; empty ones are not called.
struct BranchHooks {
  std::function<Result<void>(const run::ClosedLoop&)> on_begin{};  ///< called for each run in the recording
  std::function<void(const telemetry::Change&)> on_change{};       ///< called for each change
  std::function<void(const telemetry::Frame&)> on_frame{};         ///< called for each control step
  std::function<void(const telemetry::CompletedLap&)> on_lap{};    ///< called for each lap
  std::function<void(const FutureStep&)> on_future{};  ///< called for both futures, one after the other
  /// Asked at each computed control step, with its `time` [s]; false gives up.
  std::function<bool(double time)> go_on{};
};

/// Computes a recorded run of `drive` again from its start, with controller and plant, and continues a copy
/// from `options.at` on with other settings, in virtual time. kInvalidArgument when the moment is not in the
/// recording, a setting is unknown, out of range or fixed during a run, BranchHooks::go_on gives up, the
/// recording is not of our simulator, or controller or plant cannot be copied.
[[nodiscard]] Result<BranchReport> branch_recording(const BranchOptions& options, const BranchHooks& hooks);
/// Branches a run whose events come from `events`, which is called once; `options.log` is not used. Without
/// `options.from` they are the events of the whole run. Fails as branch_recording().
[[nodiscard]] Result<BranchReport> branch_run(const RunEvents& events, const BranchOptions& options,
                                              const BranchHooks& hooks);

}  // namespace chicane::recording
