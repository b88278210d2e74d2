// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <functional>

#include "chicane/runtime/closed_loop.hpp"
#include "chicane/telemetry/frame.hpp"
#include "chicane/telemetry/metrics.hpp"

namespace chicane::runtime {

/// What other threads may ask of a run that is going on. Any thread; each wish is taken up at the next
/// control step.
struct RunControls {
  std::atomic<bool> is_paused{false};
  std::atomic<int> steps{0};  ///< control cycles to do while paused
  std::atomic<bool> wants_restart{false};
  std::atomic<bool> wants_stop{false};
};

struct RealtimeOptions {
  double pace = 1.0;          ///< run seconds per second of the clock; (0, 100]
  double budget_share = 0.8;  ///< of the control period that a control step may take; (0, 1]
  bool stay_at_end = false;   ///< drive on after the last lap until asked to stop
};

/// Runs an experiment paced by the clock. A loop that falls behind more than 100 ms does not catch up: it
/// goes on from where it is (missed time is skipped, as a plant that is not simulated would have skipped it
/// for the controller). `on_frame` is called on this thread after each control cycle and must not block.
[[nodiscard]] telemetry::RunSummary run_realtime(
    ClosedLoop& loop, const RealtimeOptions& options, RunControls& controls,
    const std::function<void(const telemetry::Frame&)>& on_frame = {});

}  // namespace chicane::runtime
