// SPDX-License-Identifier: MIT
#include "chicane/recording/shadow_run.hpp"

#include <bit>
#include <variant>

namespace chicane::recording {
namespace {

bool is_same(double a, double b) noexcept {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

bool is_same(const telemetry::Frame& frame, const protocol::Step& step) noexcept {
  const model::Measurement &now = frame.measurement, &then = step.measurement;
  const model::Command &sent = frame.result.command, &sent_then = step.command;
  return is_same(now.x, then.x) && is_same(now.y, then.y) && is_same(now.psi, then.psi) &&
         is_same(now.speed, then.speed) && is_same(now.steer, then.steer) &&
         is_same(now.throttle, then.throttle) && is_same(sent.steer, sent_then.steer) &&
         is_same(sent.throttle, sent_then.throttle);
}

}  // namespace

Result<void> ShadowRun::begin(const scenario::Scenario& scenario) {
  auto loop = run::ClosedLoop::create(scenario, make_);
  if (!loop) return fail(loop.error());
  loop_ = std::move(*loop);
  loop_->drive_on();
  return {};
}

void ShadowRun::begin(std::unique_ptr<run::ClosedLoop> loop) {
  loop_ = std::move(loop);
  time_ = loop_->frame().time;
  next_cycle_ = loop_->cycle();
}

bool ShadowRun::begin(const ShadowRun& other) {
  loop_ = other.loop_->copy();
  time_ = other.time_;
  next_cycle_ = other.next_cycle_;
  first_difference_ = other.first_difference_;
  return loop_ != nullptr;
}

Result<void> ShadowRun::follow(const RecordedEvent& event) {
  return std::visit([this](const auto& one) { return take(one); }, event);
}

Result<void> ShadowRun::take(const telemetry::Change& change) {
  if (const Result<run::Setting> setting = run::read_setting(change)) apply(*setting);
  return {};
}

Result<void> ShadowRun::take(const RecordedStep& recorded) {
  const protocol::Step& step = recorded.step;
  if (step.begins && loop_->cycle() > 0) loop_->restart();
  finish_cycle();
  loop_->advance({.delay = step.measurement.delay, .deadline_spent_at = step.deadline_spent_at});
  tell_lap();
  time_ = recorded.log_time;
  next_cycle_ = step.cycle + 1;
  if (!first_difference_ && !is_same(loop_->frame(), step)) first_difference_ = step.cycle;
  return {};
}

void ShadowRun::apply(const run::Setting& setting) {
  if (const auto* fault = std::get_if<run::FaultSwitch>(&setting.action)) {
    const auto bit = static_cast<unsigned>(fault->event.fault);
    const bool is_on = (loop_->frame().active_faults >> bit & 1U) != 0U;
    const bool is_of_the_past = setting.change.time <= loop_->frame().time;
    if (is_of_the_past && is_on == (fault->to != run::FaultSwitch::To::kOff)) return;
  }
  finish_cycle();
  loop_->apply(setting);
}

void ShadowRun::finish_cycle() {
  while (!loop_->is_control_due()) {
    loop_->advance();
    tell_lap();
  }
}

void ShadowRun::drive(const std::function<bool()>& is_enough) {
  while (!loop_->is_over() && !is_enough()) {
    const bool is_new = loop_->advance();
    tell_lap();
    if (!is_new) continue;
    planner_.advance(*loop_);
    if (observers_.on_step) observers_.on_step(*loop_);
  }
}

void ShadowRun::tell_lap() {
  if (const auto lap = loop_->take_lap(); lap && observers_.on_lap) observers_.on_lap(*lap);
}

}  // namespace chicane::recording
