// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <optional>

#include "chicane/run/closed_loop.hpp"
#include "chicane/run/setting.hpp"
#include "chicane/telemetry/metrics.hpp"

namespace chicane::run {

/// What other threads may ask of a run that is going on. Any thread; each request is taken up at the next
/// control step.
struct RunControls {
  std::atomic<bool> is_paused{false};
  std::atomic<int> steps{0};  ///< control cycles to do while paused
  std::atomic<bool> wants_restart{false};
  std::atomic<bool> wants_stop{false};
  SettingQueue settings{};  ///< that change, from one thread
};

struct RealtimeOptions {
  double budget_share = 0.8;  ///< of the control period that a control step may take; (0, 1]
  std::optional<double> step_budget = std::nullopt;  ///< instead of the share [s]; 0 = no bound
  bool stay_at_end = false;                          ///< drive on after the last lap until asked to stop
};

/// Runs an experiment at ClosedLoop::pace() by the clock. A loop that falls behind more than 100 ms does not
/// catch up: it goes on from where it is (missed time is skipped, as a plant that is not simulated would have
/// skipped it for the controller).
///
/// Changes that wait are applied between two cycles, also while paused. Comes back, beside at the end, when
/// the next one `starts_anew`; it is left in the queue.
[[nodiscard]] telemetry::RunSummary run_realtime(ClosedLoop& loop, const RealtimeOptions& options,
                                                 RunControls& controls, const RunHooks& hooks = {});

}  // namespace chicane::run
