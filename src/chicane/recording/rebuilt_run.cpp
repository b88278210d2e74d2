// SPDX-License-Identifier: MIT
#include "chicane/recording/rebuilt_run.hpp"

#include <bit>
#include <cstdint>
#include <variant>

namespace chicane::recording {
namespace {

bool is_same(double a, double b) noexcept {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

}  // namespace

bool is_same(const telemetry::Frame& frame, const protocol::Step& step) noexcept {
  const model::Measurement &now = frame.measurement, &then = step.measurement;
  const model::Command &sent = frame.result.command, &sent_then = step.command;
  return is_same(now.x, then.x) && is_same(now.y, then.y) && is_same(now.psi, then.psi) &&
         is_same(now.speed, then.speed) && is_same(now.steer, then.steer) &&
         is_same(now.throttle, then.throttle) && is_same(sent.steer, sent_then.steer) &&
         is_same(sent.throttle, sent_then.throttle);
}

Result<void> RebuiltRun::begin(const scenario::Scenario& scenario, const run::Factories& make) {
  auto loop = run::ClosedLoop::create(scenario, make);
  if (!loop) return fail(loop.error());
  loop_ = std::move(*loop);
  loop_->drive_on();
  return {};
}

/// A fault that begins or ends by itself is in the recording too, after the step that showed it: the run
/// that is computed again has it already.
void RebuiltRun::apply(const run::Setting& setting) {
  if (const auto* fault = std::get_if<run::FaultSwitch>(&setting.action)) {
    const auto bit = static_cast<unsigned>(fault->event.fault);
    const bool is_on = (loop_->frame().active_faults >> bit & 1U) != 0U;
    if (is_on == (fault->to != run::FaultSwitch::To::kOff)) return;
  }
  finish_cycle();  // changes come between two cycles
  loop_->apply(setting);
}

const telemetry::Frame& RebuiltRun::follow(const protocol::Step& step) {
  if (step.begins && loop_->cycle() > 0) loop_->restart();
  const run::GivenStep given{.delay = step.measurement.delay, .deadline_spent_at = step.deadline_spent_at};
  finish_cycle();
  static_cast<void>(loop_->advance(given));
  tell_lap();
  return loop_->frame();
}

void RebuiltRun::finish_cycle() {
  while (loop_ && !loop_->is_control_due()) static_cast<void>(advance());
}

bool RebuiltRun::advance() {
  const bool is_new = loop_->advance();
  tell_lap();
  return is_new;
}

void RebuiltRun::race_by_learned_lap() { planner_.advance(*loop_); }

void RebuiltRun::tell_lap() {
  if (const auto lap = loop_->take_lap(); lap && on_lap_) on_lap_(*lap);
}

}  // namespace chicane::recording
