// SPDX-License-Identifier: MIT
#include "chicane/safety/guard.hpp"

#include <cmath>
#include <utility>

namespace chicane::safety {
namespace {

using controller::Answer;
using controller::Rung;

bool is_finite(const model::Command& command) noexcept {
  return std::isfinite(command.steer) && std::isfinite(command.throttle);
}

/// When the command of this cycle acts [s], where the controller does not say.
double act_time(const model::Measurement& seen, const controller::StepReport& report) noexcept {
  return std::isnan(report.act_time) ? seen.time + seen.delay : report.act_time;
}

}  // namespace

Guard::Guard(std::unique_ptr<controller::Controller> controller, const model::VehicleParams& vehicle) noexcept
    : controller_{std::move(controller)}, fallback_{vehicle}, gate_{vehicle} {}

void Guard::reset() noexcept {
  controller_->reset();
  monitor_.reset();
  fallback_.reset();
  gate_.reset();
}

void Guard::set_vehicle(const model::VehicleParams& vehicle) noexcept {
  fallback_.set_vehicle(vehicle);
  gate_.set_vehicle(vehicle);
}

model::Command Guard::step(const model::Measurement& measured, Deadline deadline, const Cycle& cycle,
                           controller::StepResult& result) noexcept {
  const model::Measurement& seen = monitor_.check(measured);
  result = controller_->step(seen, deadline);
  const Answer answer = is_finite(result.command) ? result.answer : Answer::kNone;
  switch (answer) {
    case Answer::kDrive:
      result.report.rung = Rung::kController;
      if (result.plan.size > 0) {
        fallback_.accept(result.plan);
      } else {
        fallback_.accept(result.command, act_time(seen, result.report), seen.speed);
      }
      break;
    case Answer::kStopOnRoad:
      result.report.rung = Rung::kStopOnRoad;
      break;
    case Answer::kReturnToRoad:
      result.report.rung = Rung::kReturnToRoad;
      break;
    case Answer::kNone:
      fall_back(seen, result);
      break;
  }
  const model::Command asked = result.command;
  const GateResult gated = gate_.pass(cycle.manual.value_or(asked), cycle.interval);
  result.command = gated.command;
  result.report.gated = gated.reason != GateReason::kNone;
  controller_->note_sent(result.command);
  return asked;
}

void Guard::fall_back(const model::Measurement& seen, controller::StepResult& result) noexcept {
  const Fallback::Answer answer = fallback_.command(act_time(seen, result.report), seen);
  result.answer = Answer::kNone;
  result.command = answer.command;
  result.report.rung = answer.rung;
  result.plan.size = 0;
  result.plan.reference_size = 0;
}

}  // namespace chicane::safety
