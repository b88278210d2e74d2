// SPDX-License-Identifier: MIT
#include "chicane/run/realtime_loop.hpp"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "chicane/run/lap_planner.hpp"

namespace chicane::run {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double kNap = 0.004;      // [s] of run time advanced between two looks at the clock
constexpr double kMaxBehind = 0.1;  // [s] later than this, missed time is skipped
constexpr auto kPausePoll = std::chrono::milliseconds(10);

/// Maps run time to the clock; moved when the run pauses or falls behind.
class Pacer {
 public:
  void anchor(double run_time) {
    anchor_time_ = Clock::now();
    anchor_run_ = run_time;
  }
  /// Sleeps until the clock has reached `run_time` at this pace.
  void wait_for(double run_time, double pace) {
    if (pace != pace_) anchor(last_run_);
    pace_ = pace;
    last_run_ = run_time;
    const auto due = anchor_time_ + std::chrono::duration_cast<Clock::duration>(
                                        std::chrono::duration<double>((run_time - anchor_run_) / pace_));
    const auto now = Clock::now();
    if (now > due + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(kMaxBehind))) {
      anchor(run_time);
    } else {
      std::this_thread::sleep_until(due);
    }
  }

 private:
  double pace_ = 1.0;
  Clock::time_point anchor_time_ = Clock::now();
  double anchor_run_ = 0.0;
  double last_run_ = 0.0;
};

/// What one call of run_realtime() drives, and how.
class Session {
 public:
  Session(ClosedLoop& loop, const RealtimeOptions& options, RunControls& controls, const RealtimeHooks& hooks)
      : loop_{loop},
        budget_{options.step_budget.value_or(options.budget_share * loop.scenario().control_period)},
        controls_{controls},
        hooks_{hooks} {}

  void run(bool stay_at_end) {
    pacer_.anchor(loop_.time());
    while (!controls_.wants_stop && !is_to_start_anew_ && (stay_at_end || !loop_.is_over())) {
      if (controls_.wants_restart.exchange(false)) {
        loop_.restart();
        pacer_.anchor(loop_.time());
        is_unseen_ = true;
      }
      if (controls_.is_paused) {
        finish_cycle();
        if (is_unseen_ || wait_while_paused()) one_cycle();  // viewers are to see where a run begins
        pacer_.anchor(loop_.time());
        continue;
      }
      const double until = loop_.time() + kNap;
      while (loop_.time() < until && !loop_.is_over() && !is_to_start_anew_) advance();
      if (loop_.is_over() && stay_at_end) {
        if (hooks_.on_over) hooks_.on_over();
        loop_.drive_on();
      }
      pacer_.wait_for(loop_.time(), loop_.pace());
    }
  }

 private:
  /// True when there was a control step.
  bool advance() {
    if (loop_.is_control_due()) take_up_changes();
    if (is_to_start_anew_) return false;
    const bool is_new = loop_.advance(budget_);
    tell_lap();
    if (!is_new) return false;
    is_unseen_ = false;
    if (hooks_.on_frame) hooks_.on_frame(loop_.frame());
    race_by_learned_lap();
    return true;
  }

  void race_by_learned_lap() {
    const auto lap = planner_.follow(loop_.controller(), loop_.scenario(), &loop_.track(), loop_.time());
    if (!lap) return;
    loop_.use_line(lap);
    if (hooks_.on_change) hooks_.on_change(LapPlanner::lap_change(*lap, loop_.cycle(), loop_.time()));
  }

  void one_cycle() {
    while (!is_to_start_anew_ && !advance()) {
    }
    finish_cycle();
  }

  /// Physics up to the next control step: that is where a run stands still.
  void finish_cycle() {
    while (!loop_.is_control_due()) {
      loop_.advance();
      tell_lap();
    }
  }

  void tell_lap() {
    if (const auto lap = loop_.take_lap(); lap && hooks_.on_lap) hooks_.on_lap(*lap);
  }

  /// While paused: waits for a request to go on, to stop or to step. True when one control cycle is to be
  /// done.
  bool wait_while_paused() {
    take_up_changes();
    while (controls_.is_paused && !controls_.wants_stop && !controls_.wants_restart && !is_to_start_anew_) {
      int steps = controls_.steps.load();
      if (steps > 0 && controls_.steps.compare_exchange_strong(steps, steps - 1)) return true;
      std::this_thread::sleep_for(kPausePoll);
      take_up_changes();
    }
    return false;
  }

  void take_up_changes() {
    while (const Setting* next = controls_.settings.front()) {
      is_to_start_anew_ = next->change.starts_anew;
      if (is_to_start_anew_) return;
      telemetry::Change change = next->change;
      change.cycle = loop_.cycle();
      change.time = loop_.time();
      loop_.apply(*next);
      controls_.settings.pop();
      if (hooks_.on_change) hooks_.on_change(change);
    }
  }

  ClosedLoop& loop_;
  double budget_;
  RunControls& controls_;
  const RealtimeHooks& hooks_;
  Pacer pacer_;
  LapPlanner planner_{LapPlanner::Clock::kReal};
  bool is_to_start_anew_ = false;
  bool is_unseen_ = true;  ///< no frame since it began
};

}  // namespace

telemetry::RunSummary run_realtime(ClosedLoop& loop, const RealtimeOptions& options, RunControls& controls,
                                   const RealtimeHooks& hooks) {
  const auto start = Clock::now();
  Session(loop, options, controls, hooks).run(options.stay_at_end);
  telemetry::RunSummary run = loop.summary();
  run.wall_time = std::chrono::duration<double>(Clock::now() - start).count();
  return run;
}

}  // namespace chicane::run
