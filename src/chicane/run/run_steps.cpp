// SPDX-License-Identifier: MIT
// Loops over the steps of a run: flat out in virtual time, paced by the clock, or step by step on request,
// with changes of settings and planned laps between the steps.
#include "chicane/run/run_steps.hpp"

#include <chrono>
#include <thread>

#include "chicane/base/duration.hpp"

namespace chicane::run {

bool RunSteps::advance(double budget) {
  const bool is_new = loop_.advance(budget);
  tell_lap();
  if (!is_new) return false;
  if (hooks_.on_frame) hooks_.on_frame(loop_.frame());
  const std::optional<telemetry::Change> planned = planner_.advance(loop_);
  if (planned && hooks_.on_change) hooks_.on_change(*planned);
  return true;
}

void RunSteps::finish_cycle() {
  while (!loop_.is_control_due()) {
    loop_.advance();
    tell_lap();
  }
}

void RunSteps::tell_lap() {
  if (const auto lap = loop_.take_lap(); lap && hooks_.on_lap) hooks_.on_lap(*lap);
}

bool LiveSteps::advance() {
  if (loop_.is_control_due()) take_up_changes();
  if (is_to_start_anew_ || !steps_.advance(budget_)) return false;
  is_unseen_ = false;
  return true;
}

void LiveSteps::one_cycle() {
  while (!is_to_start_anew_ && !advance()) {
  }
  finish_cycle();
}

void LiveSteps::take_up_changes() {
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

bool LiveSteps::restart_if_wanted() {
  if (!controls_.wants_restart.exchange(false)) return false;
  loop_.restart();
  is_unseen_ = true;
  return true;
}

bool LiveSteps::take_step() noexcept {
  int steps = controls_.steps.load();
  return steps > 0 && controls_.steps.compare_exchange_strong(steps, steps - 1);
}

namespace {

using Clock = std::chrono::steady_clock;
// Chosen.
constexpr double kBlock = 0.004;    // [s] run time between two looks at the clock
constexpr double kMaxBehind = 0.1;  // [s] lateness beyond which missed time is skipped
constexpr auto kPausePoll = std::chrono::milliseconds(10);  // period of looking for requests while paused

/// Pace of a run: maps run time to the clock from an anchor on, which moves when the run pauses or is late.
class Pacer {
 public:
  /// Sets the anchor: `run_time` [s] is now.
  void anchor(double run_time) {
    anchor_time_ = Clock::now();
    anchor_run_ = run_time;
  }
  /// Sleeps until the clock has reached `run_time` at this pace.
  void wait_for(double run_time, double pace) {
    if (pace != pace_) anchor(last_run_);
    pace_ = pace;
    last_run_ = run_time;
    const auto due = anchor_time_ + duration((run_time - anchor_run_) / pace_);
    if (Clock::now() > due + duration(kMaxBehind)) {
      anchor(run_time);
    } else {
      std::this_thread::sleep_until(due);
    }
  }

 private:
  double pace_ = 1.0;                             ///< run seconds per second of the clock
  Clock::time_point anchor_time_ = Clock::now();  ///< anchor on the clock
  double anchor_run_ = 0.0;                       ///< anchor in run time [s]
  double last_run_ = 0.0;                         ///< run time of the last call of wait_for() [s]
};

/// One call of run_realtime().
class Session {
 public:
  Session(ClosedLoop& loop, const RealtimeOptions& options, RunControls& controls, const RunHooks& hooks)
      : loop_{loop},
        controls_{controls},
        hooks_{hooks},
        steps_{loop, options.step_budget.value_or(options.budget_share * loop.scenario().control_period),
               controls, hooks} {}

  void run(bool stay_at_end) {
    pacer_.anchor(loop_.time());
    while (!controls_.wants_stop && !steps_.is_to_start_anew() && (stay_at_end || !loop_.is_over())) {
      if (steps_.restart_if_wanted()) pacer_.anchor(loop_.time());
      if (controls_.is_paused) {
        steps_.finish_cycle();
        // Do the first cycle although paused: viewers see where the run begins.
        if (steps_.is_unseen() || wait_while_paused()) steps_.one_cycle();
        pacer_.anchor(loop_.time());
        continue;
      }
      const double until = loop_.time() + kBlock;
      while (loop_.time() < until && !loop_.is_over() && !steps_.is_to_start_anew()) steps_.advance();
      if (loop_.is_over() && stay_at_end) {
        if (hooks_.on_over) hooks_.on_over();
        loop_.drive_on();
      }
      pacer_.wait_for(loop_.time(), loop_.pace());
    }
  }

 private:
  /// Waits while paused for a request to continue, to stop or to step. True: one control cycle is requested.
  bool wait_while_paused() {
    steps_.take_up_changes();
    while (controls_.is_paused && !controls_.wants_stop && !controls_.wants_restart &&
           !steps_.is_to_start_anew()) {
      if (steps_.take_step()) return true;
      std::this_thread::sleep_for(kPausePoll);
      steps_.take_up_changes();
    }
    return false;
  }

  ClosedLoop& loop_;
  RunControls& controls_;
  const RunHooks& hooks_;
  LiveSteps steps_;
  Pacer pacer_;
};

/// Summary of a run that began at `start`.
telemetry::RunSummary summary_since(Clock::time_point start, const ClosedLoop& loop) {
  telemetry::RunSummary run = loop.summary();
  run.wall_time = seconds(Clock::now() - start);
  return run;
}

}  // namespace

telemetry::RunSummary run_closed_loop(ClosedLoop& loop, const RunHooks& hooks,
                                      const std::function<bool()>& stop) {
  const Clock::time_point start = Clock::now();
  RunSteps steps(loop, hooks);
  while (!loop.is_over()) {
    if (steps.advance() && stop && stop()) break;
  }
  return summary_since(start, loop);
}

telemetry::RunSummary run_realtime(ClosedLoop& loop, const RealtimeOptions& options, RunControls& controls,
                                   const RunHooks& hooks) {
  const Clock::time_point start = Clock::now();
  Session(loop, options, controls, hooks).run(options.stay_at_end);
  return summary_since(start, loop);
}

}  // namespace chicane::run
