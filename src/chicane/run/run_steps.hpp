// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <optional>

#include "chicane/run/closed_loop.hpp"
#include "chicane/run/racing.hpp"
#include "chicane/run/setting.hpp"
#include "chicane/telemetry/metrics.hpp"

namespace chicane::run {

/// Steps of a run, whatever paces them: physics and control, completed laps, and a lap to race by that the
/// controller wants (LapPlanner). One thread.
class RunSteps {
 public:
  /// `clock`: whether laps are planned during the run. `loop` and `hooks` outlive this.
  RunSteps(ClosedLoop& loop, const RunHooks& hooks, LapPlanner::Clock clock = LapPlanner::Clock::kVirtual)
      : loop_{loop}, hooks_{hooks}, planner_{clock} {}
  /// Steps of a copy of the loop of `other`, whose clock is kVirtual: both plan the same laps.
  RunSteps(ClosedLoop& copy, const RunSteps& other)
      : loop_{copy}, hooks_{other.hooks_}, planner_{other.planner_} {}

  /// One physics step, preceded by a control step when one is due: true when there was one. `budget` [s]
  /// bounds the control step; 0: no bound.
  bool advance(double budget = 0.0);
  /// Physics up to the next control step: that is where a run stands still.
  void finish_cycle();
  /// Calls RunHooks::on_lap with a lap that was completed since the last call.
  void tell_lap();

  [[nodiscard]] ClosedLoop& loop() const noexcept { return loop_; }

 private:
  ClosedLoop& loop_;
  const RunHooks& hooks_;
  LapPlanner planner_;
};

/// Requests of other threads to a running run. Any thread; each takes effect at the next control step.
struct RunControls {
  std::atomic<bool> is_paused{false};
  std::atomic<int> steps{0};  ///< control cycles to do while paused
  std::atomic<bool> wants_restart{false};
  std::atomic<bool> wants_stop{false};
  SettingQueue settings{};  ///< changes of settings, from one thread
};

/// Steps of a run that is watched and changed meanwhile, without a clock: the owner paces them
/// (run_realtime() by the computer's clock, live/worker_run.hpp by a browser's). Changes take effect between
/// two control cycles. One thread.
class LiveSteps {
 public:
  /// `budget` [s] bounds each control step; 0: no bound. `clock`: as of RunSteps. All outlive this.
  LiveSteps(ClosedLoop& loop, double budget, RunControls& controls, const RunHooks& hooks,
            LapPlanner::Clock clock = LapPlanner::Clock::kReal)
      : loop_{loop}, budget_{budget}, controls_{controls}, hooks_{hooks}, steps_{loop, hooks, clock} {}

  /// Whether the next waiting change restarts the run: then nothing more is done.
  [[nodiscard]] bool is_to_start_anew() const noexcept { return is_to_start_anew_; }
  /// Whether the run has had no frame yet.
  [[nodiscard]] bool is_unseen() const noexcept { return is_unseen_; }

  /// One physics step, preceded by a control step when one is due: true when there was one.
  bool advance();
  /// Physics steps up to the end of the next control cycle.
  void one_cycle();
  /// Physics up to the next control step.
  void finish_cycle() { steps_.finish_cycle(); }
  /// Applies waiting changes, up to one that restarts the run.
  void take_up_changes();
  /// Puts the car back at the start if that is asked for; true when it was.
  bool restart_if_wanted();
  /// One of the cycles that were asked for while paused; true when there was one.
  [[nodiscard]] bool take_step() noexcept;

 private:
  ClosedLoop& loop_;
  double budget_;
  RunControls& controls_;
  const RunHooks& hooks_;
  RunSteps steps_;
  bool is_to_start_anew_ = false;
  bool is_unseen_ = true;
};

struct RealtimeOptions {
  double budget_share = 0.8;  ///< largest share of the control period for a control step; (0, 1]
  std::optional<double> step_budget = std::nullopt;  ///< instead of the share [s]; 0 = no bound
  bool stay_at_end = false;                          ///< drive on after the last lap until asked to stop
};

/// Runs an experiment at ClosedLoop::pace() by the clock. A loop that falls behind more than 100 ms does not
/// catch up: it skips the missed time, as a controller of a real car would miss it.
///
/// Changes that wait are applied between two cycles, also while paused. Returns, except at the end, when
/// the next one `starts_anew`; it is left in the queue.
[[nodiscard]] telemetry::RunSummary run_realtime(ClosedLoop& loop, const RealtimeOptions& options,
                                                 RunControls& controls, const RunHooks& hooks = {});

}  // namespace chicane::run
