// SPDX-License-Identifier: MIT
// Steps of a run under different clocks: flat out, paced by the machine's clock, or on request of a viewer.
#pragma once

#include <atomic>
#include <optional>

#include "chicane/run/closed_loop.hpp"
#include "chicane/run/racing.hpp"
#include "chicane/run/setting.hpp"
#include "chicane/telemetry/metrics.hpp"

namespace chicane::run {

/// Steps of a run in virtual time: physics and control, completed laps, and the planned laps that the
/// controller requests (LapPlanner). The owner paces the steps. One thread.
class RunSteps {
 public:
  /// `clock`: clock of the planner. `loop` and `hooks` outlive this.
  RunSteps(ClosedLoop& loop, const RunHooks& hooks, LapPlanner::Clock clock = LapPlanner::Clock::kVirtual)
      : loop_{loop}, hooks_{hooks}, planner_{clock} {}
  /// Steps of `copy`, a copy of the loop of `other`: both plan the same laps. Pre: the clock of `other` is
  /// kVirtual.
  RunSteps(ClosedLoop& copy, const RunSteps& other)
      : loop_{copy}, hooks_{other.hooks_}, planner_{other.planner_} {}

  /// One physics step, preceded by a control step when one is due: true when there was one. `budget` [s]
  /// bounds the control step; 0: no bound.
  bool advance(double budget = 0.0);
  /// Physics up to the next control step, where a paused run stands.
  void finish_cycle();
  /// Calls RunHooks::on_lap if a lap was completed since the last call.
  void tell_lap();

  [[nodiscard]] ClosedLoop& loop() const noexcept { return loop_; }

 private:
  ClosedLoop& loop_;
  const RunHooks& hooks_;
  LapPlanner planner_;
};

/// Requests of other threads to a run. Any thread; each takes effect at the next control step.
struct RunControls {
  std::atomic<bool> is_paused{false};      ///< the run stands still until this is false
  std::atomic<int> steps{0};               ///< control cycles to do while paused
  std::atomic<bool> wants_restart{false};  ///< the car is to start again
  std::atomic<bool> wants_stop{false};     ///< the run is to end
  SettingQueue settings{};                 ///< changes of settings, from one thread
};

/// Steps of a run that viewers watch and change. Changes take effect between two control cycles. The owner
/// paces the steps: run_realtime() by the machine's clock, live/worker_run.hpp by a browser's. One thread.
class LiveSteps {
 public:
  /// `budget` [s] bounds each control step; 0: no bound. `clock`: as of RunSteps. All outlive this.
  LiveSteps(ClosedLoop& loop, double budget, RunControls& controls, const RunHooks& hooks,
            LapPlanner::Clock clock = LapPlanner::Clock::kReal)
      : loop_{loop}, budget_{budget}, controls_{controls}, hooks_{hooks}, steps_{loop, hooks, clock} {}

  /// Whether the next waiting change starts another run: this one does no further step.
  [[nodiscard]] bool is_to_start_anew() const noexcept { return is_to_start_anew_; }
  /// Whether the run has had no frame yet.
  [[nodiscard]] bool is_unseen() const noexcept { return is_unseen_; }

  /// One physics step, preceded by a control step when one is due: true when there was one.
  bool advance();
  /// Physics steps up to the end of the next control cycle.
  void one_cycle();
  /// Physics up to the next control step.
  void finish_cycle() { steps_.finish_cycle(); }
  /// Applies waiting changes, up to one that starts another run.
  void take_up_changes();
  /// Puts the car back at the start if RunControls requests it; true when it did.
  bool restart_if_wanted();
  /// Takes one of the requested cycles of a paused run; false when none is left.
  [[nodiscard]] bool take_step() noexcept;

 private:
  ClosedLoop& loop_;
  double budget_;  ///< longest duration of a control step [s]; 0: no bound
  RunControls& controls_;
  const RunHooks& hooks_;
  RunSteps steps_;
  bool is_to_start_anew_ = false;  ///< the next waiting change starts another run
  bool is_unseen_ = true;          ///< the run has had no frame yet
};

/// Options of run_realtime().
struct RealtimeOptions {
  double budget_share = 0.8;  ///< largest share of the control period for a control step, (0, 1]; chosen
  std::optional<double> step_budget = std::nullopt;  ///< replaces the share [s]; 0 = no bound
  bool stay_at_end = false;  ///< drive on after the last lap until RunControls::wants_stop
};

/// Drives a run by the machine's clock, at ClosedLoop::pace(). A run that is more than 100 ms late skips the
/// missed time, as the controller of a real car would miss it.
///
/// Waiting changes are applied between two cycles, also while paused. Returns at the end, and before a change
/// that `starts_anew`, which stays in the queue.
[[nodiscard]] telemetry::RunSummary run_realtime(ClosedLoop& loop, const RealtimeOptions& options,
                                                 RunControls& controls, const RunHooks& hooks = {});

}  // namespace chicane::run
