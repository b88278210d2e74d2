// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/run/closed_loop.hpp"
#include "chicane/run/lap_planner.hpp"
#include "chicane/run/realtime_loop.hpp"

namespace chicane::run {

/// The steps of a run that is watched and changed while it goes on, without a clock: whoever owns it says
/// when (realtime_loop.hpp by the computer's clock, live/worker_run.hpp by a browser's). Changes are taken up
/// between two control cycles, and so is a lap to race by that was planned anew. One thread.
class LiveSteps {
 public:
  /// `budget` [s] bounds each control step; 0: no bound. `clock`: whether laps are planned beside the run.
  /// All outlive this.
  LiveSteps(ClosedLoop& loop, double budget, RunControls& controls, const RunHooks& hooks,
            LapPlanner::Clock clock = LapPlanner::Clock::kReal)
      : loop_{loop}, budget_{budget}, controls_{controls}, hooks_{hooks}, planner_{clock} {}

  /// The next change that waits starts the run anew: nothing is done any more.
  [[nodiscard]] bool is_to_start_anew() const noexcept { return is_to_start_anew_; }
  /// There was no frame since the run began.
  [[nodiscard]] bool is_unseen() const noexcept { return is_unseen_; }

  /// One physics step, preceded by a control step when one is due: true when there was one.
  bool advance();
  /// Physics steps up to the end of the next control cycle.
  void one_cycle();
  /// Physics up to the next control step: that is where a run stands still.
  void finish_cycle();
  /// Applies what waits, up to a change that starts the run anew.
  void take_up_changes();
  /// Puts the car back at the start if that is asked for; true when it was.
  bool restart_if_wanted();
  /// One of the cycles that were asked for while paused; true when there was one.
  [[nodiscard]] bool take_step() noexcept;

 private:
  void tell_lap();

  ClosedLoop& loop_;
  double budget_;
  RunControls& controls_;
  const RunHooks& hooks_;
  LapPlanner planner_;
  bool is_to_start_anew_ = false;
  bool is_unseen_ = true;
};

}  // namespace chicane::run
