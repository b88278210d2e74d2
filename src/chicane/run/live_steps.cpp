// SPDX-License-Identifier: MIT
#include "chicane/run/live_steps.hpp"

namespace chicane::run {

bool LiveSteps::advance() {
  if (loop_.is_control_due()) take_up_changes();
  if (is_to_start_anew_) return false;
  const bool is_new = loop_.advance(budget_);
  tell_lap();
  if (!is_new) return false;
  is_unseen_ = false;
  if (hooks_.on_frame) hooks_.on_frame(loop_.frame());
  const std::optional<telemetry::Change> planned = planner_.advance(loop_);
  if (planned && hooks_.on_change) hooks_.on_change(*planned);
  return true;
}

void LiveSteps::one_cycle() {
  while (!is_to_start_anew_ && !advance()) {
  }
  finish_cycle();
}

void LiveSteps::finish_cycle() {
  while (!loop_.is_control_due()) {
    loop_.advance();
    tell_lap();
  }
}

void LiveSteps::tell_lap() {
  if (const auto lap = loop_.take_lap(); lap && hooks_.on_lap) hooks_.on_lap(*lap);
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

}  // namespace chicane::run
