// SPDX-License-Identifier: MIT
#include "chicane/runtime/realtime_loop.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

namespace chicane::runtime {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double kNap = 0.004;      // [s] of run time advanced between two looks at the clock
constexpr double kMaxBehind = 0.1;  // [s] later than this, missed time is skipped
constexpr auto kPausePoll = std::chrono::milliseconds(10);

/// Maps run time to the clock; moved when the run pauses or falls behind.
class Pacer {
 public:
  explicit Pacer(double pace) : pace_{pace} {}
  void anchor(double run_time) {
    anchor_time_ = Clock::now();
    anchor_run_ = run_time;
  }
  /// Sleeps until the clock has reached `run_time`.
  void wait_for(double run_time) {
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
  double pace_;
  Clock::time_point anchor_time_ = Clock::now();
  double anchor_run_ = 0.0;
};

/// While paused: waits for the wish to go on, to stop or to step. True when one control cycle is to be done.
bool wait_while_paused(RunControls& controls) {
  while (controls.is_paused && !controls.wants_stop && !controls.wants_restart) {
    int steps = controls.steps.load();
    if (steps > 0 && controls.steps.compare_exchange_strong(steps, steps - 1)) return true;
    std::this_thread::sleep_for(kPausePoll);
  }
  return false;
}

}  // namespace

telemetry::RunSummary run_realtime(ClosedLoop& loop, const RealtimeOptions& options, RunControls& controls,
                                   const std::function<void(const telemetry::Frame&)>& on_frame) {
  const auto start = Clock::now();
  const double budget = options.budget_share * loop.scenario().control_period;
  const auto one_cycle = [&] {
    while (!loop.advance(budget)) {
    }
    if (on_frame) on_frame(loop.frame());
  };
  Pacer pacer(options.pace);
  pacer.anchor(loop.time());
  while (!controls.wants_stop && (options.stay_at_end || !loop.is_over())) {
    if (controls.wants_restart.exchange(false)) {
      loop.restart();
      pacer.anchor(loop.time());
    }
    if (controls.is_paused) {
      if (wait_while_paused(controls)) one_cycle();
      pacer.anchor(loop.time());
      continue;
    }
    const double until = loop.time() + kNap;
    while (loop.time() < until && !loop.is_over()) {
      if (loop.advance(budget) && on_frame) on_frame(loop.frame());
    }
    if (loop.is_over() && options.stay_at_end) loop.drive_on();
    pacer.wait_for(loop.time());
  }
  telemetry::RunSummary run = loop.summary();
  run.wall_time = std::chrono::duration<double>(Clock::now() - start).count();
  return run;
}

}  // namespace chicane::runtime
